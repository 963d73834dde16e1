// Legal problems by the hundred, drawn at random: always an answer or one line, finite numbers, U
// above 0, and the same answer however the same problem is written down.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "answer.hpp"
#include "slideway/base/random.hpp"
#include "slideway/base/text.hpp"
#include "slideway/effects/catalogue.hpp"

namespace slideway::torture_test {
namespace {

constexpr double kOfUncertainty = 0.02;  // a change of a value that nobody can see, in U
constexpr double kOfSize = 1e-6;         // and one of a value whose U is smaller than its digits

std::size_t asked_for(const char* variable, std::size_t usual) {
  const char* const asked = std::getenv(variable);
  return asked == nullptr ? usual : std::strtoul(asked, nullptr, 10);
}

/// How many problems each test draws, and the number of the first.
std::size_t problem_count(std::size_t usual) { return asked_for("SLIDEWAY_TORTURE", usual); }
std::size_t first_problem() { return asked_for("SLIDEWAY_TORTURE_FIRST", 0); }

DrawnProblem drawn(std::size_t number, Intent intent = Intent::legal) {
  constexpr std::size_t kBytes = 700;
  RandomStream random(number, "problem");
  std::vector<std::uint8_t> bytes(kBytes);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(256.0 * random.uniform());
  Draw draw(bytes);
  return draw_problem(draw, intent);
}

void expect_sound(const ProblemFiles& files, const AnalysisOptions& options) {
  const Answer answer = answer_to(files, options);
  if (!answer.analysis) return;
  for (const std::string& fault : faults_of(*answer.analysis)) ADD_FAILURE() << fault;
}

/// The profiles that a name lists, "[p2,p1]", in the order of their names.
std::string in_order(const std::string& name) {
  const std::size_t from = name.find('['), to = name.find(']');
  if (to == std::string::npos) return name;
  std::istringstream list(name.substr(from + 1, to - from - 1));
  std::vector<std::string> profiles;
  for (std::string each; std::getline(list, each, ',');) profiles.push_back(each);
  std::ranges::sort(profiles);
  return name.substr(0, from + 1) + joined(profiles, ",") + name.substr(to);
}

const FittedParameter* find(const ModelResult& model, const std::string& name) {
  for (const FittedParameter& each : model.parameters)
    if (in_order(each.name) == in_order(name)) return &each;
  return nullptr;
}

/// Whether both have the same parameters, to a small part of U.
/// @param size  of the second in the first
void expect_alike(const Answer& a, const Answer& b, double size = 1.0) {
  ASSERT_EQ(a.analysis.has_value(), b.analysis.has_value()) << a.refusal << b.refusal;
  if (!a.analysis) return;
  const ModelResult &first = *a.analysis->result.declared, &second = *b.analysis->result.declared;
  for (const FittedParameter& own : first.parameters) {
    const FittedParameter* const other = find(second, own.name);
    ASSERT_NE(other, nullptr) << own.name;
    ASSERT_EQ(own.identifiable, other->identifiable) << own.name;
    if (!own.identifiable) continue;
    const double U = *own.expanded_uncertainty, value = *own.value * size;
    const double close = size * U * kOfUncertainty + kOfSize * std::abs(value);
    EXPECT_NEAR(*other->value, value, close) << own.name;
    EXPECT_NEAR(*other->expanded_uncertainty / (size * U), 1.0, kOfUncertainty) << own.name;
  }
}

/// Problems whose answer is a continuous function of the data: linear, no prior, no least value of
/// a loss or of a spike to decide about.
bool is_linear(const DrawnProblem& problem) {
  for (const char* word : {"priors", "form =", "\"formula\"", "\"channel\""})
    if (problem.tail.find(word) != std::string::npos) return false;
  for (const DrawnProfile& profile : problem.profiles)
    if (profile.keys.find("loss") != std::string::npos ||
        profile.keys.find("spikes") != std::string::npos)
      return false;
  return true;
}

/// "zero_drift" of "zero_drift[p1,p2].rate_per_min".
std::string effect_of(const std::string& parameter) {
  return parameter.substr(0, parameter.find_first_of("[."));
}

/// Whether every profile has values to spare and none is free of noise: the noise of a profile that
/// the model passes through is rounding, which has no proportion to its data.
bool has_noise(const Answer& answer) {
  constexpr double kSpare = 30.0;    // values, whatever the model takes of them
  constexpr double kOfRange = 1e-6;  // noise
  const Result& result = answer.analysis->result;
  const ModelResult& model = *result.declared;
  return std::ranges::all_of(model.noise, [&](const NoiseSummary& noise) {
    const auto input = std::ranges::find(result.inputs, noise.profile, &InputSummary::name);
    const double size =
        noise.standard_deviation_um.value_or(noise.standard_deviation_urad.value_or(0.0));
    const double range = input->pv_um.value_or(input->pv_urad.value_or(0.0));
    const auto band = std::ranges::find(result.low_band, noise.profile, &LowBandSummary::profile);
    return static_cast<double>(band->values) > kSpare && size > kOfRange * range;
  });
}

bool has_linear_effects(const Answer& answer) {
  return std::ranges::all_of(
      answer.analysis->result.declared->parameters,
      [](const FittedParameter& each) { return specimen(effect_of(each.name)).shapes().empty(); });
}

/// Draws problems until `count` of them are linear and have an answer.
template <typename Each>
void for_each_linear_problem(std::size_t count, const Each& each) {
  const AnalysisOptions declared_only{.scope = Scope::fit, .closes_loop = false};
  for (std::size_t number = first_problem(), found = 0; found < count; ++number) {
    const DrawnProblem problem = drawn(number);
    if (!is_linear(problem)) continue;
    const Answer answer = answer_to(ProblemFiles(problem), declared_only);
    if (!answer.analysis || !has_linear_effects(answer) || !has_noise(answer)) continue;
    ++found;
    SCOPED_TRACE("problem " + std::to_string(number));
    each(problem, answer, declared_only);
  }
}

TEST(Drawn, LegalProblemsGetASoundAnswerOrOneLine) {
  for (std::size_t i = 0; i < problem_count(30); ++i) {
    const std::size_t number = first_problem() + i;
    SCOPED_TRACE("problem " + std::to_string(number));
    expect_sound(ProblemFiles(drawn(number)), {.with_details = true, .with_curves = true});
  }
}

TEST(Drawn, HostileProblemsGetASoundAnswerOrOneLine) {
  for (std::size_t i = 0; i < problem_count(30); ++i) {
    const std::size_t number = first_problem() + i;
    SCOPED_TRACE("problem " + std::to_string(number));
    expect_sound(ProblemFiles(drawn(number, Intent::hostile)), {.closes_loop = false});
  }
}

TEST(Drawn, ProfilesInAnotherOrderGiveTheSameAnswer) {
  for_each_linear_problem(
      problem_count(10), [](const auto& problem, const auto& answer, const auto& options) {
        expect_alike(answer, answer_to(ProblemFiles(problem, {.is_reversed = true}), options));
      });
}

TEST(Drawn, DataInOtherUnitsGiveTheSameAnswer) {
  constexpr Wording kMetres{.position_unit = "m",
                            .positions_per_mm = 1e-3,
                            .height_unit = "nm",
                            .slope_unit = "rad",
                            .heights_per_um = 1e3,
                            .slopes_per_urad = 1e-6};
  constexpr Wording kInches{.position_unit = "inch",
                            .positions_per_mm = 1.0 / 25.4,
                            .height_unit = "inch",
                            .slope_unit = "um_per_m",
                            .heights_per_um = 1.0 / 25400.0};
  for_each_linear_problem(
      problem_count(10), [&](const auto& problem, const auto& answer, const auto& options) {
        for (const Wording& wording : {kMetres, kInches})
          expect_alike(answer, answer_to(ProblemFiles(problem, wording), options));
      });
}

TEST(Drawn, DataTenTimesAsLargeGiveTenTimesTheAnswer) {
  for_each_linear_problem(
      problem_count(10), [](const auto& problem, const auto& answer, const auto& options) {
        expect_alike(answer, answer_to(ProblemFiles(problem, {.size = 10.0}), options), 10.0);
      });
}

}  // namespace
}  // namespace slideway::torture_test
