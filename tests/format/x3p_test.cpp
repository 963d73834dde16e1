#include <gmock/gmock.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>

#include "format/deflated.hpp"
#include "format/hostile.hpp"
#include "format/x3p_checksum.hpp"
#include "format/zip_archive.hpp"

namespace slideway::x3p_test {
namespace {

using testing::DoubleEq;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsNan;
using testing::NanSensitiveDoubleEq;
using testing::Pointwise;

using Files = std::vector<std::pair<std::string, std::string>>;

const Format& x3p = x3p_format();

TraceRequest line(const std::string& text) { return {.line = text}; }

std::string axis(const std::string& name, const std::string& content) {
  return "<" + name + ">" + content + "</" + name + ">";
}

const std::string kCounted =
    "<AxisType>I</AxisType><DataType>D</DataType><Increment>0.5</Increment><Offset>2</Offset>";
std::string absolute(char type) {
  return std::string("<AxisType>A</AxisType><DataType>") + type + "</DataType>";
}

// main.xml of a profile with these axes and this Record3.
std::string main_xml(const std::string& record3, const std::string& x = kCounted,
                     const std::string& z = absolute('D'), const std::string& feature = "PRF") {
  return "<p:ISO5436_2 xmlns:p=\"http://www.opengps.eu/2008/ISO5436_2\"><Record1><Revision>ISO5436 "
         "- 2000</Revision><FeatureType>" +
         feature + "</FeatureType><Axes>" + axis("CX", x) + axis("CY", kCounted) + axis("CZ", z) +
         "</Axes></Record1><Record3>" + record3 +
         "</Record3><Record4><ChecksumFile>md5checksum.hex</ChecksumFile></Record4></p:ISO5436_2>";
}

std::string matrix(std::size_t columns, std::size_t rows = 1) {
  return "<MatrixDimension><SizeX>" + std::to_string(columns) + "</SizeX><SizeY>" +
         std::to_string(rows) + "</SizeY><SizeZ>1</SizeZ></MatrixDimension>";
}

std::string link_to(const std::string& data) {
  return "<DataLink><PointDataLink>bindata/data.bin</PointDataLink><MD5ChecksumPointData>" +
         md5(data) + "</MD5ChecksumPointData></DataLink>";
}

std::string archive(const std::string& main, const Files& more = {}) {
  Files files{{"main.xml", main}, {"md5checksum.hex", md5(main) + " *main.xml\n"}};
  files.insert(files.end(), more.begin(), more.end());
  return zip_archive(files);
}

std::string with_list(const std::string& datums, std::size_t count,
                      const std::string& x = kCounted) {
  return archive(main_xml(matrix(count) + "<DataList>" + datums + "</DataList>", x));
}

template <typename Number>
std::string bytes_of(const std::vector<Number>& numbers) {
  std::string bytes(numbers.size() * sizeof(Number), '\0');
  std::memcpy(bytes.data(), numbers.data(), bytes.size());  // the test runs on little-endian
  return bytes;
}

template <typename Number>
std::vector<double> heights_of(char type, const std::vector<Number>& numbers,
                               const std::string& z_more = {}) {
  const std::string data = bytes_of(numbers);
  return x3p
      .read(archive(
                main_xml(matrix(numbers.size()) + link_to(data), kCounted, absolute(type) + z_more),
                {{"bindata/data.bin", data}}),
            {})
      .values;
}

// ----- the samples of the openGPS library

const double kRow2[] = {0.857622027393310, 1.04759602566142, 1.01879225277798,
                        std::numeric_limits<double>::quiet_NaN()};

class X3pSample : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"1", "1_bin", "2"}) {
      files_[name] = sample(std::string("surface_format_samples/ISO5436-sample") + name + ".x3p");
      if (files_[name].empty()) GTEST_SKIP() << "no measured data";
    }
  }
  std::map<std::string, std::string> files_;
};

