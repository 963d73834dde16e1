#include <gmock/gmock.h>

#include <cmath>

#include <nlohmann/json.hpp>

#include "cli/bad_input.hpp"
#include "slideway/base/file.hpp"

namespace slideway::info_test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

class Info : public ProgramTest {};

TEST_F(Info, ListsSpikesByDataRow) {
  folder_.file("face.csv", face_csv(30, 12, "12,-9000\n"));
  const json info = json::parse(run({"info", "face.csv", "--json", "-"}).out);
  ASSERT_EQ(info["outliers"].size(), 1U);
  EXPECT_EQ(info["outliers"][0]["row"], 13);
  EXPECT_EQ(info["outliers"][0]["value"], -9000.0);
  EXPECT_EQ(info["outliers"][0]["kind"], "spike");
  EXPECT_THAT(run({"info", "face.csv"}).out, HasSubstr("data row 13: -9000, neighbours say 0."));
}

TEST_F(Info, TellsWhatAFileHolds) {
  const std::string text = "x [mm];H\xf6he [\xb5m]\n0;3\n0,5;\n1;-1\n1,5;1\n";
  folder_.file("face.txt", text);
  const json info = json::parse(run({"info", "face.txt", "--json", "-"}).out);
  EXPECT_EQ(info["schema"], "slideway.info/1");
  EXPECT_EQ(info["format"], "text");
  EXPECT_EQ(info["sha256"], sha256(text));
  EXPECT_EQ(info["points"], 4);
  EXPECT_EQ(info["missing"], 1);
  EXPECT_EQ(info["position_unit"], "mm");
  EXPECT_EQ(info["value_unit"], "um");
  EXPECT_EQ(info["position_last"], 1.5);
  EXPECT_EQ(info["step_min"], 0.5);
  EXPECT_EQ(info["step_max"], 0.5);
  EXPECT_EQ(info["value_min"], -1.0);
  EXPECT_EQ(info["pv"], 4.0);
  EXPECT_DOUBLE_EQ(info["rms"], std::sqrt(8.0 / 3.0));  // of 3, -1, 1 about their mean 1
  EXPECT_EQ(info["decisions"][0],
            "Latin-1, semicolons between columns, decimal comma, 1 header line");
}

// SDF as ISO 25178-71 has it: 3 points in each of 2 profiles, heights in um.
const char* const kAreal =
    "aISO-1.0\nManufacID = here\nCreateDate = 0\nModDate = 0\nNumPoints = 3\nNumProfiles = 2\n"
    "Xscale = 1e-3\nYscale = 2e-3\nZscale = 1e-6\nZresolution = -1\nCompression = 0\n"
    "DataType = 7\nCheckType = 0\n*\n1 2 3\n4 BAD 6\n*\n*";

TEST_F(Info, TellsWhatAnArealFileHoldsAndHowToChooseALine) {
  folder_.file("face.sdf", kAreal);
  const json info = json::parse(run({"info", "face.sdf", "--json", "-"}).out);
  EXPECT_EQ(info["format"], "SDF");
  EXPECT_EQ(info["points"], 6);
  EXPECT_EQ(info["rows"], 2);
  EXPECT_EQ(info["columns"], 3);
  EXPECT_EQ(info["missing"], 1);
  EXPECT_EQ(info["position_unit"], "m");
  EXPECT_DOUBLE_EQ(info["x_last"], 2e-3);
  EXPECT_DOUBLE_EQ(info["y_last"], 2e-3);
  EXPECT_DOUBLE_EQ(info["value_min"], 1e-6);
  EXPECT_DOUBLE_EQ(info["value_max"], 6e-6);
  const std::string text = run({"info", "face.sdf"}).out;
  EXPECT_THAT(text, HasSubstr("6 in 2 rows of 3"));
  EXPECT_THAT(text, HasSubstr("0 to 0.002 m, 0.001 apart"));
  EXPECT_THAT(text, HasSubstr("--line row:1 to row:2"));
  const json line = json::parse(run({"info", "face.sdf", "--line", "row:1", "--json", "-"}).out);
  EXPECT_EQ(line["points"], 3);
}

TEST_F(Info, SaysWhereNothingIsKnown) {
  folder_.file("bare.txt", "0 1\n");
  const json info = json::parse(run({"info", "bare.txt", "--json", "-"}).out);
  EXPECT_TRUE(info["position_unit"].is_null());
  EXPECT_TRUE(info["step_min"].is_null());
  EXPECT_THAT(run({"info", "bare.txt"}).out, HasSubstr("unit not stated"));
  const json document = json::parse(
      run({"info", "bare.txt", "--position-unit", "mm", "--value-unit", "um", "--json", "-"}).out);
  EXPECT_EQ(document["value_unit"], "um");
}

