#include "cli/bad_input.hpp"

namespace slideway {
namespace {

class Data : public BadInputTest {};

TEST_P(Data, IsRefusedInOneLine) { expect_refused(); }

BadInput bad(const std::string& name, const std::string& csv,
             const std::vector<std::string>& fragments, const ProblemText& problem = {}) {
  return {name, problem.text(), csv, 3, fragments};
}

std::string every_byte() {
  std::string bytes;
  for (int i = 0; i < 2048; ++i) bytes += static_cast<char>(i);
  return bytes;
}

// Data row i (from 0) of face_csv() stands in line i + 2 of the file.
const BadInput kFields[] = {
    bad("Text", face_csv(64, 30, "30,abc"),
        {"profile 'face': face.csv: line 32, column 'z_um': 'abc' is no number"}),
    bad("Infinity", face_csv(64, 30, "30,-inf"),
        {"face.csv: line 32, column 'z_um': -inf is no measured value", "remove the row"}),
    bad("NanPosition", face_csv(64, 30, "NaN,0.5"), {"face.csv: line 32, column 'x_mm'", "NaN"}),
    bad("TooLarge", face_csv(64, 30, "30,1e999"), {"face.csv: line 32, column 'z_um'", "1e999"}),
    bad("MarkOfAMissingValue", face_csv(64, 30, "30,1e38"),
        {"face.csv: data row 31: too large for its unit", "accepted"}),
    bad("EmptyPosition", face_csv(64, 30, ",30"), {"face.csv: line 32: column 'x_mm' is empty"}),
    bad("TextCutWithinARow", face_csv(63) + "63,", {"face.csv: line 65: the text ends within"}),
    bad("LoneCarriageReturn", "x_mm,z_um\r\n0,1\r1,2\r\n2,3\r\n",
        {"face.csv: line 2: a carriage return inside the line", "accepted"}),
    bad("MissingField", face_csv(64, 30, "30"),
        {"face.csv: line 32: 1 field, expected at least 2"}),
    bad("Thousands", "x_mm;z_um\n0;0,5\n1;1.234,6\n",
        {"face.csv: line 3, column 'z_um': '1.234,6' has a thousands separator"}),
    bad("OtherUnitInTheHeader", "x_mm,Height [nm]\n0,1\n1,2\n",
        {"face.csv: the header has the unit nm, the problem value_unit = \"um\""}, {.columns = ""}),
    bad("Unsorted", face_csv(64, 30, "2.5,0.1"),
        {"face.csv: data row 31: position 2.5 follows 29", "must strictly increase"}),
    bad("Repeated", face_csv(64, 30, "29,0.1"),
        {"face.csv: data row 31: position 29 follows 29", "must strictly increase"}),
    bad("InvalidUtf8", face_csv(64, 30, "30,\xff\xfe"), {"face.csv: line 32, column 'z_um': '?"}),
    bad("ZeroByte", face_csv(64, 30, std::string("30,\0", 4)), {"face.csv: line 32"}),
};
INSTANTIATE_TEST_SUITE_P(BadField, Data, testing::ValuesIn(kFields),
                         [](const auto& input) { return input.param.name; });

const BadInput kFiles[] = {
    bad("Missing", "", {"profile 'face': gone.csv: cannot be read"}, {.file = "gone.csv"}),
    bad("Directory", "", {"profile 'face': .: is a directory, expected a file"}, {.file = "."}),
    bad("Device", "", {"profile 'face': /dev/zero: is a pipe or a device, expected a file"},
        {.file = "/dev/zero"}),
    bad("Empty", "", {"profile 'face': face.csv: is empty"}),
    bad("OnlyAHeader", "x_mm,z_um\n", {"face.csv: holds no rows of numbers"}),
    bad("OnlyAHeaderWithoutNewline", "x_mm,z_um", {"face.csv: holds no rows of numbers"}),
    bad("OnlyComments", "# flatness\n\n", {"face.csv: holds no rows of numbers"}),
    bad("ColumnMissing", "x_mm,z_nm\n0,1\n1,2\n",
        {"face.csv: no column 'z_um'", "the file has: x_mm, z_nm", "did you mean 'z_nm'?"}),
    bad("ColumnNumberMissing", face_csv(64),
        {"face.csv: no column '3'", "the file has: x_mm, z_um"}, {.columns = "value_column = 3\n"}),
    bad("ColumnTwice", "x_mm,z_um,z_um\n0,1,2\n1,2,3\n",
        {"face.csv: has more than one column 'z_um'", "by its number"}),
    bad("Binary", every_byte(), {"face.csv: line 2: a carriage return inside the line"}),
    bad("HalfACharacter", std::string("\xff\xfex\0,\0z\0\n", 9),
        {"face.csv: byte 7: half a character of UTF-16"}),
};
INSTANTIATE_TEST_SUITE_P(BadFile, Data, testing::ValuesIn(kFiles),
                         [](const auto& input) { return input.param.name; });

const BadInput kAmounts[] = {
    bad("OneSample", face_csv(1), {"face.csv: 1 sample, at least 2 are needed"},
        {.low_band = "[low_band]\nlevel = 0\n"}),
    bad("NothingInTheWindow", face_csv(64),
        {"face.csv: no sample in the window [100, 200], at least 2 are needed"},
        {.profile_more = "window = [100.0, 200.0]\n"}),
    bad("FewerSamplesThanTheLevelNeeds", face_csv(64),
        {"problem.toml: profile 'face'", "64 samples, level 7 needs at least 128",
         "accepted: level <= 6"},
        {.low_band = "[low_band]\nlevel = 7\n"}),
    bad("LowBandBeyondTheEnds", face_csv(64),
        {"problem.toml: profile 'face'", "64 samples, db19 at level 6 leave no value inside",
         "a shorter wavelet"},
        {.low_band = "[low_band]\nwavelet = \"db19\"\nlevel = 6\n"}),
    // b0 ... b9, and the offset and tilt that are free by default
    bad("FewerSamplesThanParameters", face_csv(8),
        {"problem.toml: the profiles have 7 low-band values for 10 parameters",
         "fewer parameters (a lower degree)"},
        {.low_band = "[low_band]\nlevel = 0\n",
         .effect = "[[effect]]\nname = \"straightness\"\ndegree = 9\n"}),
    bad("FewerLowBandValuesThanParameters", face_csv(64),
        {"problem.toml: the profiles have 7 low-band values for 10 parameters"},
        {.low_band = "[low_band]\nlevel = 3\n",
         .effect = "[[effect]]\nname = \"straightness\"\ndegree = 9\n"}),
};
INSTANTIATE_TEST_SUITE_P(BadAmount, Data, testing::ValuesIn(kAmounts),
                         [](const auto& input) { return input.param.name; });

/// What the table above varies is accepted as it is.
class GoodData : public ProgramTest {};

TEST_F(GoodData, IsAccepted) {
  folder_.file("problem.toml", ProblemText{}.text());
  folder_.file("face.csv", face_csv(64));
  const ProgramRun done = run({"identify", "problem.toml", "--json", "report.json"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(done.err, "");
  EXPECT_THAT(names_in(folder_.path()),
              testing::ElementsAre("face.csv", "problem.toml", "report.json"));
}

}  // namespace

std::vector<BadInputs> bad_data() {
  return {{"BadField/Data", kFields}, {"BadFile/Data", kFiles}, {"BadAmount/Data", kAmounts}};
}

}  // namespace slideway
