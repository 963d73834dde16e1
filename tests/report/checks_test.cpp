// What the cross-checks show, and under which condition a value holds.

#include <gmock/gmock.h>

#include "report/sample_result.hpp"
#include "slideway/report/report.hpp"

namespace slideway::checks_test {
namespace {

using testing::HasSubstr;
using testing::Not;

Result with_squareness_by(double fit, double fit_U, double indirect, double indirect_U) {
  Result result = sample_result();
  SquarenessCheck& check = *result.crosscheck.squareness;
  check.fit_rad = fit;
  check.fit_U_rad = fit_U;
  check.indirect_rad = indirect;
  check.indirect_U_rad = indirect_U;
  check.verdict = Consistency::consistent;
  return result;
}

/// With each paragraph in a line, and without the edge of the box.
std::string words_of(const Analysis& analysis) {
  std::string out;
  for (std::string line : lines_of(text_report(analysis, {.full = true, .page = ""}))) {
    if (line.starts_with("│")) line.erase(0, std::string("│").size());
    out += " " + line.substr(std::min(line.size(), line.find_first_not_of(' ')));
  }
  return out;
}

std::string words_of(const Result& result) { return words_of(Analysis{result}); }

TEST(Checks, SayWhereUExceedsWhatTheyCompare) {
  // sqrt(3² + 1²) is above 2.8, sqrt(2² + 1²) is not.
  const Result little = with_squareness_by(2.8e-6, 3e-6, 2.8e-6, 1e-6);
  EXPECT_THAT(words_of(little), HasSubstr("does not contradict it"));
  EXPECT_THAT(words_of(little), HasSubstr("though U exceeds both"));
  const Result enough = with_squareness_by(2.8e-6, 2e-6, 2.8e-6, 1e-6);
  EXPECT_THAT(words_of(enough), HasSubstr("the run-out agrees in amount"));
  EXPECT_THAT(words_of(enough), Not(HasSubstr("exceeds")));
}

TEST(Checks, OfProfilesSayIt) {
  const auto with_U = [](double U) {
    Result result = sample_result();
    result.crosscheck.squareness->En.reset();
    result.crosscheck.profiles = {{.profiles = {"a", "b"},
                                   .what = "straightness",
                                   .En = 0.03,
                                   .verdict = Consistency::consistent,
                                   .value_um = {34.0, 32.0},
                                   .U_um = {18.0, U}}};
    return words_of(result);
  };
  // sqrt(18² + 39²) is above 34, sqrt(18² + 20²) is not.
  EXPECT_THAT(with_U(39.0), HasSubstr("though U exceeds what is compared"));
  EXPECT_THAT(with_U(20.0), Not(HasSubstr("exceeds what is compared")));
}

TEST(Checks, WhatRepeatsShareAndNoReadingIsOffIsATexture) {
  TraceResult trace;
  trace.verdict = TraceVerdict::nothing_missing;
  const auto text_of_repeats = [&](double common, double apart, RepeatFit verdict) {
    Result result = sample_result();
    result.final->identifiability.unidentifiable.clear();
    result.crosscheck.repeats = {
        {.profiles = {"a", "b"}, .common_um = common, .apart_um = apart, .verdict = verdict}};
    return words_of({result, trace});
  };
  const std::string texture = text_of_repeats(0.109, 0.005, RepeatFit::fits);
  EXPECT_THAT(texture, HasSubstr("a texture of the surface"));
  EXPECT_THAT(texture, HasSubstr("down to a texture that repeats"));
  const std::string noise = text_of_repeats(0.1, 0.1, RepeatFit::fits);
  EXPECT_THAT(noise, HasSubstr("is no more than noise"));
  EXPECT_THAT(noise, Not(HasSubstr("texture")));
  EXPECT_THAT(text_of_repeats(0.109, 0.005, RepeatFit::lack_of_fit), HasSubstr("LACK OF FIT"));
}

TEST(Condition, IsBesideEachValueWhereverThatIsPrinted) {
  Result result = sample_result();
  for (FittedParameter& parameter : result.final->parameters)
    if (parameter.name == "squareness.dbeta_xz") parameter.if_no = {"linear_drift"};
  result.conformity = {{.what = "squareness",
                        .value_um_per_m = 2.8,
                        .U_um_per_m = 0.1,
                        .limit_um_per_m = 5.0,
                        .verdict = ConformityVerdict::conforms,
                        .if_no = {"linear_drift"}}};
  const Analysis analysis{result, TraceResult{}};
  EXPECT_THAT(words_of(result), HasSubstr("if no steady drift"));
  EXPECT_THAT(words_of(analysis), HasSubstr("conforms, if no steady drift"));
  EXPECT_THAT(html_report(analysis), HasSubstr("conforms</b>, if no steady drift"));
}

TEST(Condition, OfAStraightnessNamesItsPartsThatHaveANameOfTheirOwn) {
  Result result = sample_result();
  EXPECT_THAT(words_of(result), Not(HasSubstr("without local form")));
  result.final->effects.insert(result.final->effects.end(),
                               {"local_form[cut1]", "local_form[cut2]", "thermal_drift", "mine"});
  result.conformity = {{.what = "straightness",
                        .value_um = 0.3,
                        .U_um = 0.1,
                        .limit_um = 1.0,
                        .verdict = ConformityVerdict::conforms},
                       {.what = kFlatness, .limit_um = 1.0}};
  const std::string words = words_of(result);
  EXPECT_THAT(words, HasSubstr("(end points), without local form;"));
  EXPECT_THAT(words, HasSubstr("straightness conforms, without local form;"));
  EXPECT_THAT(words, Not(HasSubstr("flatness cannot be decided, without")));
  EXPECT_THAT(html_report({result}), HasSubstr("without local form"));
  result.final->straightness->parts = {"local_form[cut1]", "local_form[cut2]"};
  EXPECT_THAT(words_of(result), Not(HasSubstr("without local form")));
}

}  // namespace
}  // namespace slideway::checks_test