// U+2800 and above are three bytes each, so a line of 66 of them with its label has 80 characters
// at the most.
TEST_F(Info, DrawsTheProfileWithinEightyColumns) {
  folder_.file("face.csv", face_csv(500, 250, "250,nan"));
  const ProgramRun done = run({"info", "face.csv"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  for (const std::string& line : lines_of(done.out)) {
    const auto is_start = [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U; };
    EXPECT_LE(std::count_if(line.begin(), line.end(), is_start), 80) << line;
  }
}

// Two values, low on the left and high on the right: the ends of the frame, nothing between.
TEST_F(Info, PutsLowValuesBelowAndHighOnesAbove) {
  folder_.file("step.csv", "0,0\n1,1\n");
  const std::vector<std::string> lines = lines_of(run({"info", "step.csv"}).out);
  ASSERT_GE(lines.size(), 9U);
  const std::string& top = lines[lines.size() - 9];
  const std::string& bottom = lines[lines.size() - 2];
  EXPECT_EQ(top.substr(top.size() - 3), "\u2808");  // highest dot, right column
  EXPECT_THAT(bottom, HasSubstr("0 \u2840"));       // lowest dot, left column
}

TEST_F(Info, DrawsAConstantProfileAndASinglePoint) {
  folder_.file("flat.csv", "0,5\n1,5\n2,5\n");
  folder_.file("point.csv", "0,5\n");
  EXPECT_EQ(run({"info", "flat.csv"}).exit_code, 0);
  EXPECT_EQ(run({"info", "point.csv"}).exit_code, 0);
}

TEST_F(Info, TakesWhatItIsToldOfTheText) {
  folder_.file("face.txt", "1;2\n0;1,234\n1;2,345\n");
  const ProgramRun done = run({"info", "face.txt", "--delimiter", ";", "--decimal", ",",
                               "--encoding", "utf-8", "--header-lines", "1", "--json", "-"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(json::parse(done.out)["points"], 2);
  EXPECT_EQ(json::parse(done.out)["value_max"], 2.345);
}

// Means of 2^level samples: 20 samples are 5 at level 2; the second profile is as it is.
TEST_F(Info, ShowsTheLowBandOfEachProfileOfAProblem) {
  folder_.file("face.csv", face_csv(20));
  const auto profile = [](const std::string& name, const std::string& keys) {
    return "[[profile]]\nname = \"" + name + "\"\nfile = \"face.csv\"\nkind = \"slide\"\n" +
           "position_unit = \"mm\"\nvalue_unit = \"um\"\n" + keys;
  };
  folder_.file("two.toml",
               "[low_band]\nlevel = 2\n" + profile("a", "") + profile("b", "level = 0\n"));
  const json bands = json::parse(run({"info", "two.toml", "--json", "-"}).out).at("low_band");
  EXPECT_EQ(bands[0]["values"], 5);
  EXPECT_EQ(bands[1]["values"], 20);
  EXPECT_THAT(run({"info", "two.toml"}).out, HasSubstr("none, as it is"));
}

TEST_F(Info, RefusesInOneLine) {
  folder_.file("face.csv", face_csv(20));
  EXPECT_TRUE(is_refused(run({"info", "gone.csv"}), 3));
  EXPECT_TRUE(is_refused(run({"info", "."}), 3));
  EXPECT_TRUE(is_refused(run({"info", "face.csv", "--value", "z"}), 3));
  EXPECT_TRUE(is_refused(run({"info", "face.csv", "--header-lines", "-1"}), 2));
  EXPECT_TRUE(is_refused(run({"info", "face.csv", "--decimal", ";"}), 2));
  EXPECT_TRUE(is_refused(run({"info", "face.csv", "--value-unit", "furlong"}), 2));
  EXPECT_TRUE(is_refused(run({"info", "face.csv", "--value-unit", "nm"}), 2));
  EXPECT_TRUE(is_refused(run({"info", "face.csv", "--line", "row:1"}), 2));
  EXPECT_TRUE(is_refused(run({"info", "face.csv", "--json", "face.csv"}), 2));
}

// 3 by 3 lines of 13 stations, 10 mm apart, on a plane; one is off by 5 um where it crosses the
// middle one. By hand: an error of one reading at the centre appears there unchanged.
TEST_F(Info, ClosesTheLinesOfAProblemWithoutAnEffect) {
  std::string problem;
  for (const std::string axis : {"x", "y"})
    for (const int line : {0, 60, 120}) {
      const std::string name = axis + std::to_string(line), at = std::to_string(line);
      std::string rows = "s_mm,z_um\n";
      for (int s = 0; s <= 120; s += 10) {
        const int ripple = (s / 10) % 2 == 0 || s % 60 == 0 ? 0 : (s / 10) % 4 - 2;
        rows += std::to_string(s) + "," +
                std::to_string(s * (line + 1) * 0.01 + 0.01 * ripple +
                               (name == "x60" && s == 60 ? 5.0 : 0.0)) +
                "\n";
      }
      folder_.file(name + ".csv", rows);
      const bool along_x = axis == "x";
      problem += "[[profile]]\nname = \"" + name + "\"\nfile = \"" + name + ".csv\"\n" +
                 "kind = \"slide\"\nposition_unit = \"mm\"\nvalue_unit = \"um\"\nfrom_mm = " +
                 (along_x ? "[0, " + at + "]" : "[" + at + ", 0]") +
                 "\nto_mm = " + (along_x ? "[120, " + at + "]" : "[" + at + ", 120]") + "\n";
    }
  folder_.file("plate.toml", problem);
  const json closure = json::parse(run({"info", "plate.toml", "--json", "-"}).out).at("closure");
  EXPECT_EQ(closure["verdict"], "does not close");
  EXPECT_EQ(closure["redundancy"], 1);
  for (const json& reading : closure["readings"])
    if (reading["profile"] == "x60" && reading["x_mm"] == 60.0) {
      EXPECT_NEAR(reading["closure_um"], 5.0, 0.05);  // the ripple of the others
    }
  EXPECT_THAT(run({"info", "plate.toml"}).out,
              AllOf(HasSubstr("Closure between lines: does not close"),
                    HasSubstr("µm above what the\n    others say at [60, 60] mm")));
  const auto refused = run({"info", "plate.toml", "--decimal", ","});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("--decimal belongs to a FILE"));
}

}  // namespace
}  // namespace slideway::info_test
