#include <gmock/gmock.h>

#include <algorithm>
#include <sstream>

#include "report/sample_result.hpp"
#include "slideway/report/report.hpp"

namespace slideway::text_report_test {
namespace {

using testing::HasSubstr;
using testing::Not;

std::size_t column_of(const std::string& line, const std::string& what) {
  return columns_of(line.substr(0, line.find(what)));
}

std::string on_one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  const auto both_blank = [](char a, char b) { return a == ' ' && b == ' '; };
  text.erase(std::unique(text.begin(), text.end(), both_blank), text.end());
  return text;
}

/// All that was found.
std::string full(const Result& result, const std::optional<TraceResult>& trace = {}) {
  return text_report({result, trace}, {.full = true});
}

std::string short_text(const Result& result, const std::optional<TraceResult>& trace = {}) {
  return text_report({result, trace});
}

void expect_fits(const std::string& text) {
  for (const std::string& line : lines_of(text)) {
    EXPECT_LE(columns_of(line), 80U) << line;
    EXPECT_TRUE(line.empty() || line.back() != ' ') << "trailing blank: " << line;
  }
}

TEST(TextReport, StartsWithABoxOfAtMostSixLines) {
  Result result = sample_result();
  result.crosscheck.squareness->reason = std::string(300, 'z');
  TraceResult trace;
  trace.verdict = TraceVerdict::ambiguous;
  for (const char* name : {"thermal_drift", "revolution_periodic", "spindle_runout", "cup"}) {
    TraceRound& round = trace.rounds.emplace_back();
    round.accepted = name;
    round.ambiguous_with = {"time_periodic", "traverse_periodic"};
  }
  trace.advice = {"a cut at another speed and " + std::string(50, 'w') + " would tell them apart"};
  for (const std::string& text :
       {short_text(sample_result()), text_report({result, trace}, {.page = "face.html"})}) {
    const std::vector<std::string> lines = lines_of(text);
    std::size_t box = 0;
    while (lines[box].starts_with("│")) ++box;
    EXPECT_EQ(box, 6U) << text;
    for (const char* label : {"Verdict", "Result", "Check", "Next", "Page"})
      EXPECT_THAT(text, HasSubstr(std::string("│ ") + label));
    const bool has_missing = text.find("face.html") != std::string::npos;
    EXPECT_EQ(text.find("│ Missing") != std::string::npos, has_missing) << text;
    expect_fits(text);
  }
}

TEST(TextReport, CutsNoSentenceOfTheBoxWhileAnEntrySaysNothing) {
  TraceResult trace;
  trace.verdict = TraceVerdict::unnamed;
  trace.advice = {"thermal_drift and cup: a cut at 12 mm/min (like feed2) would tell them apart " +
                  std::string("best; predicted difference in BIC 55")};
  Result result = sample_result();
  result.final->identifiability.unidentifiable.clear();  // its advice would come first
  const std::string text = short_text(result, trace);
  EXPECT_THAT(on_one_line(text), HasSubstr("(like feed2) would tell │ them apart best"));
  EXPECT_THAT(text, Not(HasSubstr("…")));
  EXPECT_THAT(text, Not(HasSubstr("│ Missing")));
}

TEST(TextReport, WritesEnInAsManyDigitsAsTellItFromItsLimit) {
  Result result = sample_result();
  result.crosscheck.profiles = {{.profiles = {"a", "c"},
                                 .what = "squareness",
                                 .En = 1.004,
                                 .verdict = Consistency::inconsistent}};
  EXPECT_THAT(full(result), HasSubstr("squareness of a and c: E_n = 1.004, inconsistent"));
  result.crosscheck.profiles[0].En = 1.26;
  EXPECT_THAT(full(result), HasSubstr("E_n = 1.3"));
}

TEST(TextReport, NamesTheDefinitionOfEachStraightness) {
  Result result = sample_result();
  result.conformity = {{.what = "straightness",
                        .value_um = 0.25,
                        .U_um = 0.02,
                        .limit_um = 0.3,
                        .verdict = ConformityVerdict::undecided}};
  EXPECT_THAT(line_with(short_text(result), "│ Result"), HasSubstr("0.020 µm (end points);"));
  EXPECT_THAT(line_with(short_text(result), "Tolerance of"),
              HasSubstr("straightness (minimum zone): 0.250 ± 0.020, limit 0.3 µm: cannot"));
}

TEST(TextReport, NamesALossOtherThanTheSquare) {
  Result result = sample_result();
  EXPECT_THAT(full(result), Not(HasSubstr("loss huber")));
  result.inputs[0].loss = Loss::huber;
  EXPECT_THAT(on_one_line(full(result)), HasSubstr("left out, loss huber"));
}

TEST(TextReport, CountsInTheBoxWhatItHasNoRoomToName) {
  TraceResult trace;
  trace.verdict = TraceVerdict::explained;
  for (const char* name : {"thermal_drift", "spindle_runout", "centre_height", "tool_wear"}) {
    TraceRound& round = trace.rounds.emplace_back();
    round.accepted = name;
    round.ambiguous_with = {"time_periodic", "traverse_periodic"};
  }
  EXPECT_THAT(line_with(short_text(sample_result(), trace), "│ Missing"),
              HasSubstr("thermal drift (2 rivals) and spindle run-out (2 rivals) and 2 more"));
}

TEST(TextReport, CanBeReadOneWay) {
  TraceResult trace;
  trace.verdict = TraceVerdict::ambiguous;
  trace.rounds.resize(2);
  trace.rounds[0].accepted = "tool_wear";
  trace.rounds[0].ambiguous_with = {"step"};
  trace.rounds[1].accepted = "straightness";  // which the sample declares
  const std::string text = full(sample_result(), trace);
  EXPECT_THAT(text, HasSubstr("(tool wear or step) and"));
  EXPECT_THAT(text, HasSubstr("a higher degree of"));
  EXPECT_THAT(line_with(short_text(sample_result(), trace), "│ Missing"),
              ::testing::AnyOf(HasSubstr("(tool wear or step)"), HasSubstr("(1 rival)")));
}

TEST(TextReport, CountsProfilesThatAgreeAsACheck) {
  Result result = sample_result();
  result.crosscheck.squareness->En.reset();
  for (const double En : {0.2, 0.7})
    result.crosscheck.profiles.push_back({.profiles = {"a", "b"},
                                          .what = "squareness",
                                          .En = En,
                                          .verdict = Consistency::consistent});
  EXPECT_THAT(line_with(short_text(result), "│ Check"),
              HasSubstr("the profiles agree, E_n up to 0.7"));
}

TEST(TextReport, IsAtMost40LinesHoweverMuchThereIsToSay) {
  Result result = sample_result();
  for (int i = 0; i < 60; ++i) {
    result.final->parameters.push_back(fitted("cup.sag_" + std::to_string(i), "A", "um", i, 0.1));
    result.notes.push_back("note " + std::to_string(i) +
                           " of many words that fill more than one "
                           "line of the report for people");
    result.assumed.push_back({"profile.feed2.key_" + std::to_string(i), "0.0", "default"});
  }
  result.final->straightness->stations.assign(50, {1.0, 0.5, 0.1});
  const std::string text = short_text(result);
  EXPECT_LE(lines_of(text).size(), 40U);
  EXPECT_THAT(text, HasSubstr("more parameters: --full"));
  EXPECT_THAT(text, HasSubstr("more notes: --full"));
  EXPECT_THAT(full(result), HasSubstr("A"));
  expect_fits(text);
}

TEST(TextReport, GivesStraightnessInMicrometresAndSquarenessInMicrometresPerMetre) {
  const std::string line = line_with(short_text(sample_result()), "│ Result");
  EXPECT_THAT(line, HasSubstr("E_ZX 0.300 ± 0.020 µm"));
  EXPECT_THAT(line, HasSubstr("squareness 2.8000 ± 0.0022 µm/m"));
}

TEST(TextReport, NamesTheDeclaredModelsValueBesideTheFinalOneWhereTheyDiffer) {
  Result result = sample_result();
  EXPECT_THAT(line_with(short_text(result), "value ± U"), Not(HasSubstr("declared model")));
  result.declared->parameters[0] = fitted("squareness.dbeta_xz", "Δβxz", "rad", 3.0e-6, 1e-8);
  const std::string text = short_text(result);
  EXPECT_THAT(line_with(text, "value ± U"), HasSubstr("declared model"));
  EXPECT_THAT(line_with(text, "squareness Δβxz"), HasSubstr("(3.000 ± 0.020)e-06"));
}

TEST(TextReport, CallsAnEffectThatMovesNothingNoAlarm) {
  Result result = sample_result();
  TraceResult trace;
  trace.verdict = TraceVerdict::ambiguous;
  trace.rounds.emplace_back().accepted = "revolution_periodic";
  const double U = *result.final->parameters[0].expanded_uncertainty;
  *result.declared->parameters[0].value += 0.05 * U;
  EXPECT_THAT(
      on_one_line(short_text(result, trace)),
      testing::ContainsRegex("Ambiguous, without harm: .*; a possible effect does not change"));
  *result.declared->parameters[0].value += 0.5 * U;
  EXPECT_THAT(short_text(result, trace), HasSubstr("Ambiguous: the model lacks axial"));
}

TEST(TextReport, SaysWhereThePageIs) {
  EXPECT_THAT(line_with(text_report({sample_result()}, {.page = "out/face.html"}), "│ Page"),
              HasSubstr("out/face.html"));
}

TEST(TextReport, GivesStationHeightsOfASlide) {
  Result result = sample_result();
  result.final->straightness->stations = {
      {0.0, 0.0, 0.0}, {103.1, -24.2112, 6.8}, {206.3, 0.0, 0.0}};
  const std::string text = short_text(result);
  EXPECT_THAT(line_with(text, "E_ZX, µm"), HasSubstr("-24.2"));
  EXPECT_THAT(line_with(text, "± U, µm"), HasSubstr("6.8"));
}

TEST(TextReport, SaysWhatWasAssumed) {
  EXPECT_THAT(short_text(sample_result()), HasSubstr("Assumed: free = [\"offset\",\"tilt\"]"));
}

TEST(TextReport, HasNoLineOver80Columns) { expect_fits(full(sample_result())); }

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
  expect_fits(full(result));
}

