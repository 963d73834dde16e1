#include <gmock/gmock.h>

#include <algorithm>
#include <sstream>

#include "report/sample_result.hpp"
#include "slideway/report/report.hpp"

namespace slideway {
namespace {

using testing::HasSubstr;
using testing::Not;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// The first line that holds `what`, or "".
std::string line_with(const std::string& text, const std::string& what) {
  for (const std::string& line : lines_of(text))
    if (line.find(what) != std::string::npos) return line;
  return "";
}

std::size_t column_of(const std::string& line, const std::string& what) {
  return columns_of(line.substr(0, line.find(what)));
}

std::string on_one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  const auto both_blank = [](char a, char b) { return a == ' ' && b == ' '; };
  text.erase(std::unique(text.begin(), text.end(), both_blank), text.end());
  return text;
}

void expect_fits(const std::string& text) {
  for (const std::string& line : lines_of(text)) {
    EXPECT_LE(columns_of(line), 80U) << line;
    EXPECT_TRUE(line.empty() || line.back() != ' ') << "trailing blank: " << line;
  }
}

TEST(TextReport, HasNoLineOver80Columns) { expect_fits(text_report({sample_result()})); }

TEST(TextReport, HasNoLineOver80ColumnsWithLongNamesAndNumbers) {
  Result result = sample_result();
  result.title = std::string(200, 'x') + " und Längenmaß " + std::string(90, 'y');
  for (InputSummary& in : result.inputs) {
    in.name = std::string(70, 'n');
    in.samples = 4000000000U;
    in.position_min_mm = -123456.789;
    in.position_max_mm = 1.23456789e-7;
    in.rms_um = 1.2345e-9;
  }
  for (FittedParameter& p : result.final->parameters) {
    p.name = "revolution_periodic.cycles_per_revolution";
    p.expanded_uncertainty = 1e-17;
  }
  result.crosscheck.squareness->reason = std::string(300, 'z');
  expect_fits(text_report({result}));
}

TEST(TextReport, GivesAValueWithItsUncertaintyFactorAndUnit) {
  const std::string line = line_with(text_report({sample_result()}), "squareness.dbeta_xz");
  EXPECT_THAT(line, HasSubstr("Δβxz"));
  EXPECT_THAT(line, HasSubstr("(2.8000 ± 0.0022)e-06  rad"));
  EXPECT_THAT(line, HasSubstr("2.00"));
}

TEST(TextReport, GivesTheSquarenessInTheUnitsOfTheWorkshopToo) {
  const std::string text = text_report({sample_result()});
  EXPECT_THAT(line_with(text, "in µm/m"), HasSubstr("2.8000 ± 0.0022"));
  // 2.8e-6 rad * 648000 / π = 0.577541"; 2.2e-9 rad = 0.000454".
  EXPECT_THAT(line_with(text, "in arcsec"), HasSubstr("0.57754 ± 0.00045"));
}

TEST(TextReport, NeverShowsANumberForAParameterThatIsNotDetermined) {
  const std::string text = text_report({sample_result()});
  EXPECT_THAT(line_with(text, "vertical_straightness.c1"), HasSubstr("not determined"));
  EXPECT_THAT(text, Not(HasSubstr("777")));
}

TEST(TextReport, PutsTheUndeterminedDirectionInWordsWithItsAdvice) {
  const std::string text = on_one_line(text_report({sample_result()}));
  EXPECT_THAT(text, HasSubstr("0.71 c1 - 0.71 squareness.tilt"));
  EXPECT_THAT(text, HasSubstr("Measure a reference straightedge along Z"));
  EXPECT_THAT(text, HasSubstr("c1 + squareness.tilt = (2.500 ± 0.020)e-06 rad"));
}

TEST(TextReport, AlignsColumnsByCharactersNotBytes) {
  const std::string text = text_report({sample_result()});
  const std::size_t column = column_of(line_with(text, "value ± U"), "value ± U");
  EXPECT_EQ(column_of(line_with(text, "Δβxz"), "(2.8000"), column);
  EXPECT_EQ(column_of(line_with(text, "  b_2"), "(-2.290"), column);
  EXPECT_EQ(column_of(line_with(text, "  c_1"), "not determined"), column);
}

TEST(TextReport, ListsTheStrongestCorrelationsOfTheCandidatesAndTheRankingsNotes) {
  const std::string text = on_one_line(text_report({sample_result()}));
  EXPECT_THAT(text, HasSubstr("- constant profiles were passed over"));
  const auto strongest = text.find("squareness vertical_straightness feed2 +0.9700");
  const auto weaker = text.find("squareness straightness feed2 -0.2000");
  ASSERT_NE(strongest, std::string::npos);
  ASSERT_NE(weaker, std::string::npos);
  EXPECT_LT(strongest, weaker);
}

TEST(TextReport, ShowsALagOnlyWhereItsCoefficientIsClearlyLarger) {
  Result result = sample_result();
  EXPECT_THAT(text_report({result}), Not(HasSubstr("shifted")));
  result.ranking.entries[1].low_band = -0.6;
  EXPECT_THAT(on_one_line(text_report({result})),
              testing::ContainsRegex("larger when shifted: vertical_straightness on [^ ]* -0.9800 "
                                     "by -1.5 mm[.]"));
}

TEST(TextReport, NamesNoDominantEffectWhereThereIsADoubt) {
  Result result = sample_result();
  EXPECT_THAT(text_report({result}), HasSubstr("by fit squareness: the two agree."));
  result.dominant.agree = false;
  result.dominant.doubt = "no clear lead, by fit cup 51 % against step 49 %";
  EXPECT_THAT(text_report({result}),
              HasSubstr("Dominant effect: no clear lead, by fit cup 51 % against step 49 %.\n"));
}

TEST(TextReport, GivesChiSquareOnlyWhereUncertaintiesAreDeclared) {
  Result result = sample_result();
  EXPECT_THAT(text_report({result}), Not(HasSubstr("chi-square")));
  result.final->noise.front().scaling = NoiseScaling::declared;
  EXPECT_THAT(on_one_line(text_report({result})),
              HasSubstr("chi-square 131 at 133 degrees of freedom"));
}

TEST(TextReport, HasNoCrossCheckWhereThereIsNothingToCheck) {
  Result result = sample_result();
  result.crosscheck.squareness = SquarenessCheck{};
  result.crosscheck.squareness->reason = "the model declares no squareness";
  EXPECT_THAT(text_report({result}), Not(HasSubstr("Cross-check")));
}

TEST(TextReport, StatesTheCrossCheckWithEnAndTheAmplitudeOverTheTravel) {
  const std::string text = on_one_line(text_report({sample_result()}));
  EXPECT_THAT(text, HasSubstr("E_n = 0.25: consistent"));
  EXPECT_THAT(text, HasSubstr("Over the travel of 600 mm that is 1.68 µm by the fit and 1.65 µm"));
}

TEST(TextReport, ShoutsAnInconsistentCrossCheckWithItsReason) {
  Result result = sample_result();
  result.crosscheck.squareness->verdict = Consistency::inconsistent;
  result.crosscheck.squareness->En = 70.0;
  result.crosscheck.squareness->reason = "the fit asks for more than the run-out allows";
  const std::string text = on_one_line(text_report({result}));
  EXPECT_THAT(text, HasSubstr("E_n = 70: INCONSISTENT"));
  EXPECT_THAT(text, HasSubstr("(E_n is above 1). The fit asks for more than the run-out allows."));
  EXPECT_THAT(text, Not(HasSubstr("Over the travel")));  // the library's reason has it
}

TEST(TextReport, SaysHowUncertaintiesWereScaledPerProfile) {
  const std::string text = text_report({sample_result()});
  EXPECT_THAT(text, HasSubstr("How the uncertainties were scaled"));
  EXPECT_THAT(on_one_line(text), HasSubstr("feed2: the declared uncertainty is too small"));
}

TEST(TextReport, ShowsHeldOutResidualsApart) {
  EXPECT_THAT(line_with(text_report({sample_result()}), "held out"), HasSubstr("1.5 µrad"));
}

TEST(TextReport, LeavesOutWhatWasNotAskedFor) {
  Result result = sample_result();
  result.final.reset();
  result.crosscheck.squareness.reset();
  const std::string text = text_report({result});
  EXPECT_THAT(text, Not(HasSubstr("Fit:")));
  EXPECT_THAT(text, Not(HasSubstr("Cross-check")));
  EXPECT_THAT(text, HasSubstr("Ranking"));
}

TEST(TextReport, ListsDetectionLimitsInColumnsHoweverLongTheirShapes) {
  TraceResult trace;
  trace.detection_limits = {{"edge_roll_off",
                             "amplitude_um",
                             "µm",
                             140.0,
                             "width_mm = 0.135",
                             {{0.1, 0.32}, {2.0, 2e10}}},
                            {"revolution_periodic",
                             "amplitude_um",
                             "µm",
                             0.0113,
                             "cycles_per_revolution = 0.01894",
                             {{0.1, 0.0059}, {0.5, 0.015}}}};
  const std::string text = text_report({sample_result(), trace});
  expect_fits(text);
  const std::string line = line_with(text, "revolution_periodic");
  EXPECT_THAT(line, testing::ContainsRegex("0.011 µm +0.0059 to 0.015 +cycles_.*0.01894$"));
  EXPECT_EQ(column_of(line, "cycles_"), column_of(line_with(text, "edge_roll_off"), "width_mm"));
}

TEST(TextReport, IsTheSameTextEveryTime) {
  EXPECT_EQ(text_report({sample_result()}), text_report({sample_result()}));
}

}  // namespace
}  // namespace slideway
