// Effects nobody shipped and causes somebody measured, looked for by the loop in faces that the
// process made.
#include <algorithm>
#include <cmath>

#include "slideway/effects/channel.hpp"
#include "slideway/effects/formula.hpp"
#include "slideway/trace/confounding.hpp"
#include "trace/faces.hpp"

namespace slideway {
namespace {

using namespace faces;  // NOLINT(google-build-using-namespace)
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::IsEmpty;

constexpr double kSize = 0.4e-3;               // mm: 40 times the noise
constexpr double kStart = 40.0, kRate = 60.0;  // s: when the coolant comes, how fast it tells

/// Coolant that is switched on in every cut.
turning::Hidden coolant() {
  return {"coolant", [](const turning::ToolPoint& tool) {
            return kSize * (1.0 - std::exp(-std::max(tool.t - kStart, 0.0) / kRate));
          }};
}

DeclaredEffect coolant_formula() {
  return {"coolant",
          {.own = formula_effect(
               {.name = "coolant",
                .text = "a * (1 - exp(-max(t - t0, 0) / tau))",
                .parameters = {{"a", "um"}, {"t0", "s", 0.0, 100.0}, {"tau", "s", 5.0, 600.0}}})},
          {}};
}

TEST(OwnEffect, ThatTheLoopIsAskedForIsNamedWithItsParameters) {
  Problem problem = problem_of();
  problem.trace.own = problem.own_effects = {coolant_formula()};
  const Closed result = closed(problem, quarter_faces(coolant(), 3, kBlunt, 11));
  SCOPED_TRACE(story(result));
  EXPECT_THAT(named(result), ElementsAre("coolant"));
  const TraceRound* round = round_of(result, "coolant");
  ASSERT_NE(round, nullptr);
  expect_within_4u(round->parameters, "coolant.a", kSize / kMicrometre);
  expect_within_4u(round->parameters, "coolant.t0", kStart);
  expect_within_4u(round->parameters, "coolant.tau", kRate);
}

TEST(OwnEffect, IsNotNamedInAFaceThatDoesNotHaveIt) {
  Problem problem = problem_of();
  problem.trace.own = problem.own_effects = {coolant_formula()};
  const Closed result = closed(problem, quarter_faces({}, 3, kBlunt, 12));
  EXPECT_THAT(named(result), IsEmpty());
  EXPECT_THAT(result.detection_limits, Contains(Field(&DetectionLimit::effect, "coolant")));
}

/// What a sensor logged of a spindle that warms with two time constants, coolant from 250 s on.
double temperature(double t) {
  return 20.0 + 2.0 * (1.0 - std::exp(-t / 45.0)) + 3.0 * (1.0 - std::exp(-t / 400.0)) -
         (t > 250.0 ? 1.5 * (1.0 - std::exp(-(t - 250.0) / 30.0)) : 0.0);
}

std::vector<Profile> warm_faces(std::uint64_t seed) {
  return quarter_faces(
      {"warm",
       [](const turning::ToolPoint& tool) { return 0.2e-3 * (temperature(tool.t) - 20.0); }},
      3, kBlunt, seed);
}

DeclaredEffect logged() {
  Channel log{.name = "spindle_temperature", .unit = "degC"};
  RandomStream random(5, "sensor");
  for (int i = 0; i <= 400; ++i) {
    log.at.push_back(i);
    log.values.push_back(temperature(i) + 0.01 * random.normal());
  }
  return {log.name, {.own = channel_effect(log, {.name = log.name, .free_tau = true})}, {}};
}

TEST(OwnEffect, ThatWasMeasuredIsNamedWhereNoLawFits) {
  Problem problem = problem_of();
  const Closed without = closed(problem, warm_faces(21));
  EXPECT_NE(without.verdict, TraceVerdict::nothing_missing) << story(without);
  EXPECT_NE(without.verdict, TraceVerdict::explained) << story(without);
  problem.trace.own = problem.own_effects = {logged()};
  const Closed result = closed(problem, warm_faces(21));
  SCOPED_TRACE(story(result));
  EXPECT_THAT(named(result), ElementsAre("spindle_temperature"));
  const TraceRound* round = round_of(result, "spindle_temperature");
  ASSERT_NE(round, nullptr);
  expect_within_4u(round->parameters, "spindle_temperature.a", 0.2);
}

/// What a log of heat, read every 2 s, makes 0.25 µm a degree of, so much later.
struct LateCause {
  double lag_s;
  void expect_found() const {
    const auto power = [](double t) { return std::exp(-std::pow((t - 60.0) / 18.0, 2)); };
    Channel log{.name = "heat", .unit = "degC"};
    for (int i = 0; i <= 200; ++i) {
      log.at.push_back(2.0 * i - 20.0);
      log.values.push_back(2.0 * power(log.at.back()));
    }
    Problem problem = problem_of();
    problem.trace.own = problem.own_effects = {
        {log.name,
         {.own = channel_effect(log, {.name = log.name, .free_lag = true, .free_tau = true})},
         {}}};
    const turning::Hidden heat{
        "heat", [&](const turning::ToolPoint& tool) { return 0.5e-3 * power(tool.t - lag_s); }};
    const Closed result = closed(problem, quarter_faces(heat, 3, kBlunt, 61));
    SCOPED_TRACE(story(result));
    EXPECT_THAT(named(result), ElementsAre("heat"));
    const TraceRound* round = round_of(result, "heat");
    ASSERT_NE(round, nullptr);
    EXPECT_THAT(round->ambiguous_with, IsEmpty());
    expect_within_4u(round->parameters, "heat.a", 0.25);
    expect_within_4u(round->parameters, "heat.lag_s", lag_s);
  }
};

// At once is no end of what is searched: the law is the log itself.
TEST(OwnEffect, ThatWasMeasuredMayActAtOnce) { LateCause{0.0}.expect_found(); }

TEST(OwnEffect, ThatWasMeasuredMayActLater) { LateCause{8.0}.expect_found(); }

// The clock of the log is 12 s ahead.
TEST(OwnEffect, ThatWasMeasuredByAWrongClockIsFoundAheadOfIt) { LateCause{-12.0}.expect_found(); }

/// What the loop asks of every log.
DeclaredEffect followed(const Channel& log) {
  const std::vector<EffectFactory> laws =
      channel_effects(log, {{.name = log.name, .free_lag = true, .free_tau = true},
                            {.name = log.name, .free_tau = true},
                            {.name = log.name, .free_lag = true},
                            {.name = log.name}});
  return {log.name, {.own = laws[0], .simpler = {laws.begin() + 1, laws.end()}}, {}};
}

// The face follows at once. A log of 0.03 degC, smoothed, leaves a lag and a time constant
// nothing to explain; with both free they made up for its noise.
TEST(OwnEffect, OfANoisyLogHasNoLagThatTheDataDoNotAskFor) {
  for (const std::uint64_t seed : {21, 22, 23}) {
    Channel log{.name = "spindle_temperature", .unit = "degC"};
    RandomStream random(seed, "sensor");
    for (int i = 0; i <= 200; ++i) {
      log.at.push_back(2.0 * i);
      log.values.push_back(temperature(2.0 * i) + 0.03 * random.normal());
    }
    Problem problem = problem_of();
    problem.trace.own = problem.own_effects = {followed(log)};
    const Closed result = closed(problem, warm_faces(seed));
    SCOPED_TRACE(story(result));
    EXPECT_THAT(named(result), ElementsAre("spindle_temperature"));
    const TraceRound* round = round_of(result, "spindle_temperature");
    ASSERT_NE(round, nullptr);
    ASSERT_EQ(round->parameters.size(), 1U);
    expect_within_4u(round->parameters, "spindle_temperature.a", 0.2);
  }
}

/// When the tool was where a value of a face was read, s. The tool has no nose.
double time_of_cut(const Profile& face, std::size_t value) {
  const Setup& setup = face.setup;
  const double radius = std::abs(face.positions[value] - setup.center_mm);
  const double way =
      setup.cut_direction == CutDirection::inward ? *setup.cut_radius_mm - radius : radius;
  return setup.start_s + 60.0 * way / *setup.feed_mm_per_min;
}

// A valve that opens and closes at moments which its log, read every 5 s, does not show. The
// straight lines of such a log are wrong by several times the noise of the face.
TEST(OwnEffect, OfALogThatJumpsIsNoStepAndHasNoLag) {
  constexpr std::uint64_t seed = 31;
  RandomStream random(seed, "valve");
  std::vector<double> jumps;
  for (double t = 7.0; t < 700.0; t += 25.0 + 40.0 * random.uniform()) jumps.push_back(t);
  const auto pressure = [jumps](double t) {
    return std::ranges::count_if(jumps, [t](double jump) { return jump < t; }) % 2 == 0 ? 6.0 : 5.6;
  };
  Channel log{.name = "air_pressure", .unit = "bar"};
  for (double t = -50.0; t <= 700.0; t += 5.0) {
    log.at.push_back(t);
    log.values.push_back(pressure(t) + 0.01 * random.normal());
  }
  Problem problem = problem_of();
  problem.trace.own = problem.own_effects = {followed(log)};
  std::vector<Profile> faces = quarter_faces({}, 3, kBlunt, seed);
  for (Profile& face : faces)
    for (std::size_t i = 0; i < face.values.size(); ++i)
      face.values[i] += 0.1e-3 * pressure(time_of_cut(face, i));
  const Closed result = closed(problem, std::move(faces));
  SCOPED_TRACE(story(result));
  EXPECT_THAT(named(result), ElementsAre("air_pressure"));
  const TraceRound* round = round_of(result, "air_pressure");
  ASSERT_NE(round, nullptr);
  expect_within_4u(round->parameters, "air_pressure.a", 0.1);
  for (const FittedParameter& each : round->parameters)
    if (each.name == "air_pressure.lag_s") expect_within_4u(round->parameters, each.name, 0.0);
}

/// Two logs, each of one cause: alone, the first predicts left-out cuts worse than nothing does
/// where the second is large, and the second, late and turned over, stands for both where the
/// first is small.
TEST(OwnEffect, OfTwoThatWereMeasuredBothAreNamed) {
  const auto pressure = [](double t) { return std::sin(2.0 * 3.141592653589793 * t / 57.0); };
  for (const auto& sizes : {std::pair{0.2, 0.15}, std::pair{0.03, 0.15}}) {
    const double per_degree = sizes.first, per_bar = sizes.second;
    Channel heat{.name = "spindle_temperature", .unit = "degC"},
        air{.name = "air_pressure", .unit = "bar"};
    RandomStream random(5, "sensors");
    for (int i = -50; i <= 250; ++i) {
      const double t = 2.0 * i;
      heat.at.push_back(t);
      heat.values.push_back((t > 0.0 ? temperature(t) : 20.0) + 0.01 * random.normal());
      air.at.push_back(t);
      air.values.push_back(pressure(t) + 0.001 * random.normal());
    }
    Problem problem = problem_of();
    problem.trace.own = problem.own_effects = {followed(heat), followed(air)};
    const turning::Hidden both{
        "both", [&](const turning::ToolPoint& tool) {
          return 1e-3 * (per_degree * (temperature(tool.t) - 20.0) + per_bar * pressure(tool.t));
        }};
    const Closed result = closed(problem, quarter_faces(both, 3, kBlunt, 71));
    SCOPED_TRACE(story(result));
    EXPECT_THAT(named(result), ::testing::UnorderedElementsAre(heat.name, air.name));
    const TraceRound *first = round_of(result, heat.name), *second = round_of(result, air.name);
    ASSERT_TRUE(first && second);
    expect_within_4u(first->parameters, heat.name + ".a", per_degree);
    expect_within_4u(second->parameters, air.name + ".a", per_bar);
  }
}

/// A log that rises evenly: a linear drift fits as well, and nobody measured that.
TEST(OwnEffect, ThatWasMeasuredOutranksADriftThatFitsAsWell) {
  Channel log{.name = "room_temperature", .unit = "degC"};
  for (int i = 0; i <= 400; ++i) {
    log.at.push_back(i);
    log.values.push_back(20.0 + 0.002 * i);
  }
  const turning::Hidden drift{
      "drift", [](const turning::ToolPoint& tool) { return 0.5e-3 * 0.002 * tool.t; }};
  Problem problem = problem_of();
  problem.trace.own =
      problem.own_effects = {{log.name, {.own = channel_effect(log, {.name = log.name})}, {}}};
  const Closed result = closed(problem, quarter_faces(drift, 3, kBlunt, 31));
  SCOPED_TRACE(story(result));
  EXPECT_THAT(named(result), ElementsAre("room_temperature"));
  const TraceRound* round = round_of(result, "room_temperature");
  ASSERT_NE(round, nullptr);
  EXPECT_THAT(round->ambiguous_with, IsEmpty());
  EXPECT_THAT(result.notes, Contains(::testing::HasSubstr("linear_drift")));
}

// One cut: a drift and a cone are one column; two feeds tell them apart.
TEST(OwnEffect, IsHeldAgainstTheCatalogueByItsColumns) {
  Problem problem = problem_of();
  problem.own_effects = {
      {"rise",
       {.own = formula_effect({.name = "rise", .text = "a * t", .parameters = {{"a", "um/s"}}})},
       {}}};
  const auto of = [](const Confounding& confounding, const std::string& effect) {
    for (const Lookalike& each : confounding.lookalikes)
      if (each.effect == effect) return each;
    return Lookalike{};
  };
  const std::vector<Profile> faces = quarter_faces({}, 3, kBlunt, 41);
  const Confounding one = confounding_of(problem, {faces[0]}).front();
  EXPECT_NEAR(of(one, "linear_drift").share, 1.0, 1e-6);
  EXPECT_NEAR(of(one, "squareness").share, 1.0, 1e-6);
  const Confounding all = confounding_of(problem, faces).front();
  EXPECT_NEAR(of(all, "linear_drift").share, 1.0, 1e-6);
  EXPECT_LT(of(all, "squareness").share, 0.5);
  EXPECT_NEAR(of(all, "squareness").largest_alone, 1.0, 1e-6);
}

}  // namespace
}  // namespace slideway