TEST(TextReport, SaysOnceWhatHasTheColumnsOfTheStraightnessOfAFace) {
  Result result = sample_result();
  EXPECT_THAT(short_text(result), Not(HasSubstr("whatever has its columns")));
  result.final->straightness->if_no = {"cup"};
  const std::string sentence =
      "- The straightness holds whatever has its columns: cupped workpiece.";
  for (const std::string& text : {full(result), short_text(result)}) {
    const std::string words = on_one_line(text);
    EXPECT_THAT(words, HasSubstr(sentence));
    EXPECT_EQ(words.find(sentence), words.rfind(sentence));
  }
  EXPECT_THAT(html_report({result}), HasSubstr("holds whatever has its columns: cupped workpiece"));
}

TEST(TextReport, CutsNoNameOfAParameterOrAnEffect) {
  Result result = sample_result();
  result.final->parameters[1].name = "straightness_of_the_second_carriage.b2";
  result.final->parameters[1].value = 1.23456789;
  result.final->parameters[1].expanded_uncertainty = 1e-9;
  result.final->parameters[1].at_bound = true;
  result.declared->parameters[1].name = result.final->parameters[1].name;
  result.final->nuisances[0].name = std::string(60, 'n') + ".offset";
  result.final->contributions[0].effect = "deflection_of_the_boring_bar_under_the_cut";
  TraceResult trace;
  trace.detection_limits = {{"revolution_periodic",
                             "amplitude_um",
                             "um",
                             0.0053,
                             "cycles_per_revolution = 0.00397",
                             {{0.1, 0.0053}, {0.2, 0.012}},
                             1.3e-7}};
  const std::string text = full(result, trace);
  expect_fits(text);
  expect_fits(short_text(result, trace));
  for (const std::string& line : lines_of(text))  // only the name of a profile is cut
    if (line.find("…") != std::string::npos) {
      EXPECT_THAT(line, HasSubstr("the_"));
    }
  EXPECT_THAT(text, HasSubstr("  straightness of the second carriage b_2"));
  EXPECT_THAT(text, HasSubstr("deflection of the boring bar under the cut"));
  EXPECT_THAT(text, HasSubstr("cycles_per_revolution = 0.00397"));
  EXPECT_THAT(text, HasSubstr(result.final->nuisances[0].name));
}