TEST_F(X3pSample, HoldsTheSameInXmlAndInBinary) {
  for (const char* name : {"1", "1_bin"}) {
    ASSERT_TRUE(x3p.recognises(files_[name]));
    const Trace row = x3p.read(files_[name], line("row:2"));
    EXPECT_THAT(row.values, Pointwise(NanSensitiveDoubleEq(), kRow2));
    EXPECT_THAT(row.positions, Pointwise(DoubleEq(), {0.0, 0.016016, 0.032032, 0.048048}));
    EXPECT_EQ(row.position_unit, "m");
    EXPECT_EQ(row.value_unit, "m");
  }
  for (const char* request : {"row:1", "row:2", "row:3", "row:4", "column:1", "column:4",
                              "diameter:0", "diameter:45", "diameter:90"}) {
    const Trace xml = x3p.read(files_["1"], line(request));
    const Trace binary = x3p.read(files_["1_bin"], line(request));
    EXPECT_EQ(xml.positions, binary.positions);
    EXPECT_THAT(xml.values, Pointwise(NanSensitiveDoubleEq(), binary.values)) << request;
  }
}

TEST_F(X3pSample, NeedsALineAndNamesTheChoices) {
  for (const auto& file : files_)
    EXPECT_THAT([&] { (void)x3p.read(file.second, {}); },
                testing::ThrowsMessage<UsageError>(HasSubstr("4 rows of 4 points")))
        << file.first;
}

TEST_F(X3pSample, ReadsAListOfPointsOnAGrid) {
  // x is absolute, in steps of 1 um from an offset of 0.1 m.
  const Trace row = x3p.read(files_["2"], line("row:3"));
  EXPECT_THAT(row.positions, Pointwise(DoubleEq(), {0.1, 0.1 + 1e-6, 0.1 + 2e-6, 0.1 + 3e-6}));
  // The heights have an offset of 2 m.
  EXPECT_THAT(row.values, Pointwise(DoubleEq(), {2.823683772970184, 2.797872489327661,
                                                 2.0 - 0.557459388341694, 2.0 - 0.23324785884922}));
}

TEST_F(X3pSample, IsRefusedWhereverItIsCutOff) {
  for (const auto& [name, bytes] : files_)
    expect_every_truncation_refused(x3p, bytes, line("row:1"));
}

TEST_F(X3pSample, IsRefusedOrReadWhateverByteIsChanged) {
  for (const auto& [name, bytes] : files_)
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      std::string damaged = bytes;
      damaged[i] = static_cast<char>(damaged[i] ^ 0x55);
      try {
        (void)x3p.read(damaged, line("row:2"));
      } catch (const DataError&) {
      }
    }
}

// ----- files made here

TEST(X3p, WritesWhatItReads) {
  const std::vector<double> values{1.0 / 3.0, -2e-300, std::nan(""), 5e7};
  for (const std::vector<double>& positions : {std::vector{0.0, 0.1, 0.2, 0.30000000000000004},
                                               {3.0, 3.5, 4.0, 4.5},
                                               {0.0, 1.0, 2.0, 7.0},
                                               {9.0, 8.0, 7.0, 7.0}}) {
    const std::string bytes = x3p.write({positions, values, "m", "m", {}});
    ASSERT_TRUE(x3p.recognises(bytes));
    const Trace back = x3p.read(bytes, {});
    EXPECT_EQ(back.positions, positions);
    EXPECT_THAT(back.values, Pointwise(NanSensitiveDoubleEq(), values));
    EXPECT_EQ(x3p.write(back), bytes);
    expect_every_truncation_refused(x3p, bytes);
  }
}

TEST(X3p, WritesMetres) {
  const Trace back = x3p.read(x3p.write({{0.0, 7.0}, {3.0, 4.0}, "mm", "um", {}}), {});
  EXPECT_THAT(back.positions, ElementsAre(0.0, 0.007));
  EXPECT_THAT(back.values, ElementsAre(3e-6, 4e-6));
  EXPECT_THROW((void)x3p.write({{0.0, 7.0}, {3.0, 4.0}, "mm", "urad", {}}), UsageError);
  EXPECT_THROW((void)x3p.write({{0.0, 7.0}, {3.0}, "mm", "um", {}}), UsageError);
  EXPECT_THROW((void)x3p.write({{0.0, std::nan("")}, {3.0, 4.0}, "mm", "um", {}}), UsageError);
}

