// A line faster than the low band can show is folded by it to a slow one.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fast_lines.hpp"
#include "slideway/base/random.hpp"
#include "slideway/base/units.hpp"
#include "trace/faces.hpp"

namespace slideway {
namespace {

using namespace faces;  // NOLINT(google-build-using-namespace)

constexpr double kSpacing = 0.25;  // mm
constexpr double kTurn = 2.0 * std::numbers::pi;

/// Three readings of bowed slides with noise of 20 nm and a line of 0.15 µm, a third of a turn
/// apart: no two of them have it in common.
std::vector<Profile> with_line(double period_mm, std::uint64_t seed) {
  std::vector<Profile> out;
  for (const char* name : {"run1", "run2", "run3"}) {
    RandomStream random(seed, name);
    Profile& profile = out.emplace_back();
    profile.name = name;
    profile.surface = name;
    profile.setup.kind = Kind::slide;
    const double phase = kTurn / 3.0 * static_cast<double>(out.size());
    for (int i = 0; i < 1200; ++i) {
      const double x = 5.0 + kSpacing * i, u = (x - 155.0) / 150.0;
      profile.positions.push_back(x);
      profile.values.push_back(kMicrometre * (0.5 * u * u - 0.2 * u * u * u +
                                              0.15 * std::cos(kTurn * x / period_mm + phase) +
                                              0.02 * random.normal()));
    }
    profile.setup.first_mm = profile.positions.front();
    profile.setup.last_mm = profile.positions.back();
  }
  return out;
}

// The line is there in each sample, at 0.23 to 0.28 cycles a sample. db1 of level 3 keeps one value
// of eight and lets a hundredth of it through, at another rate. Where that stands out, it is named
// at its own.
TEST(FoldedLine, IsNoEffectOfAnotherRate) {
  Problem problem = problem_of({"slide_periodic", "step", "local_form"});
  problem.effects = {{"straightness", {std::nullopt, 3, std::nullopt}, {}}};
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const double period_mm = kSpacing / (0.23 + 0.01 * static_cast<double>(seed - 1));
    const Closed result = closed(problem, with_line(period_mm, seed));
    SCOPED_TRACE(story(result));
    for (const TraceRound& round : result.rounds) {
      ASSERT_EQ(round.accepted, "slide_periodic");
      // Half a cycle over the trace of 300 mm is the resolution of its spectrum.
      const FittedParameter* const period =
          find(round.parameters, term_name(round.accepted, round.profiles) + ".period_mm");
      ASSERT_TRUE(period);
      EXPECT_NEAR(300.0 / *period->value, 300.0 / period_mm, 0.5);
    }
  }
}

/// Three cuts with a vibration of the tool of 10 nm, 2.7 grooves a cycle at 2 mm/min.
std::vector<Profile> vibrating(double period_s, std::uint64_t seed) {
  turning::Hidden line;
  line.name = "line";
  line.tool = [=](const turning::ToolPoint& tool) {
    return 1e-5 * std::cos(kTurn * tool.t / period_s + 0.5);
  };
  return quarter_faces(line, 3, kSharp, seed);
}

// A low-band value lasts 0.96 s at 2 mm/min and 0.24 s at 8. The tool moves once a turn: what is
// periodic in time is so in turns.
TEST(FastLine, IsNamedAtTheRateThatTheSamplesHave) {
  for (const double period_s : {1.43, 1.61}) {
    const Closed result =
        closed(problem_of({"time_periodic", "revolution_periodic", "slide_periodic",
                           "traverse_periodic", "thermal_drift", "step"}),
               vibrating(period_s, 3));
    SCOPED_TRACE(story(result));
    ASSERT_THAT(named(result),
                ::testing::ElementsAre(::testing::AnyOf("time_periodic", "revolution_periodic")));
    const TraceRound* round = round_of(result, named(result).front());
    EXPECT_THAT(round->ambiguous_with, ::testing::SizeIs(1));
    const std::vector<FittedParameter>& parameters = round->parameters;
    if (const auto* period = find(parameters, "time_periodic.period_s"))
      EXPECT_NEAR(*period->value, period_s, 0.001);  // half a cycle of 600 is 0.0012 s
    else
      EXPECT_NEAR(*find(parameters, "revolution_periodic.cycles_per_revolution")->value,
                  60.0 / 110.0 / period_s, 0.0003);
  }
}

// Of 120 traces of noise, half of it with a memory of two samples, a hundredth shows a line by
// chance (Gates::significance); more than five do with a probability of 2e-3.
TEST(FastLine, IsSeldomSeenInNoise) {
  Problem problem = problem_of({"slide_periodic"});
  problem.effects = {{"straightness", {std::nullopt, 3, std::nullopt}, {}}};
  std::size_t lines = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    std::vector<Profile> profiles = with_line(1.0, seed);
    for (Profile& profile : profiles) {
      RandomStream random(100 + seed, profile.name);
      double before = 0.0;
      for (double& value : profile.values) {
        before = (seed % 2 == 0 ? 0.6 * before : 0.0) + 0.02 * kMicrometre * random.normal();
        value = before;
      }
    }
    const FittedModel fitted = fit_declared(problem, profiles);
    lines += fast_lines(fitted.model, fitted.fit).size();
  }
  EXPECT_LE(lines, 5U);
}