TEST(TextReport, HasAtMost40LinesHoweverLongNamesAre) {
  Result result = sample_result();
  FittedParameter long_one = result.final->parameters[1];
  long_one.name = std::string(60, 'e') + ".b2";
  result.final->parameters.assign(40, long_one);
  EXPECT_LE(lines_of(short_text(result)).size(), 40U);
}

TEST(TextReport, GivesTheCoverageFactorWhereItIsNot2) {
  Result result = sample_result();
  EXPECT_THAT(line_with(full(result), "value ± U"), Not(HasSubstr(" k")));
  result.final->parameters[0].coverage_factor = 2.87;
  result.final->parameters[0].degrees_of_freedom = 4.0;
  EXPECT_THAT(line_with(full(result), "squareness Δβxz"), HasSubstr("2.87"));
}

TEST(TextReport, GivesAValueWithItsUncertaintyAndUnit) {
  const std::string line = line_with(full(sample_result()), "squareness Δβxz");
  EXPECT_THAT(line, HasSubstr("Δβxz"));
  EXPECT_THAT(line, testing::ContainsRegex("\\(2.8000 ± 0.0022\\)e-06 +rad"));
}

TEST(TextReport, CountsEffectiveValuesAsItCountsValues) {
  Result result = sample_result();
  result.final->observations = 1248;
  result.final->effective_observations = 1248.0;
  for (const std::string& text : {full(result), short_text(result)})
    EXPECT_THAT(on_one_line(text), HasSubstr("1248 values (1248 effective)"));
}