TEST(X3p, ReadsEveryDataType) {
  EXPECT_THAT(heights_of<std::int16_t>('I', {3, -3, 32767}), ElementsAre(3.0, -3.0, 32767.0));
  EXPECT_THAT(heights_of<std::int32_t>('L', {3, -3, 2147483647}),
              ElementsAre(3.0, -3.0, 2147483647.0));
  EXPECT_THAT(heights_of<float>('F', {0.5F, -3.0F}), ElementsAre(0.5, -3.0));
  EXPECT_THAT(heights_of<double>('D', {0.1, -3.0, std::nan("")}), ElementsAre(0.1, -3.0, IsNan()));
  EXPECT_THAT(
      heights_of<std::int16_t>('I', {3, -3}, "<Increment>0.25</Increment><Offset>1</Offset>"),
      ElementsAre(1.75, 0.25));
}

TEST(X3p, TellsOfAnIncrementWhereNoneBelongs) {
  const std::string data = bytes_of<float>({3.0F, -3.0F});
  const auto read_with = [&](const std::string& increment) {
    return x3p.read(archive(main_xml(matrix(2) + link_to(data), kCounted,
                                     absolute('F') + "<Increment>" + increment + "</Increment>"),
                            {{"bindata/data.bin", data}}),
                    {});
  };
  EXPECT_THAT(read_with("0.5").values, ElementsAre(1.5, -1.5));
  EXPECT_THAT(read_with("0.5").decisions, ElementsAre(HasSubstr("multiplied")));
  for (const char* plain : {"0", "1"}) {
    EXPECT_THAT(read_with(plain).values, ElementsAre(3.0, -3.0));
    EXPECT_TRUE(read_with(plain).decisions.empty());
  }
}

TEST(X3p, ReadsBitsOfValidPoints) {
  const std::string data = bytes_of<std::int16_t>({1, 2, 3, 4, 5, 6, 7, 8, 9, 10});
  const std::string valid = "\x7e\x02";  // all but the first, the eighth and the ninth
  const std::string record =
      matrix(10) + replaced(link_to(data), "</DataLink>",
                            "<ValidPointsLink>bindata/valid.bin</ValidPointsLink>"
                            "<MD5ChecksumValidPoints>" +
                                md5(valid) + "</MD5ChecksumValidPoints></DataLink>");
  const Trace trace = x3p.read(archive(main_xml(record, kCounted, absolute('I')),
                                       {{"bindata/data.bin", data}, {"bindata/valid.bin", valid}}),
                               {});
  EXPECT_THAT(trace.values, ElementsAre(IsNan(), 2, 3, 4, 5, 6, 7, IsNan(), IsNan(), 10));
}

TEST(X3p, ReadsDatumsOfEveryForm) {
  EXPECT_THAT(x3p.read(with_list("<Datum>1</Datum><Datum/><Datum> NaN </Datum>", 3), {}).values,
              ElementsAre(1.0, IsNan(), IsNan()));
  // The counted axes spelled out as numbers of steps.
  const Trace indexed = x3p.read(with_list("<Datum>4;0;1</Datum><Datum>6;0;2e-1</Datum>", 2), {});
  EXPECT_THAT(indexed.positions, ElementsAre(4.0, 5.0));
  EXPECT_THAT(indexed.values, ElementsAre(1.0, 0.2));
  const Trace absolute_x =
      x3p.read(with_list("<Datum>7;1</Datum><Datum/><Datum>9;2</Datum>", 3, absolute('D')), {});
  EXPECT_THAT(absolute_x.positions, ElementsAre(7.0, 9.0));
  EXPECT_THAT(absolute_x.values, ElementsAre(1.0, 2.0));
  EXPECT_THAT(absolute_x.decisions, ElementsAre(HasSubstr("1 missing points have no position")));
}

TEST(X3p, VerifiesEveryChecksum) {
  const std::string data = bytes_of<double>({1.0, 2.0});
  const std::string main = main_xml(matrix(2) + link_to(data));
  const Files data_file{{"bindata/data.bin", data}};
  const std::string other = bytes_of<double>({1.0, 2.5});
  const std::string damaged_data = archive(main, {{"bindata/data.bin", other}});
  const std::string damaged_main = zip_archive(
      Files{{"main.xml", main}, {"md5checksum.hex", md5("") + " *main.xml"}, data_file[0]});
  const std::string none = zip_archive(Files{{"main.xml", main}, data_file[0]});
  EXPECT_EQ(refusal(x3p, archive(main, data_file)), "");
  EXPECT_THAT(refusal(x3p, damaged_data), HasSubstr("data.bin: the MD5 checksum is"));
  EXPECT_THAT(refusal(x3p, damaged_main), HasSubstr("main.xml: the MD5 checksum is"));
  EXPECT_THAT(refusal(x3p, none), HasSubstr("main.xml: the file gives no MD5"));
  for (const std::string& bytes : {damaged_data, damaged_main, none})
    EXPECT_THAT(x3p.read(bytes, {.ignore_checksum = true}).decisions,
                ElementsAre(HasSubstr("read nevertheless")));
}

