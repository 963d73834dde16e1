#include "cli/bad_input.hpp"
#include "format/deflated.hpp"
#include "format/x3p_checksum.hpp"
#include "slideway/format/format.hpp"

namespace slideway {
namespace {

using testing::HasSubstr;

class FileFormat : public BadInputTest {};

TEST_P(FileFormat, IsRefusedInOneLine) { expect_refused(); }

const ProblemText kNoUnits{.columns = "", .units = ""};

BadInput bad_file(const std::string& name, const std::string& bytes,
                  const std::vector<std::string>& fragments) {
  return {name, kNoUnits.text(), bytes, 3, fragments};
}

BadInput bad_request(const std::string& name, const std::string& bytes, const std::string& key,
                     const std::vector<std::string>& fragments) {
  ProblemText problem = kNoUnits;
  problem.profile_more = key;
  return {name, problem.text(), bytes, 2, fragments};
}

std::string written(const std::string& ending) {
  Trace trace{{}, {}, "mm", "um", {}};
  for (int i = 0; i < 64; ++i) {
    trace.positions.push_back(i);
    trace.values.push_back(0.25 * ((i * 7) % 12));
  }
  return format_to_write("face" + ending).write(trace);
}

std::string half(const std::string& bytes) { return bytes.substr(0, bytes.size() / 2); }

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  return text.replace(text.find(what), what.size(), by);
}

std::string x3p_main(std::size_t points, const std::string& record,
                     const std::string& feature = "PRF") {
  const std::string axis =
      "><AxisType>I</AxisType><DataType>D</DataType><Increment>0.001</Increment><Offset>0</"
      "Offset></";
  return "<p:ISO5436_2 xmlns:p=\"http://www.opengps.eu/2008/ISO5436_2\"><Record1><Revision>ISO5436 "
         "- 2000</Revision><FeatureType>" +
         feature + "</FeatureType><Axes><CX" + axis + "CX><CY" + axis +
         "CY><CZ><AxisType>A</AxisType><DataType>D</DataType></CZ></Axes></Record1><Record3>"
         "<MatrixDimension><SizeX>" +
         std::to_string(points) + "</SizeX><SizeY>" + (feature == "SUR" ? "2" : "1") +
         "</SizeY><SizeZ>1</SizeZ></MatrixDimension>" + record + "</Record3></p:ISO5436_2>";
}

std::string data_list(int points) {
  std::string list = "<DataList>";
  for (int i = 0; i < points; ++i) list += "<Datum>" + std::to_string(i % 5) + "e-6</Datum>";
  return list + "</DataList>";
}

const std::string kLink = "<DataLink><PointDataLink>bindata/data.bin</PointDataLink></DataLink>";
std::string x3p(const std::string& main, const std::string& sum) {
  return deflated({{"main.xml", main}, {"md5checksum.hex", sum + " *main.xml"}});
}

std::string x3p(const std::string& main) { return x3p(main, md5(main)); }

const std::string kWrongSum(32, '0');

std::string nested(int depth) {
  std::string text;
  for (int i = 0; i < depth; ++i) text += "<a>";
  for (int i = 0; i < depth; ++i) text += "</a>";
  return text;
}

const BadInput kArchives[] = {
    bad_file("X3pCutOff", half(written(".x3p")), {"face.csv: zip: no whole zip archive"}),
    bad_file("X3pWithAWrongChecksum", x3p(x3p_main(64, data_list(64)), kWrongSum),
             {"face.csv: main.xml: the MD5 checksum is", "ignore the checksum"}),
    bad_file("ZipBomb", deflated({{"main.xml", std::string(1'200'000, ' ')}}),
             {"face.csv: zip: entry 'main.xml': 1200000 bytes declared, at most 1048576"}),
    bad_file("PathOutOfTheArchive",
             deflated({{"main.xml", x3p_main(64, data_list(64))}, {"../evil", "x"}}),
             {"face.csv: zip: entry '../evil': its path leads out"}),
    bad_file("ArchiveInTheArchive", deflated({{"more.zip", "x"}}),
             {"is an archive in the archive"}),
    bad_file("X3pEntityBomb",
             x3p("<!DOCTYPE a [<!ENTITY b \"&c;&c;\"><!ENTITY c \"&d;&d;\">]><a>&b;</a>"),
             {"face.csv: main.xml: a DOCTYPE is not accepted"}),
    bad_file("X3pNestedDeeply", x3p(nested(1000)), {"nested deeper than 32"}),
    bad_file("X3pOfMorePointsThanItHolds", x3p(x3p_main(1'000'000'000'000, kLink)), {"face.csv: "}),
    bad_file("X3pOfMoreDatumsThanItHolds", x3p(x3p_main(1'000'000'000'000, data_list(64))),
             {"face.csv: main.xml", "64 Datum where"}),
    bad_request("TextKeysForX3p", written(".x3p"), "delimiter = \",\"\n",
                {"face.csv: is X3P", "belong to delimited text"}),
    bad_request("ArealFileWithoutALine", x3p(x3p_main(32, data_list(64), "SUR")), "",
                {"face.csv: ", "2 rows of 32 points"}),
};
INSTANTIATE_TEST_SUITE_P(BadArchive, FileFormat, testing::ValuesIn(kArchives),
                         [](const auto& input) { return input.param.name; });

const std::string kNist =
    "<?xml version='1.0'?>\n<!DOCTYPE DATA SYSTEM \"data.dtd\">\n<DATA><DATAFILE><UNITS>um</UNITS>"
    "<NUMPOINTS>3</NUMPOINTS><SPACING>0.25</SPACING><DATA_TYPE>2D</DATA_TYPE><DATA_POINT_VALUES>"
    "0.5\n-1.25\n7\n</DATA_POINT_VALUES></DATAFILE></DATA>";

const BadInput kPlain[] = {
    bad_file("SdfCutOff", half(written(".sdf")), {"face.csv: "}),
    bad_file("SdfOfMorePointsThanItHolds",
             replaced(written(".sdf"), "NumPoints = 64", "NumPoints = 4000000000"), {"face.csv: "}),
    bad_file("SdfOfANegativeNumberOfPoints",
             replaced(written(".sdf"), "NumPoints = 64", "NumPoints = -64"), {"face.csv: "}),
    bad_file("SmdCutOff", half(written(".smd")), {"face.csv: "}),
    bad_file("SmdWithAWrongChecksum", replaced(written(".smd"), "0.25", "0.75"),
             {"ignore the checksum"}),
    bad_file("PrfCutOff", half(written(".prf")), {"face.csv: "}),
    bad_file("NistXmlCutOff", half(kNist), {"face.csv: "}),
    bad_file(
        "NistXmlEntityBomb",
        replaced(kNist, "SYSTEM \"data.dtd\"", "[<!ENTITY b \"&c;&c;\"><!ENTITY c \"&d;&d;\">]"),
        {"a DOCTYPE that declares entities is not accepted"}),
    bad_file("NistXmlOfMorePointsThanItHolds", replaced(kNist, ">3<", ">3000000000<"),
             {"face.csv: "}),
    {"LongLine", ProblemText{}.text(), std::string(4'000'000, '1'), 3, {"face.csv: "}},
    {"LongRow",
     ProblemText{}.text(),
     face_csv(64, 30, "30,1" + std::string(4'000'000, ',') + "x"),
     3,
     {"face.csv: line 32"}},
};
INSTANTIATE_TEST_SUITE_P(BadPlainFile, FileFormat, testing::ValuesIn(kPlain),
                         [](const auto& input) { return input.param.name; });

class Checksum : public ProgramTest {};

TEST_F(Checksum, IsPassedOverWhenAskedToAndTheReportSaysSo) {
  folder_.file("face.x3p", x3p(x3p_main(64, data_list(64)), kWrongSum));
  folder_.file("problem.toml", ProblemText{.file = "face.x3p", .columns = "", .units = ""}.text());
  EXPECT_TRUE(is_refused(run({"identify", "problem.toml"}), 3));
  EXPECT_TRUE(is_refused(run({"convert", "face.x3p", "out.csv"}), 3));
  const ProgramRun report =
      run({"identify", "problem.toml", "--no-trace", "--ignore-checksum", "--json", "-"});
  EXPECT_EQ(report.exit_code, 0) << report.err;
  EXPECT_THAT(report.out, HasSubstr("read nevertheless"));
  EXPECT_EQ(run({"convert", "face.x3p", "out.csv", "--ignore-checksum"}).exit_code, 0);
}

}  // namespace

std::vector<BadInputs> bad_formats() {
  return {{"BadArchive/FileFormat", kArchives}, {"BadPlainFile/FileFormat", kPlain}};
}

}  // namespace slideway