TEST(TextReport, NeverShowsANumberForAParameterThatIsNotDetermined) {
  const std::string text = full(sample_result());
  EXPECT_THAT(line_with(text, "vertical straightness c_1"), HasSubstr("not determined"));
  EXPECT_THAT(text, Not(HasSubstr("777")));
}

TEST(TextReport, PutsTheUndeterminedDirectionInWordsWithItsAdvice) {
  const std::string text = on_one_line(full(sample_result()));
  EXPECT_THAT(text, HasSubstr("0.71 c1 - 0.71 squareness.tilt"));
  EXPECT_THAT(text, HasSubstr("Measure a reference straightedge along Z"));
  EXPECT_THAT(text, HasSubstr("c1 + squareness.tilt = (2.500 ± 0.020)e-06 rad"));
}

TEST(TextReport, AlignsColumnsByCharactersNotBytes) {
  const std::string text = full(sample_result());
  const std::size_t column = column_of(line_with(text, "value ± U"), "value ± U");
  EXPECT_EQ(column_of(line_with(text, "Δβxz"), "(2.8000"), column);
  EXPECT_EQ(column_of(line_with(text, "straightness b_2"), "(-2.290"), column);
  EXPECT_EQ(column_of(line_with(text, "vertical straightness c_1"), "not determined"), column);
}

TEST(TextReport, ListsTheStrongestCorrelationsOfTheCandidatesAndTheRankingsNotes) {
  const std::string text = on_one_line(full(sample_result()));
  EXPECT_THAT(text, HasSubstr("- constant profiles were passed over"));
  const auto strongest = text.find("squareness vertical straightness feed2 +0.9700");
  const auto weaker = text.find("squareness straightness feed2 -0.2000");
  ASSERT_NE(strongest, std::string::npos);
  ASSERT_NE(weaker, std::string::npos);
  EXPECT_LT(strongest, weaker);
}

TEST(TextReport, ShowsALagOnlyWhereItsCoefficientIsClearlyLarger) {
  Result result = sample_result();
  EXPECT_THAT(full(result), Not(HasSubstr("shifted")));
  result.ranking.entries[1].low_band = -0.6;
  EXPECT_THAT(on_one_line(full(result)),
              testing::ContainsRegex("larger when shifted: vertical straightness on [^ ]* -0.9800 "
                                     "by -1.5 mm[.]"));
}

