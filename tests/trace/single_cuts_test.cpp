// What one cut has by itself, and what turns round with the direction, has the columns of other
// effects where the cuts are few: no other name stands alone then, and no other cut is blamed.

#include <cmath>
#include <functional>

#include "slideway/base/units.hpp"
#include "trace/faces.hpp"

namespace slideway::single_cuts_test {
namespace {

using namespace faces;  // NOLINT(google-build-using-namespace)
using ::testing::Contains;
using ::testing::IsEmpty;
using turning::ToolPoint;

constexpr double kRadius = 40.0;  // mm
constexpr double kNoise = 2e-5;   // mm, of a sample

struct CutOfSeries {
  double feed = 10.0;  // mm/min
  bool inward = true;
};

/// An error of one of the cuts, by its place in the series.
using ErrorOfCut = std::function<turning::Error(const CutOfSeries&, std::size_t)>;
/// Noise of a reading of so many samples, mm.
using NoiseOfReading = std::function<std::vector<double>(std::size_t, RandomStream&)>;

std::vector<double> white(std::size_t samples, RandomStream& random) {
  std::vector<double> out(samples);
  for (double& each : out) each = kNoise * random.normal();
  return out;
}

/// Diameters of faces of one carriage at 600 rev/min, 1600 samples each.
std::vector<Profile> series(const std::vector<CutOfSeries>& cuts, const ErrorOfCut& error,
                            std::uint64_t seed, const NoiseOfReading& noise = white) {
  constexpr int kSamples = 1600;
  std::vector<Profile> out;
  for (std::size_t c = 0; c < cuts.size(); ++c) {
    turning::Cut cut;
    cut.radius_mm = kRadius;
    cut.feed_mm_per_min = cuts[c].feed;
    cut.spindle_rpm = 600.0;
    cut.inward = cuts[c].inward;
    cut.nose_radius_mm = kBlunt;
    const turning::Carriage carriage{{0.0, 0.0, 2e-8, -4e-10}, {}, 2e-5, 0.0, 0.0};
    const turning::Error slide = [=](const ToolPoint& p) { return one_lever(carriage, p); };
    RandomStream random(seed, "reading" + std::to_string(c));
    turning::Stylus stylus;
    stylus.center_mm = kRadius;
    stylus.tilt = 1e-5 * random.normal();
    Profile& profile = out.emplace_back();
    profile.name = "c" + std::to_string(c + 1);
    for (int i = 0; i < kSamples; ++i)
      profile.positions.push_back(2.0 * kRadius * i / (kSamples - 1));
    profile.values = turning::trace(turning::Face(cut, turning::sum({slide, error(cuts[c], c)})),
                                    profile.positions, stylus, random);
    const std::vector<double> added = noise(profile.values.size(), random);
    for (std::size_t i = 0; i < added.size(); ++i) profile.values[i] += added[i];
    Setup& setup = profile.setup;
    setup.center_mm = kRadius;
    setup.cut_radius_mm = kRadius;
    setup.feed_mm_per_min = cut.feed_mm_per_min;
    setup.spindle_rpm = cut.spindle_rpm;
    setup.cut_direction = cut.inward ? CutDirection::inward : CutDirection::outward;
    setup.first_mm = profile.positions.front();
    setup.last_mm = profile.positions.back();
  }
  return out;
}

turning::Error nothing() {
  return [](const ToolPoint&) { return 0.0; };
}

/// The carriage leans the other way when it travels the other way.
turning::Error reversal(const CutOfSeries& cut) {
  const double pitch = (cut.inward ? -3e-4 : 3e-4) / kRadius;
  return [=](const ToolPoint& p) { return pitch * p.r; };
}

const std::vector<CutOfSeries> kThereAndBack{{10.0, true}, {5.0, false}};
const std::vector<CutOfSeries> kTwiceThereAndBack{
    {10.0, true}, {5.0, false}, {16.0, true}, {10.0, false}};

class SingleCuts : public ::testing::TestWithParam<std::uint64_t> {};

// Two slopes, of which squareness and a drift make two of any size.
TEST_P(SingleCuts, AReversalOfTwoOppositeCutsIsNoDriftAlone) {
  const Closed result =
      closed(problem_of(),
             series(
                 kThereAndBack, [](const auto& cut, auto) { return reversal(cut); }, GetParam()));
  SCOPED_TRACE(story(result));
  EXPECT_NE(result.verdict, TraceVerdict::nothing_missing);
  EXPECT_NE(result.verdict, TraceVerdict::explained);
  for (const TraceRound& round : result.rounds)
    if (round.accepted != "feed_marks") {
      EXPECT_THAT(round.ambiguous_with, Contains("hysteresis")) << round.accepted;
    }
}

TEST_P(SingleCuts, AReversalOfTwoCutsEachWayIsNamed) {
  const Closed result = closed(
      problem_of(),
      series(
          kTwiceThereAndBack, [](const auto& cut, auto) { return reversal(cut); }, GetParam()));
  SCOPED_TRACE(story(result));
  EXPECT_TRUE(result.blunders.empty());
  EXPECT_THAT(named(result), ::testing::ElementsAre("hysteresis"));
  expect_within_4u(result.final.parameters, "hysteresis.tilt_um", 0.3);
  expect_within_4u(result.final.parameters, "squareness.dbeta_xz", 2e-5);
}

// Coolant that is switched on in the first cut alone.
TEST_P(SingleCuts, ATransientOfOneIsNoWrongDirectionOrStartOfAnother) {
  const std::vector<CutOfSeries> cuts{{10.0, true}, {14.0, true}, {10.0, false}};
  const ErrorOfCut coolant = [](const CutOfSeries& cut, std::size_t which) {
    const double duration = 60.0 * kRadius / cut.feed;
    return which > 0 ? nothing() : [=](const ToolPoint& p) {
      const double since = std::max(0.0, p.t / duration - 0.4);
      return 4e-4 * (1.0 - std::exp(-since / 0.1));
    };
  };
  const Closed result = closed(problem_of(), series(cuts, coolant, GetParam()));
  SCOPED_TRACE(story(result));
  EXPECT_NE(result.verdict, TraceVerdict::nothing_missing);
  EXPECT_THAT(result.blunders, IsEmpty());
}

// Each of two cuts would else have a drift of its own, and the squareness would be wrong.
TEST_P(SingleCuts, AWrongDirectionBesideADriftOfAllIsNamedWithItsCut) {
  const ErrorOfCut drift = [](const CutOfSeries&, std::size_t) {
    return [](const ToolPoint& p) { return 1.5e-6 * p.t; };
  };
  for (const std::size_t swapped : {1U, 2U}) {
    std::vector<Profile> profiles = series(kTwiceThereAndBack, drift, GetParam());
    swap_direction(profiles[swapped]);
    const Closed result = closed(problem_of(), profiles);
    SCOPED_TRACE(story(result));
    ASSERT_FALSE(result.blunders.empty());
    EXPECT_EQ(result.blunders.front().profile, "c" + std::to_string(swapped + 1));
    EXPECT_EQ(result.blunders.front().what, BlunderKind::cut_direction);
  }
}

// A reading that rings: white noise through a resonance at 0.05 cycles a sample, whose spectral
// density there is 4 times that of the slow noise. Of waves no name may stand alone: one in
// a hundred searches may find one (Gates::significance).
TEST_P(SingleCuts, ResonanceOfTheReadingIsNoWave) {
  const NoiseOfReading ringing = [](std::size_t samples, RandomStream& random) {
    constexpr double kPole = 0.92, kFrequency = 0.05;
    const double a = 2.0 * kPole * std::cos(2.0 * kPi * kFrequency), b = -kPole * kPole;
    std::vector<double> out(samples + 200);
    for (std::size_t i = 2; i < out.size(); ++i)
      out[i] = a * out[i - 1] + b * out[i - 2] + 0.3 * kNoise * random.normal();
    out.erase(out.begin(), out.begin() + 200);
    return out;
  };
  const std::vector<CutOfSeries> cuts{{10.0, true}, {25.0, true}, {10.0, false}};
  const Closed result = closed(
      problem_of(), series(
                        cuts, [](const auto&, auto) { return nothing(); }, GetParam(), ringing));
  SCOPED_TRACE(story(result));
  EXPECT_THAT(named(result), IsEmpty());
}

// A wave of one cut of which the low band has 2.5 or 3 values a cycle may be the image of another
// one: no name, and not "nothing missing". A finer low band tells it.
TEST_P(SingleCuts, AWaveThatTheLowBandMayHaveFoldedIsSeen) {
  const std::vector<CutOfSeries> cuts{{10.0, true}, {25.0, true}, {10.0, false}};
  for (const double values_a_cycle : {2.5, 3.0}) {
    Problem problem = problem_of();
    const double values = 1600.0 / std::exp2(problem.low_band.level);
    const double cycles = 0.5 * values / values_a_cycle;  // over the radius
    const ErrorOfCut wave = [&](const CutOfSeries& cut, std::size_t which) {
      const double period = 60.0 * kRadius / cut.feed / cycles;
      return which > 0 ? nothing() : [=](const ToolPoint& p) {
        return 6e-5 * std::sin(2.0 * kPi * p.t / period);
      };
    };
    const std::vector<Profile> profiles = series(cuts, wave, GetParam());
    const Closed coarse = closed(problem, profiles);
    SCOPED_TRACE(story(coarse));
    EXPECT_NE(coarse.verdict, TraceVerdict::nothing_missing);
    EXPECT_NE(coarse.verdict, TraceVerdict::explained);
    problem.low_band.level -= 2;
    EXPECT_THAT(named(closed(problem, profiles)), ::testing::Not(IsEmpty()));
  }
}

INSTANTIATE_TEST_SUITE_P(, SingleCuts, ::testing::Values(1U, 2U, 3U));

}  // namespace
}  // namespace slideway::single_cuts_test