TEST(X3p, KnowsTheDigestsOfRfc1321) {
  EXPECT_EQ(md5(""), "d41d8cd98f00b204e9800998ecf8427e");
  EXPECT_EQ(md5("message digest"), "f96b697d7cb7938d525a2f31aaf161d0");
}

// ----- hostile files

TEST(X3p, RefusesCountsTheFileCanNotHold) {
  const std::string data = bytes_of<double>({1.0, 2.0});
  const auto with_record = [&](const std::string& record) {
    return refusal(x3p, archive(main_xml(record), {{"bindata/data.bin", data}}));
  };
  EXPECT_THAT(with_record(matrix(3) + link_to(data)), HasSubstr("the points declared need 24"));
  EXPECT_THAT(with_record(matrix(1) + link_to(data)), HasSubstr("at most 8 belong there"));
  EXPECT_THAT(with_record(matrix(1'000'000'000'000'000) + link_to(data)), HasSubstr("need"));
  EXPECT_THAT(with_record("<ListDimension>1000000000000000000</ListDimension>" + link_to(data)),
              HasSubstr("ListDimension"));
  EXPECT_THAT(with_record(matrix(1'000'000'000'000, 1'000'000'000'000) + link_to(data)),
              HasSubstr("more points than any file holds"));
  EXPECT_THAT(with_record("<ListDimension>-2</ListDimension>" + link_to(data)),
              HasSubstr("ListDimension"));
  EXPECT_THAT(with_record(replaced(matrix(2), "<SizeZ>1", "<SizeZ>2") + link_to(data)),
              HasSubstr("SizeZ"));
  EXPECT_THAT(with_record(matrix(1'000'000'000'000'000) + "<DataList><Datum>1</Datum></DataList>"),
              HasSubstr("1 Datum where"));
  EXPECT_THAT(with_record(matrix(1) + "<DataList><Datum>1</Datum><Datum>1</Datum></DataList>"),
              HasSubstr("only 1 are declared"));
}

TEST(X3p, RefusesBadNumbersAndElements) {
  EXPECT_THAT(refusal(x3p, with_list("<Datum>1</Datum><Datum>1,5</Datum>", 2)),
              HasSubstr("Datum 2"));
  EXPECT_THAT(refusal(x3p, with_list("<Datum>1</Datum><Datum>inf</Datum>", 2)),
              HasSubstr("Datum 2"));
  EXPECT_THAT(refusal(x3p, with_list("<Datum/><Datum/>", 2, absolute('D'))),
              HasSubstr("no point has a position"));
  EXPECT_THAT(refusal(x3p, with_list("<Datum>1;2</Datum>", 1)), HasSubstr("2 numbers; accepted"));
  EXPECT_THAT(refusal(x3p, with_list("<Datum>0;0;1</Datum><Datum>1</Datum>", 2)),
              HasSubstr("other axes"));
  EXPECT_THROW((void)heights_of<double>('D', {1.0, INFINITY}), DataError);
  const std::string data = bytes_of<double>({1.0, 2.0});
  const auto wrong = [&](const std::string& what, const std::string& by) {
    const std::string main = replaced(main_xml(matrix(2) + link_to(data)), what, by);
    return refusal(x3p, archive(main, {{"bindata/data.bin", data}}));
  };
  EXPECT_THAT(wrong("PRF", "XYZ"), HasSubstr("FeatureType: 'XYZ'"));
  EXPECT_THAT(wrong("<AxisType>I", "<AxisType>R"), HasSubstr("CX/AxisType: 'R'"));
  EXPECT_THAT(wrong("<DataType>D", "<DataType>Q"), HasSubstr("CX/DataType: 'Q'"));
  EXPECT_THAT(wrong("<Increment>0.5", "<Increment>1e999"), HasSubstr("CX/Increment"));
  EXPECT_THAT(wrong("<Increment>0.5</Increment>", ""), HasSubstr("CX: the element Increment"));
  EXPECT_THAT(wrong("bindata/data.bin", "../data.bin"), HasSubstr("missing"));
  EXPECT_THAT(wrong("bindata/data.bin", ""), HasSubstr("missing"));
  EXPECT_THAT(refusal(x3p, archive("<html/>")), HasSubstr("the root is 'html'"));
  EXPECT_THAT(refusal(x3p, archive("")), HasSubstr("no well-formed XML"));
}

TEST(X3p, RefusesXmlBombsAndDeepNesting) {
  EXPECT_THAT(refusal(x3p, archive("<!DOCTYPE a [<!ENTITY b \"&c;&c;\"><!ENTITY c \"&d;&d;\">]>" +
                                   main_xml(matrix(1)))),
              HasSubstr("a DOCTYPE is not accepted"));
  std::string deep;
  for (int i = 0; i < 100'000; ++i) deep += "<nested>";
  EXPECT_THAT(refusal(x3p, archive(deep)), HasSubstr("no well-formed XML"));
  for (int i = 0; i < 100'000; ++i) deep += "</nested>";
  EXPECT_THAT(refusal(x3p, archive(deep)), HasSubstr("nested deeper than 32"));
}

TEST(X3p, RefusesZipBombs) {
  // 50 MB of zeros in some 50 kB.
  const std::string zeros(50'000'000, '\0');
  const std::string main = main_xml(matrix(zeros.size() / 8) + link_to(zeros));
  const std::string bomb =
      deflated({{"main.xml", main}, {"md5checksum.hex", md5(main)}, {"bindata/data.bin", zeros}});
  ASSERT_LT(bomb.size(), 200'000);
  EXPECT_THAT(refusal(x3p, bomb), HasSubstr("more than 100 to 1"));
  EXPECT_THAT(refusal(x3p, deflated({{"main.xml", std::string(5'000'000, ' ')}})),
              HasSubstr("5000000 bytes declared, at most 1048576 belong there"));
}

TEST(X3p, DoesNotTrustDeclaredSizes) {
  const std::string bytes = x3p.write({{0.0, 1.0}, {1.0, 2.0}, "m", "m", {}});
  // In each header the uncompressed size stands 22 (local) or 24 (central) bytes from the mark.
  for (const auto& [mark, offset] :
       {std::pair<std::string, std::size_t>{"PK\x03\x04", 22}, {"PK\x01\x02", 24}})
    for (std::size_t at = bytes.find(mark); at != std::string::npos; at = bytes.find(mark, at + 1))
      for (const char* size : {"\xff\xff\xff\x7f", "\xff\xff\xff\xff", "\x01\x01\x01\x01"}) {
        std::string lying = bytes;
        lying.replace(at + offset, 4, size, 4);
        const std::string message = refusal(x3p, lying);
        // Nobody reads the copy in the local header.
        if (offset == 24) {
          EXPECT_NE(message, "");
        }
      }
}

TEST(X3p, RefusesTricksWithNames) {
  const std::string main = main_xml(matrix(1) + "<DataList><Datum>1</Datum></DataList>");
  EXPECT_EQ(refusal(x3p, archive(main, {{"vendor/readme.txt", ""}})), "");
  for (const char* name : {"../evil", "/etc/passwd", "a/../../b", "a\\b", "c:evil", "a/.."})
    EXPECT_THAT(refusal(x3p, archive(main, {{name, ""}})), HasSubstr("its path leads out")) << name;
  for (const char* name : {"more.zip", "inner.X3P"})
    EXPECT_THAT(refusal(x3p, archive(main, {{name, ""}})), HasSubstr("an archive in the archive"));
  // libzip writes no name twice: rename another entry in both its headers.
  std::string twice = archive(main, {{"Main.xml", main}});
  for (std::size_t at = twice.find("Main.xml"); at != std::string::npos;
       at = twice.find("Main.xml"))
    twice[at] = 'm';
  EXPECT_THAT(refusal(x3p, twice), HasSubstr("is there twice"));
  EXPECT_THAT(refusal(x3p, zip_archive(Files{{"other.xml", main}})),
              HasSubstr("'main.xml' is missing"));
}

}  // namespace
}  // namespace slideway::x3p_test
