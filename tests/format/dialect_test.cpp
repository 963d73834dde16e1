#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/format/table.hpp"

namespace slideway::dialect_test {
namespace {

using testing::DoubleEq;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::NanSensitiveDoubleEq;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::string utf16(std::string_view ascii, bool big_endian, bool marked) {
  std::string text = marked ? big_endian ? "\xfe\xff" : "\xff\xfe" : "";
  for (const char c : ascii) text += big_endian ? std::string{'\0', c} : std::string{c, '\0'};
  return text;
}

Table parse(const std::string& text, TableRequest request = {}) {
  if (request.columns.empty()) request.columns = {"1", "2"};
  request.may_miss = true;
  return parse_table(text, request);
}

std::string complaint(const std::string& text, TableRequest request = {}) {
  try {
    parse(text, std::move(request));
  } catch (const DataError& error) {
    return error.what();
  }
  return "no complaint";
}

struct Written {
  std::string name, text, decision;
};
void PrintTo(const Written& written, std::ostream* out) { *out << written.name; }

// The same two points, -1.5 at 0.25 and 2000 at 1234.5, in every dialect.
class Dialects : public testing::TestWithParam<Written> {};

TEST_P(Dialects, HoldTheSameNumbers) {
  const Table table = parse(GetParam().text);
  EXPECT_THAT(table.columns, ElementsAre(ElementsAre(0.25, 1234.5), ElementsAre(-1.5, 2000.0)));
  EXPECT_THAT(table.decisions, ElementsAre(GetParam().decision));
}

const std::string kPlain = "x,z\n0.25,-1.5\n1234.5,2e3\n";
const Written kDialects[] = {
    {"Plain", kPlain, "commas between columns, decimal point, 1 header line"},
    {"Bom", "\xef\xbb\xbf" + kPlain, "commas between columns, decimal point, 1 header line"},
    {"Utf16", utf16(kPlain, false, true),
     "UTF-16, commas between columns, decimal point, 1 header line"},
    {"Utf16BigEndian", utf16(kPlain, true, true),
     "UTF-16, commas between columns, decimal point, 1 header line"},
    {"Utf16WithoutMark", utf16(kPlain, false, false),
     "UTF-16, commas between columns, decimal point, 1 header line"},
    {"Utf16BigEndianWithoutMark", utf16(kPlain, true, false),
     "UTF-16, commas between columns, decimal point, 1 header line"},
    {"Latin1", "x;H\xf6he\n0,25;-1,5\n1234,5;2E3\n",
     "Latin-1, semicolons between columns, decimal comma, 1 header line"},
    {"SemicolonWithPoint", "0.25;-1.5\r\n1234.5;2000\r\n",
     "semicolons between columns, decimal point, no header"},
    {"SemicolonWithComma", "0,25;-1,5\r\n1234,5;2000\r\n",
     "semicolons between columns, decimal comma, no header"},
    {"TabWithComma", "0,25\t-1,5\n1234,5\t2,000e3\n",
     "tabs between columns, decimal comma, no header"},
    {"BlanksWithComma", "  0,25   -1,5\n  1234,5 2000\n",
     "blanks between columns, decimal comma, no header"},
    {"QuotedWithCommas", "\"x\",\"z\"\n\"0,25\",\"-1,5\"\n\"1234,5\",\"2000\"\n",
     "commas between columns, decimal comma, 1 header line"},
    {"TrailingSeparators", "x;z;\n0,25;-1,5;;\n1234,5;2000;;\n",
     "semicolons between columns, decimal comma, 1 header line"},
    {"SeparatorsAfterSomeRows", "x;z\n0,25;-1,5\n1234,5;2000;;\n",
     "semicolons between columns, decimal comma, 1 header line"},
    {"Comments", "# made by hand; 7\n0.25 -1.5\n# pause\n\n1234.5 2000\n",
     "blanks between columns, decimal point, no header"},
    {"SeveralHeaderLines",
     "Scan,0\nLength,1500.0 um\nStylus,Radius: 2.5\n\nx,z,\n0.25,-1.5,,\n1234.5,2000,,\n",
     "commas between columns, decimal point, 4 header lines"},
    {"UnitsRow", "X;Z;valid\n[mm];[mm];[1/0]\n0.25;-1.5;1\n1234.5;2000;1\n",
     "semicolons between columns, decimal point, 2 header lines, columns X and Z of 3"},
};
INSTANTIATE_TEST_SUITE_P(Text, Dialects, testing::ValuesIn(kDialects),
                         [](const auto& written) { return written.param.name; });

TEST(Dialect, ReadsDecimalCommasOfAnyLengthAsRoundedAsPoints) {
  for (const std::string number :
       {"0.1", "1.7976931348623157e308", "4.9406564584124654e-324",
        "0.1000000000000000055511151231257827", "-12345678901234567890.5", "9007199254740993.0"}) {
    std::string with_comma = number;
    with_comma[with_comma.find('.')] = ',';
    const Table table = parse("0;" + with_comma + "\n", {.decimal = ","});
    EXPECT_EQ(table.columns[1][0], parse_double(number)) << number;
  }
}

TEST(Dialect, RefusesThousandsSeparatorsByName) {
  const std::string rule = " has a thousands separator; write the number without it";
  EXPECT_EQ(complaint("x;z\n0,5;1,5\n1.234,5;2,5\n"), "line 3, column 'x': '1.234,5'" + rule);
  EXPECT_EQ(complaint("1.234,5;2,5\n0,5;1,5\n"), "line 1, column 1: '1.234,5'" + rule);
  EXPECT_EQ(complaint("0.5;1.5\n1;1,234.5\n"), "line 2, column 2: '1,234.5'" + rule);
  EXPECT_EQ(complaint("0.5,1.5\n1,\"1,234.5\"\n"), "line 2, column 2: '1,234.5'" + rule);
  EXPECT_EQ(complaint("0.5;1.5\n1;1 234\n"), "line 2, column 2: '1 234'" + rule);
  EXPECT_EQ(complaint("0,5;1,5\n1;1.234\n"), "line 2, column 2: '1.234'" + rule);
  EXPECT_EQ(complaint("0.5;1.5\n1;1'234.5\n"), "line 2, column 2: '1'234.5'" + rule);
  EXPECT_EQ(complaint("0.5;1.5\n1;1\u00a0234.5\n"), "line 2, column 2: '1\u00a0234.5'" + rule);
}

TEST(Dialect, RefusesWhatCanBeReadInTwoWaysUntilAsked) {
  const std::string grouped = "0;1,234\n1;2,345\n";
  EXPECT_EQ(complaint(grouped),
            "line 1: '1,234' has a decimal comma or a thousands separator; say decimal = \",\" or "
            "\".\"");
  EXPECT_THAT(parse(grouped, {.decimal = ","}).columns[1], ElementsAre(1.234, 2.345));
  EXPECT_THAT(complaint(grouped, {.decimal = "."}), HasSubstr("thousands separator"));
  EXPECT_THAT(parse("0;1,234\n1;0,345\n").columns[1], ElementsAre(1.234, 0.345));

  const std::string doubled = "x,z\n0,25,1,5\n0,5,2,5\n";
  EXPECT_EQ(complaint(doubled),
            "line 2: 4 fields under 2 names; decimal commas between commas are ambiguous "
            "(if they are none, say decimal = \".\")");
  EXPECT_THAT(parse(doubled, {.decimal = "."}).columns[1], ElementsAre(25.0, 5.0));
}

TEST(Dialect, RefusesAFirstRowThatIsLongerThanTheNames) {
  const auto by_name = [](const std::string& text) {
    return parse_table(text, {.columns = {"x", "z"}});
  };
  EXPECT_THAT([&] { by_name("x,z\n0.4,3,759.1\n0.5,4\n"); },
              testing::ThrowsMessage<DataError>(HasSubstr("line 2: 3 fields under 2 names")));
  EXPECT_THAT(by_name("x,z\n0.4,3,\n0.5,4,\n").columns[1], ElementsAre(3.0, 4.0));
}

TEST(Dialect, RefusesASecondDecimalMark) {
  EXPECT_EQ(complaint("0,5;1\n1,5;2.25\n"),
            "line 2, column 2: '2.25' is no number with a decimal comma, as the numbers before it "
            "have");
  EXPECT_EQ(complaint("0.5;1\n1.5;2,25\n"),
            "line 2, column 2: '2,25' is no number with a decimal point, as the numbers before it "
            "have");
}

TEST(Dialect, TakesEmptyAndNamedValuesForMissing) {
  const Table table = parse("x,z\n0,1\n1,\n2,NaN\n3,n/a\n4,NULL\n5,\"\"\n6,#N/A\n7,2\n");
  const auto nan = NanSensitiveDoubleEq(kNan);
  EXPECT_THAT(table.columns[1],
              ElementsAre(DoubleEq(1.0), nan, nan, nan, nan, nan, nan, DoubleEq(2.0)));
  EXPECT_EQ(table.decisions.back(), "6 values are missing: empty, nan, na or null");
  EXPECT_EQ(complaint("0,1\n1,***\n"), "line 2, column 2: '***' is no number");
  EXPECT_EQ(complaint("0,1\n1,inf\n"),
            "line 2, column 2: inf is no measured value; remove the row or mask it");
  EXPECT_EQ(complaint("0,1\n,1\n"), "line 2: column 1 is empty");
  EXPECT_EQ(complaint("0,1\n1,"), "line 2: the text ends within a row");
}

TEST(Dialect, RefusesLongerRowsThanTheFirst) {
  EXPECT_EQ(complaint("x,z\n999.5,1\n1,234.5,1\n"),
            "line 3: more than 2 fields, as the rows before it have");
  EXPECT_EQ(complaint("x,z\n0,1\n1,2" + std::string(100, ',') + "3\n"),
            "line 3: more than 2 fields, as the rows before it have");
  EXPECT_EQ(complaint("x,z\n0,1\n1,\"2\"" + std::string(100, ',') + "\"\" \n"), "no complaint");
}

TEST(Dialect, TakesUnitsFromNamesAndUnitRows) {
  const auto units = [](const std::string& header) { return parse(header + "\n0;1\n").units; };
  EXPECT_THAT(units("x_mm;z_um"), ElementsAre("mm", "um"));
  EXPECT_THAT(units("x (mm);Height [\u00b5m]"), ElementsAre("mm", "um"));
  EXPECT_THAT(units("x / mm;Height [\u03bcm]"), ElementsAre("mm", "um"));
  EXPECT_THAT(units("x [in];H\xf6he [\xb5m]"), ElementsAre("inch", "um"));
  EXPECT_THAT(units("Lateral um;Raw Micrometer"), ElementsAre("um", "um"));
  EXPECT_THAT(units("t_s;slope_urad"), ElementsAre("s", "urad"));
  EXPECT_THAT(units("x_inch;z_um_per_m"), ElementsAre("inch", "um_per_m"));
  EXPECT_THAT(units("x;slope [mm/m]"), ElementsAre("", "mm_per_m"));
  EXPECT_THAT(units("X;Z\nmm;\u00b5m"), ElementsAre("mm", "um"));
  EXPECT_THAT(units("x;drawn in"), ElementsAre("", ""));
  EXPECT_THAT(units("x_mm;Height [\u00c5]"), ElementsAre("mm", ""));  // none that is known
  EXPECT_THAT(units("m;mm"), ElementsAre("", ""));                    // names
  EXPECT_THAT(parse("a;x_mm;z_nm\n1;2;3\n", {.columns = {"z_nm", "a"}}).units,
              ElementsAre("nm", ""));
}

TEST(Dialect, FindsTheHeaderByTheNamesAskedFor) {
  const std::string text = "made 2024\n7 8\nx_mm\tz_um\ttext\nmm\tum\t\n0\t1\ta\n";
  const Table table = parse_table(text.substr(14), {.columns = {"z_um"}});
  EXPECT_THAT(table.columns, ElementsAre(ElementsAre(1.0)));
  EXPECT_EQ(complaint("x_mm,z_um\n0,abc\n1,2\n", {.columns = {"x_mm", "z_um"}}),
            "line 2, column 'z_um': 'abc' is no number");
}

TEST(Dialect, DoesAsItIsAsked) {
  EXPECT_THAT(parse("7,8\n9,10\n0,1\n", {.header_lines = 2}).columns,
              ElementsAre(ElementsAre(0.0), ElementsAre(1.0)));
  EXPECT_THAT(parse("0,1 2\n", {.delimiter = "blank", .decimal = ","}).columns,
              ElementsAre(ElementsAre(0.1), ElementsAre(2.0)));
  EXPECT_THAT(
      parse("x\xc3\xb6;1\n0;1\n", {.columns = {"x\u00c3\u00b6"}, .encoding = "latin-1"}).names,
      ElementsAre("x\u00c3\u00b6", "1"));
  EXPECT_THAT(complaint("x\xf6;z\n0;1\n", {.encoding = "utf-8"}), HasSubstr("is no UTF-8"));
  EXPECT_THROW(parse("0;1\n", {.delimiter = "|"}), UsageError);
  EXPECT_THROW(parse("0;1\n", {.decimal = ";"}), UsageError);
}

}  // namespace
}  // namespace slideway::dialect_test
