#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "format/hostile.hpp"
#include "slideway/base/text.hpp"

namespace slideway::nist_xml_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const Format& nist = nist_xml_format();

const std::string kSmall =
    "<?xml version='1.0' encoding='UTF-8'?>\n<!DOCTYPE DATA SYSTEM \"data.dtd\">\n<DATA>\n"
    "<DATAFILE>\n<UNITS>um</UNITS>\n<NUMPOINTS>3</NUMPOINTS>\n<SPACING>0.25</SPACING>\n"
    "<DATA_TYPE>2D</DATA_TYPE>\n<DATA_POINT_VALUES>0.5\n-1.25\n7\n</DATA_POINT_VALUES>\n"
    "</DATAFILE>\n</DATA>";

std::vector<double> without_mean(std::vector<double> heights) {
  const double mean =
      std::accumulate(heights.begin(), heights.end(), 0.0) / static_cast<double>(heights.size());
  for (double& height : heights) height -= mean;
  return heights;
}

// Gaussian filter of ISO 16610-21 where the whole weighting function fits, cut off at one cut-off
// length to each side. NIST takes the cut-off as a whole number of samples.
std::vector<double> short_cutoff(const std::vector<double>& heights, int cutoff) {
  const double alpha = std::sqrt(std::numbers::ln2 / std::numbers::pi);
  std::vector<double> weights;
  for (int i = -cutoff; i <= cutoff; ++i)
    weights.push_back(std::exp(-std::numbers::pi * std::pow(i / (alpha * cutoff), 2)));
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  std::vector<double> filtered(heights.size() - weights.size() + 1);
  for (std::size_t i = 0; i < filtered.size(); ++i)
    for (std::size_t k = 0; k < weights.size(); ++k)
      filtered[i] += weights[k] / sum * heights[i + k];
  return filtered;
}

double mean_of(const std::vector<double>& heights, double (*power)(double)) {
  double sum = 0.0;
  for (const double height : heights) sum += power(height);
  return sum / static_cast<double>(heights.size());
}

// A published value: the text of an element, "0.6827", good to the fifth decimal, as NIST rounds.
void expect_published(const std::string& file, const std::string& name, double value) {
  const std::size_t begin = file.find("<" + name + ">") + name.size() + 2;
  ASSERT_LT(begin, file.size()) << name;
  const auto published = parse_double(file.substr(begin, file.find('<', begin) - begin));
  ASSERT_TRUE(published) << name;
  EXPECT_LE(std::abs(value - *published), 0.5e-5) << name << ", published " << *published;
}

// The mean is taken off the measured profile, before the filter: with the mean taken off after it,
// Psk, Pku, Pp and Pv of mill.xml differ from the published in the fifth decimal.
void expect_published_parameters(const std::string& name, int cutoff) {
  const std::string file = sample("nist_npl_reference_profiles/" + name);
  if (file.empty()) GTEST_SKIP() << "no measured data";
  ASSERT_TRUE(nist.recognises(file));
  std::vector<double> z = without_mean(nist.read(file, {}).values);
  if (cutoff > 0) z = short_cutoff(z, cutoff);

  const double pq = std::sqrt(mean_of(z, [](double h) { return h * h; }));
  const auto [valley, peak] = std::minmax_element(z.begin(), z.end());
  expect_published(file, "PA", mean_of(z, [](double h) { return std::abs(h); }));
  expect_published(file, "PQ", pq);
  expect_published(file, "PSK", mean_of(z, [](double h) { return h * h * h; }) / std::pow(pq, 3));
  expect_published(file, "PKU",
                   mean_of(z, [](double h) { return h * h * h * h; }) / std::pow(pq, 4));
  expect_published(file, "Pp", *peak);
  expect_published(file, "Pv", -*valley);
  expect_published(file, "Pt", *peak - *valley);
}

// Cut-off 0.8 um: three whole samples of 0.25 um, one of 0.5 um; sine.xml is not filtered.
TEST(NistXml, GivesThePublishedParametersOfTheMilledSurface) {
  expect_published_parameters("mill.xml", 3);
}
TEST(NistXml, GivesThePublishedParametersOfTheSine) { expect_published_parameters("sine.xml", 0); }
TEST(NistXml, GivesThePublishedParametersOfTheSquareWave) {
  expect_published_parameters("square.xml", 1);
}

