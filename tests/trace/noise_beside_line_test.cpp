// A wave is held against the noise beside its line. The residuals here are of a known spectrum.

#include <cmath>

#include "detection.hpp"
#include "identify/cases.hpp"
#include "modulation.hpp"
#include "search_round.hpp"
#include "slideway/base/random.hpp"
#include "slideway/base/units.hpp"
#include "slideway/identify/low_band_lines.hpp"
#include "trace/faces.hpp"

namespace slideway::noise_beside_line_test {
namespace {

constexpr int kValues = 250;
constexpr double kLength = 10.0, kNoise = 10e-6;  // mm

/// A radius of white noise and the waves along the slide that are looked for in it.
struct Waves {
  Waves()
      : problem(cases::problem(Lever::paper, 0, {cases::effect("squareness")})),
        profiles{cases::face("face", 2.0, cases::spaced(0.0, kLength, kValues),
                             cases::spaced(0.0, 1e-3, kValues))},
        model((profiles[0].standard_uncertainty = kNoise, build_model(problem, profiles))),
        fitted(fit(model)),
        data(fitted.linear, {Noise::white(kNoise, kValues)}),
        dictionary(make_dictionary(model, faces::problem_of({"slide_periodic"}), 0)),
        wave(dictionary.candidates.front()) {}

  /// The atom next to so many cycles over the length.
  [[nodiscard]] Eigen::Index at(double cycles) const {
    const auto& points = wave.grid.points();
    return std::ranges::min_element(
               points, {}, [&](const auto& p) { return std::abs(kLength / p[0] - cycles); }) -
           points.begin();
  }

  [[nodiscard]] double beside(Eigen::Index atom, const Eigen::VectorXd& rest) const {
    return noise_beside_line(data, {.candidate = &wave, .atom = atom}, rest, {});
  }

