// The loop ends on noise of every kind, and what it accepts passes every gate in the end.
#include <gtest/gtest.h>

#include <cmath>

#include "identify/cases.hpp"
#include "slideway/base/random.hpp"
#include "slideway/trace/analysis.hpp"

namespace slideway::rounds_test {
namespace {

constexpr std::size_t kValues = 300;
constexpr double kSize = 1e-4;  // mm

enum class NoiseKind { white, correlated, random_walk, flicker, steps };

/// A series of one kind of noise. Flicker (1/f) noise: first-order processes with correlation
/// lengths a factor of three apart, of equal variance.
std::vector<double> noise(NoiseKind kind, std::uint64_t seed) {
  RandomStream random(seed, "rounds");
  std::vector<double> out(kValues, 0.0);
  const auto add = [&](double rho, double size) {
    double state = random.normal();
    for (double& value : out) {
      state = rho * state + std::sqrt(1.0 - rho * rho) * random.normal();
      value += size * state;
    }
  };
  switch (kind) {
    case NoiseKind::white:
      add(0.0, kSize);
      break;
    case NoiseKind::correlated:
      add(0.9, kSize);
      break;
    case NoiseKind::random_walk:
      for (double sum = 0.0; double& value : out) value = sum += kSize * random.normal();
      break;
    case NoiseKind::flicker:
      for (double length = 1.0; length < kValues; length *= 3.0)
        add(std::exp(-1.0 / length), kSize);
      break;
    case NoiseKind::steps:
      add(0.0, kSize);
      for (double& value : out) value = kSize * std::round(value / kSize);
      break;
  }
  return out;
}

class Rounds : public ::testing::TestWithParam<NoiseKind> {};

TEST_P(Rounds, EndAndLeaveOnlyWhatPassesItsGates) {
  Problem problem = cases::problem(Lever::paper, 0,
                                   {cases::effect("squareness"), cases::effect("straightness", 3)});
  std::vector<Profile> profiles;
  for (std::uint64_t cut = 0; cut < 3; ++cut)
    profiles.push_back(cases::face("cut" + std::to_string(cut),
                                   2.0 + 3.0 * static_cast<double>(cut),
                                   cases::spaced(-50.0, 50.0, kValues), noise(GetParam(), cut)));
  problem.trace.candidates = {"linear_drift", "thermal_drift", "step",          "slide_periodic",
                              "cup",          "tool_wear",     "edge_roll_off", "time_periodic"};
  const Analysis analysis = analyse(problem, profiles);
  const TraceResult& trace = *analysis.trace;
  // A round adds a name or rules one out (2 c at most); subsets of three effects are looked at once
  // more, and the gates moved four times.
  EXPECT_LE(trace.searches, 5 * (2 * problem.trace.candidates.size() + 8));
  const Gates& gates = problem.trace.gates;
  for (const TraceRound& round : trace.rounds) {
    EXPECT_LE(round.delta_bic, -gates.delta_bic) << round.accepted;
    EXPECT_LE(round.p_value, gates.significance) << round.accepted;
  }
  if (!trace.rounds.empty()) {
    EXPECT_LT(*analysis.result.final->rms_um, *analysis.result.declared->rms_um);
  }
}

INSTANTIATE_TEST_SUITE_P(Noise, Rounds,
                         ::testing::Values(NoiseKind::white, NoiseKind::correlated,
                                           NoiseKind::random_walk, NoiseKind::flicker,
                                           NoiseKind::steps));

}  // namespace
}  // namespace slideway::rounds_test
