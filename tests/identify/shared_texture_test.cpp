// What a tool leaves from turn to turn is the same all round the face: both halves of a diameter
// and traces at other azimuths have it in common. The faces here are made of the turns themselves.

#include <gtest/gtest.h>

#include <cmath>

#include "identify/cases.hpp"
#include "slideway/base/random.hpp"
#include "slideway/identify/held_out.hpp"
#include "slideway/identify/identify.hpp"

namespace slideway::shared_texture_test {
namespace {

constexpr double kRadius = 40.0, kFeed = 0.2;      // mm
constexpr double kTurn = 15e-6, kStylus = 5e-6;    // mm, standard deviations
constexpr double kSquareness = 8e-6, kSag = 1e-4;  // rad; mm at the rim
constexpr double kShared = 9.0 / 10.0;             // of the variance of a value
constexpr int kValues = 400;                       // of a diameter: one a turn

/// The depth of each turn from the centre on.
std::vector<double> turns(std::uint64_t seed) {
  RandomStream random(seed, "turns");
  std::vector<double> out(static_cast<std::size_t>(kRadius / kFeed) + 1);
  for (double& each : out) each = kTurn * random.normal();
  return out;
}

/// A trace of a face with a squareness and a sag, each value within one turn.
Profile trace(const std::string& name, double from_mm, const std::vector<double>& near,
              const std::vector<double>& far, std::uint64_t seed) {
  RandomStream random(seed, name);
  const std::vector<double> x = cases::spaced(from_mm + kFeed / 2, kRadius - kFeed / 2,
                                              from_mm < 0.0 ? kValues : kValues / 2);
  std::vector<double> z;
  for (const double at : x) {
    const double r = std::abs(at);
    z.push_back(-kSquareness * r + kSag * r * r / (kRadius * kRadius) + kStylus * random.normal() +
                (at < 0.0 ? far : near)[static_cast<std::size_t>(r / kFeed)]);
  }
  Profile out = cases::face(name, 20.0, x, z);
  out.surface = "face";
  return out;
}

Problem declared() {
  return cases::problem(Lever::paper, 0,
                        {cases::effect("squareness"), cases::effect("straightness", 2)});
}

/// The weight of white noise in the first of these traces.
double weight_of(const std::vector<Profile>& profiles) {
  return fit_declared(declared(), profiles).fit.noise.front().weight().white;
}

TEST(SharedTexture, MakesAHalfOfADiameterWeighLess) {
  int shared = 0, unrelated = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const std::vector<double> one = turns(seed), other = turns(1000 + seed);
    // The mean product of 200 pairs errs by 7 %.
    shared += std::abs(weight_of({trace("a", -kRadius, one, one, seed)}) - 1.0 - kShared) < 0.25;
    unrelated += weight_of({trace("a", -kRadius, one, other, seed)}) > 1.0;
  }
  EXPECT_GE(shared, 18);    // white noise seems to be slow by chance
  EXPECT_LE(unrelated, 2);  // each by a chance of 2.3 %: three of 20 in 1 %
}

TEST(SharedTexture, MakesARadiusWeighLessBesideThoseAtOtherAzimuths) {
  const std::vector<double> one = turns(1);
  std::vector<Profile> radii;
  for (const double azimuth : {0.0, 90.0, 180.0, 270.0}) {
    radii.push_back(trace("r" + std::to_string(static_cast<int>(azimuth)), 0.0, one, one, 1));
    radii.back().setup.azimuth_deg = azimuth;
  }
  EXPECT_NEAR(weight_of(radii), 1.0 + 3.0 * kShared, 0.4);
  for (Profile& each : radii) each.surface = each.name;  // faces of their own
  EXPECT_EQ(weight_of(radii), 1.0);
}

// U that takes the halves for two is short by a factor of 0.73.
TEST(SharedTexture, IsInTheUncertainty) {
  int held = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    const std::vector<double> one = turns(100 + seed);
    const std::vector<Profile> profiles = {trace("a", -kRadius, one, one, seed)};
    const Result result = identify(declared(), profiles);
    const FittedParameter* p = result.final->find("squareness.dbeta_xz");
    held += std::abs(*p->value - kSquareness) <= *p->expanded_uncertainty;
  }
  EXPECT_GE(held, 35);  // of 40 at 95.45 %: fewer in 1 %; at 85 %, fewer in 65 %
}

// The marks of a tool that a held-out cut alone has are no disagreement: a scallop of every turn,
// whose samples show it, folded by the low band.
TEST(HeldOutCheck, LeavesACutItsOwnFeedMarks) {
  const auto cut = [](const std::string& name, double feed, double nose_mm, std::uint64_t seed) {
    RandomStream random(seed, name);
    const std::vector<double> x = cases::spaced(-kRadius, kRadius, 8001);
    std::vector<double> z;
    for (const double at : x) {
      const double r = std::abs(at), turn = r / feed + (at < 0.0 ? 0.5 : 0.0);
      const double beside = (turn - std::round(turn)) * feed;
      z.push_back(-kSquareness * r + beside * beside / (2.0 * nose_mm) + kStylus * random.normal());
    }
    Profile out = cases::face(name, feed * 110.0, x, z);
    out.setup.nose_radius_mm = nose_mm;
    return out;
  };
  Problem problem = declared();
  problem.low_band.level = 3;
  for (unsigned seed = 0; seed < 5; ++seed) {
    std::vector<Profile> profiles = {cut("a", 0.0371, 50.0, seed), cut("b", 0.0573, 0.8, seed)};
    profiles[1].role = Role::holdout;
    const Result result = identify(problem, profiles);
    ASSERT_EQ(result.crosscheck.held_out.size(), 1U);
    EXPECT_EQ(result.crosscheck.held_out[0].verdict, HeldOutVerdict::fits) << seed;
    for (double& value : profiles[1].values) value = -value;  // the cone turned over
    EXPECT_EQ(identify(problem, profiles).crosscheck.held_out[0].verdict,
              HeldOutVerdict::does_not_fit)
        << seed;
  }
}

}  // namespace
}  // namespace slideway::shared_texture_test