TEST(FastLine, IsNotSeenInAFewSamples) {
  Problem problem = problem_of({"slide_periodic"});
  problem.effects = {{"straightness", {std::nullopt, 2, std::nullopt}, {}}};
  problem.low_band.level = 1;
  for (const std::size_t count : {8U, 9U, 12U, 16U, 24U}) {
    std::vector<Profile> profiles = with_line(0.7, 1);
    for (Profile& profile : profiles) {
      profile.positions.resize(count);
      profile.values.resize(count);
      profile.setup.last_mm = profile.positions.back();
    }
    const FittedModel fitted = fit_declared(problem, profiles);
    EXPECT_THAT(fast_lines(fitted.model, fitted.fit), ::testing::IsEmpty()) << count;
  }
}

/// Distance of a rate in cycles a sample from the nearest whole one.
double folded(double cycles) { return std::abs(cycles - std::round(cycles)); }

// Sixteen harmonics of the feed marks, folded, lie near any line of a cut. But marks of another
// feed are of another depth: a wave that is one in time in cuts of different feeds is none of them.
TEST(FoldedLine, OneWaveOfCutsOfDifferentFeedsIsAnEffect) {
  constexpr int kSamples = 700;
  constexpr double kApart = 40.0 / kSamples, kSpeed = 389.9;
  const std::vector<std::pair<double, CutDirection>> cuts{
      {2.0, CutDirection::inward}, {5.0, CutDirection::inward}, {3.0, CutDirection::outward}};
  const auto lies_on_marks = [&](double period_s, double feed) {
    for (int m = 1; m <= 16; ++m)
      if (std::abs(kApart * 60.0 / (feed * period_s) - folded(m * kApart * kSpeed / feed)) *
              kSamples <
          1.0)
        return true;
    return false;
  };
  double period_s = 20.0;
  while (!std::ranges::all_of(cuts,
                              [&](const auto& cut) { return lies_on_marks(period_s, cut.first); }))
    period_s += 0.05;
  ASSERT_LT(period_s, 300.0);
  std::vector<Profile> profiles;
  for (const auto& [feed, direction] : cuts) {
    Profile& profile = profiles.emplace_back();
    profile.name = "cut" + std::to_string(profiles.size());
    RandomStream random(11, profile.name);
    for (int i = 0; i < kSamples; ++i) {
      const double r = kApart * (i + 1);
      const double t = (direction == CutDirection::inward ? 40.0 - r : r) / feed * 60.0;
      profile.positions.push_back(r);
      profile.values.push_back(
          kMicrometre * (0.02 * r + 0.1 * std::cos(kTurn * t / period_s) + 0.01 * random.normal()));
    }
    slideway::Setup& setup = profile.setup;
    setup.kind = Kind::face;
    setup.feed_mm_per_min = feed;
    setup.spindle_rpm = kSpeed;
    setup.cut_direction = direction;
    setup.cut_radius_mm = 40.0;
    setup.first_mm = profile.positions.front();
    setup.last_mm = profile.positions.back();
  }
  const Closed result = closed(problem_of({"time_periodic", "slide_periodic", "step"}), profiles);
  SCOPED_TRACE(story(result));
  ASSERT_THAT(named(result), ::testing::ElementsAre("time_periodic"));
  expect_within_4u(result.rounds.front().parameters, "time_periodic.period_s", period_s);
}

// One cycle a turn and a little more turns its sign from one half of a diameter to the other. Read
// there, it is the alias 2 - ν.
TEST(FoldedLine, OfOneCycleATurnIsTheSpindlesOnADiameter) {
  constexpr double kCyclesPerTurn = 1.01, kLineSize = 1e-4;
  turning::Hidden line;
  line.name = "line";
  line.tool = [](const turning::ToolPoint& tool) {
    return kLineSize * std::cos(kTurn * kCyclesPerTurn * tool.k + 0.5);
  };
  const Closed result = closed(problem_of({"revolution_periodic", "slide_periodic", "time_periodic",
                                           "centre_step", "traverse_periodic", "traverse_datum"}),
                               quarter_faces(line, 3, kBlunt, 5));
  SCOPED_TRACE(story(result));
  ASSERT_THAT(named(result), ::testing::ElementsAre("revolution_periodic"));
  const TraceRound* round = round_of(result, "revolution_periodic");
  EXPECT_THAT(round->ambiguous_with, ::testing::IsEmpty());
  expect_within_4u(round->parameters, "revolution_periodic.cycles_per_revolution",
                   2.0 - kCyclesPerTurn);
}

}  // namespace
}  // namespace slideway