  Problem problem;
  std::vector<Profile> profiles;
  Model model;
  Solution fitted;
  Whitened data;
  Dictionary dictionary;
  Candidate& wave;
};

/// White noise of unit variance, `power` times as strong from one number of cycles to another.
Eigen::VectorXd with_peak(double power, int from, int to, RandomStream& random) {
  Eigen::VectorXd out(kValues);
  for (double& value : out) value = random.normal();
  for (int cycles = from; cycles <= to; ++cycles) {
    const double size = std::sqrt(2.0 * (power - 1.0) / kValues);
    const double a = size * random.normal(), b = size * random.normal();
    for (int i = 0; i < kValues; ++i) {
      const double turn = 2.0 * kPi * cycles * i / (kValues - 1);
      out[i] += a * std::cos(turn) + b * std::sin(turn);
    }
  }
  return out;
}

/// Of 100 residuals: the mean, and how many are not 1.
std::pair<double, int> beside_of_100(const Waves& waves, Eigen::Index atom, double power, int from,
                                     int to) {
  RandomStream random(20261127, "beside a line");
  double sum = 0.0;
  int above = 0;
  for (int i = 0; i < 100; ++i) {
    const double level = waves.beside(atom, with_peak(power, from, to, random));
    sum += level;
    above += level != 1.0 ? 1 : 0;
  }
  return {sum / 100.0, above};
}

// Of two standard deviations 33 degrees of freedom know the variance to a quarter, the mean of 100
// to 0.025; four of them, and what the ends of the peak take, a twentieth.
TEST(NoiseBesideLine, IsThePowerOfABroadPeak) {
  const Waves waves;
  for (const double power : {4.0, 9.0}) {
    const auto [mean, above] = beside_of_100(waves, waves.at(30.0), power, 17, 43);
    EXPECT_NEAR(mean, power, 0.15 * power);
    EXPECT_GE(above, 99);
  }
}

TEST(NoiseBesideLine, IsOneInWhiteNoiseButForChance) {
  const Waves waves;
  const auto [mean, above] = beside_of_100(waves, waves.at(30.0), 1.0, 1, 0);
  EXPECT_LE(above, 6);  // of 100 at 0.01: more in 1e-4 of correct programs
  EXPECT_NEAR(mean, 1.0, 0.1);
}

// The nearest two cycles are the line's own, and what is ten away is not beside it.
TEST(NoiseBesideLine, LeavesOutWhatIsAtTheLineAndWhatIsFarFromIt) {
  const Waves waves;
  EXPECT_LE(beside_of_100(waves, waves.at(30.0), 25.0, 30, 30).second, 6);
  EXPECT_LE(beside_of_100(waves, waves.at(30.0), 25.0, 42, 60).second, 12);  // some of it leaks
  EXPECT_GE(beside_of_100(waves, waves.at(30.0), 25.0, 33, 36).second, 99);
  EXPECT_GE(beside_of_100(waves, waves.at(30.0), 25.0, 24, 27).second, 99);
}

TEST(NoiseBesideLine, IsKnownFromOneSideAtTheEndsOfTheLattice) {
  const Waves waves;
  for (const Eigen::Index atom : {Eigen::Index{0}, waves.wave.atoms() - 1}) {
    const auto [mean, above] = beside_of_100(waves, atom, 9.0, 1, 80);
    EXPECT_NEAR(mean, 9.0, 1.5) << atom;
    EXPECT_GE(above, 99) << atom;
  }
}

TEST(NoiseBesideLine, IsNotKnownFromFewAtomsNorOfTwoShapes) {
  Waves waves;
  std::vector<double> periods;
  for (int i = 0; i < 28; ++i) periods.push_back(kLength / (30.0 - i / 3.0));
  RandomStream random(20261127, "few");
  const Eigen::VectorXd strong = 3.0 * with_peak(1.0, 1, 0, random);
  // Six cycles of three atoms each, and the six atoms nearest to the first.
  for (const auto& [atoms, known] : {std::pair{23, false}, std::pair{24, true}}) {
    const std::vector<double> axis(periods.begin(), periods.begin() + atoms);
    lay_out(waves.model, 0, ShapeLattice(std::vector<std::vector<double>>{axis}), waves.wave);
    EXPECT_EQ(waves.beside(0, strong) > 1.0, known) << atoms;
  }
  waves.wave.grid = ShapeLattice({periods, std::vector{1.0, 2.0}});
  EXPECT_EQ(waves.beside(0, strong), 1.0);
}

// 249 steps hold 62.25 cycles of four values, and a line is one cycle wide.
TEST(WavesOfOneProfile, AreTooFineBelowFourValuesACycle) {
  Waves waves;
  Refined refined;
  refined.candidate = &waves.wave;
  const auto too_fine = [&](double cycles) {
    refined.shape = {kLength / cycles};
    return is_too_fine(waves.model, refined.candidate->term, refined.shape,
                       waves.model.observations[0]);
  };
  EXPECT_FALSE(too_fine(10.0));
  EXPECT_FALSE(too_fine(63.2));
  EXPECT_TRUE(too_fine(63.3));
}

TEST(WavesOfOneProfile, HaveLimitsAtPeriodsThatAreSearched) {
  const Waves waves;
  const auto limits = detection_limits({waves.model, waves.fitted}, waves.data, waves.data.noise(),
                                       {&waves.wave}, {20.0, 2.0});
  ASSERT_EQ(limits.size(), 1U);
  ASSERT_GT(limits[0].by_shape.size(), 2U);
  double before = 0.0;
  for (const LimitAtShape& limit : limits[0].by_shape) {
    EXPECT_GT(limit.shape, before);
    before = limit.shape;
  }
  EXPECT_LE(before, kLength * (1.0 + 1e-9));
}

// BIC counts what the line gains over the noise beside it: -60 + 80 (1 - 1 / n) is -10 at n = 8/3.
TEST(NoiseBesideLine, IsWhatAWaveIsRefusedFor) {
  Waves waves;
  TestedCandidate tested;
  tested.refined.candidate = &waves.wave;
  tested.refined.values = Eigen::Vector3d(0.1, 0.3, 0.0);
  tested.refined.projection.rank = 2;
  tested.refined.projection.gain = 80.0;
  tested.refined.delta_bic = -60.0;
  tested.refined.size_in_uncertainties = 9.0;
  tested.p_value = 0.0;
  EXPECT_EQ(tested.refused({}), "");
  tested.noise_beside = 2.6;
  EXPECT_NEAR(tested.delta_bic_beside(), 20.0 - 80.0 / 2.6, 1e-9);
  EXPECT_EQ(tested.refused({}), "");
  tested.noise_beside = 2.7;
  EXPECT_EQ(tested.refused({}), "the noise beside its line is 2.7 times as strong");
}

}  // namespace
}  // namespace slideway::noise_beside_line_test