TEST(TextReport, NamesNoDominantEffectWhereThereIsADoubt) {
  Result result = sample_result();
  EXPECT_THAT(full(result), HasSubstr("by fit squareness, the two agree."));
  result.dominant.agree = false;
  result.dominant.doubt = "no clear lead, by fit cup 51 % against step 49 %";
  EXPECT_THAT(full(result),
              HasSubstr("Dominant effect: no clear lead, by fit cup 51 % against step 49 %.\n"));
}

TEST(TextReport, GivesChiSquareOnlyWhereUncertaintiesAreDeclared) {
  Result result = sample_result();
  EXPECT_THAT(full(result), Not(HasSubstr("chi-square")));
  result.final->noise.front().scaling = NoiseScaling::declared;
  EXPECT_THAT(on_one_line(full(result)), HasSubstr("chi-square 131 at 133 degrees of freedom"));
}

TEST(TextReport, HasNoCrossCheckWhereThereIsNothingToCheck) {
  Result result = sample_result();
  result.crosscheck.squareness = SquarenessCheck{};
  result.crosscheck.squareness->reason = "the model declares no squareness";
  EXPECT_THAT(full(result), Not(HasSubstr("Squareness by the fit")));
  EXPECT_THAT(line_with(full(result), "│ Check"),
              HasSubstr("none: the model declares no squareness"));
}

TEST(TextReport, StatesTheCrossCheckWithEnAndTheAmplitudeOverTheTravel) {
  const std::string text = on_one_line(full(sample_result()));
  EXPECT_THAT(text, HasSubstr("E_n = 0.25: consistent"));
  EXPECT_THAT(text, HasSubstr("Over the travel of 600 mm that is 1.68 µm by the fit and 1.65 µm"));
}

TEST(TextReport, ShoutsAnInconsistentCrossCheckWithItsReason) {
  Result result = sample_result();
  result.crosscheck.squareness->verdict = Consistency::inconsistent;
  result.crosscheck.squareness->En = 70.0;
  result.crosscheck.squareness->reason = "the fit asks for more than the run-out allows";
  const std::string text = on_one_line(full(result));
  EXPECT_THAT(text, HasSubstr("E_n = 70: INCONSISTENT"));
  EXPECT_THAT(text, HasSubstr("(E_n is above 1); the fit asks for more than the run-out allows."));
  EXPECT_THAT(text, Not(HasSubstr("Over the travel")));  // the library's reason has it
}

TEST(TextReport, SaysHowUncertaintiesWereScaledPerProfile) {
  const std::string text = full(sample_result());
  EXPECT_THAT(text, HasSubstr("How the uncertainties were scaled"));
  EXPECT_THAT(on_one_line(text), HasSubstr("feed2: the declared uncertainty is too small"));
}

TEST(TextReport, ShowsHeldOutResidualsApart) {
  EXPECT_THAT(line_with(full(sample_result()), "held out"), HasSubstr("1.5 µrad"));
}

TEST(TextReport, LeavesOutWhatWasNotAskedFor) {
  Result result = sample_result();
  result.final.reset();
  result.crosscheck.squareness.reset();
  const std::string text = full(result);
  EXPECT_THAT(text, Not(HasSubstr("Fit:")));
  EXPECT_THAT(text, Not(HasSubstr("\nCross-check")));
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
  const std::string text = full(sample_result(), trace);
  expect_fits(text);
  EXPECT_THAT(line_with(text, "axial spindle motion"),
              testing::ContainsRegex("0.011 µm +0.0059 to 0.015$"));
  const std::string shape = "cycles_per_revolution = 0.01894";
  EXPECT_EQ(column_of(line_with(text, shape), shape),
            column_of(line_with(text, "width_mm = 0.135"), "width_mm"));
}

TEST(TextReport, IsTheSameTextEveryTime) {
  EXPECT_EQ(full(sample_result()), full(sample_result()));
}

}  // namespace
}  // namespace slideway::text_report_test