TEST(NistXml, ReadsSpacingAndUnits) {
  ASSERT_TRUE(nist.recognises(kSmall));
  const Trace trace = nist.read(kSmall, {});
  EXPECT_THAT(trace.positions, ElementsAre(0.0, 0.25, 0.5));
  EXPECT_THAT(trace.values, ElementsAre(0.5, -1.25, 7.0));
  EXPECT_EQ(trace.position_unit, "um");
  EXPECT_EQ(trace.value_unit, "um");
  expect_every_truncation_refused(nist, kSmall);
}

TEST(NistXml, WritesWhatItReads) {
  const Trace trace{
      {0.0, 0.1, 0.2, 0.30000000000000004}, {1.0 / 3.0, -2e-300, 0.0, 5e7}, "um", "um", {}};
  const std::string bytes = nist.write(trace);
  const Trace back = nist.read(bytes, {});
  EXPECT_EQ(back.positions, trace.positions);
  EXPECT_EQ(back.values, trace.values);
  EXPECT_EQ(nist.write(back), bytes);
  expect_every_truncation_refused(nist, bytes);
  EXPECT_THROW((void)nist.write({{0.0, 1.0}, {1.0, std::nan("")}, "mm", "um", {}}), UsageError);
  EXPECT_THAT(nist.read(nist.write({{0.0, 0.5}, {1.0, 2.0}, "mm", "um", {}}), {}).positions,
              ElementsAre(0.0, 500.0));
}

TEST(NistXml, RefusesHostileFiles) {
  const auto wrong = [&](const std::string& what, const std::string& by) {
    return refusal(nist, replaced(kSmall, what, by));
  };
  EXPECT_THAT(wrong("<NUMPOINTS>3", "<NUMPOINTS>-3"), HasSubstr("NUMPOINTS"));
  EXPECT_THAT(wrong("<NUMPOINTS>3", "<NUMPOINTS>1e18"), HasSubstr("NUMPOINTS"));
  EXPECT_THAT(wrong("<NUMPOINTS>3", "<NUMPOINTS>1000000000000000"), HasSubstr("are declared"));
  EXPECT_THAT(wrong("<NUMPOINTS>3", "<NUMPOINTS>4"), HasSubstr("3 values where 4"));
  EXPECT_THAT(wrong("<UNITS>um", "<UNITS>V"), HasSubstr("UNITS"));
  EXPECT_THAT(wrong("0.25", "0"), HasSubstr("SPACING"));
  EXPECT_THAT(wrong("-1.25", "&lol;"), HasSubstr("value 2"));
  EXPECT_THAT(wrong("DATA_TYPE>2D", "DATA_TYPE>3D"), HasSubstr("DATA_TYPE"));
  EXPECT_THAT(wrong("SYSTEM \"data.dtd\"", "[<!ENTITY a \"&b;&b;\"><!ENTITY b \"&c;&c;\">]"),
              HasSubstr("declares entities"));
  std::string deep = "<DATA>";
  for (int i = 0; i < 100'000; ++i) deep += "<nested>";
  for (int i = 0; i < 100'000; ++i) deep += "</nested>";
  EXPECT_THAT(refusal(nist, deep + "</DATA>"), HasSubstr("nested deeper than 32"));
  std::string wide = "<DATA>";
  for (int i = 0; i < 100'000; ++i) wide += "<a/>";
  EXPECT_THAT(refusal(nist, wide + "</DATA>"), HasSubstr("100002 tags"));
  EXPECT_THAT(refusal(nist, "<?xml version='1.0'?><html/>"), HasSubstr("DATA/DATAFILE"));
  EXPECT_THAT(refusal(nist, "<?xml version='1.0'?><DATA>" + std::string(1'000, '<')),
              HasSubstr("no well-formed XML"));
  EXPECT_THROW((void)nist.read(kSmall, {.line = "row:1"}), UsageError);
}

}  // namespace
}  // namespace slideway::nist_xml_test
