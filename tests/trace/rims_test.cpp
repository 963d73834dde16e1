#include "rims.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "identify/cases.hpp"
#include "slideway/base/random.hpp"

namespace slideway::rims_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr Eigen::Index kValues = 200;  // 0.1 mm apart
constexpr double kNoise = 10e-6, kOff = 1e-3;

/// Values past a rim of a diameter whose residual is white noise about what `shape` says of X.
template <typename Shape>
ValueIndices past_a_rim(Shape&& shape, Kind kind = Kind::face) {
  RandomStream random(5, "rims");
  const std::vector<double> x = cases::spaced(-9.95, 9.95, kValues);
  std::vector<double> z;
  for (const double at : x) z.push_back(shape(at) + kNoise * random.normal());
  std::vector<Profile> profiles{cases::face("face", 2.0, x, z)};
  profiles[0].setup.kind = kind;
  const Model model =
      build_model(cases::problem(Lever::paper, 0, {cases::effect("straightness", 2)}), profiles);
  return values_past_a_rim(model.observations[0],
                           Eigen::Map<const Eigen::VectorXd>(z.data(), kValues), Gates{});
}

TEST(Rims, AreLeftOutAtBothEndsWhereOneHasLeftTheFace) {
  EXPECT_THAT(past_a_rim([](double x) { return x > 9.7 ? -kOff : 0.0; }),
              ElementsAre(0, 1, 2, 197, 198, 199));
  EXPECT_THAT(past_a_rim([](double x) { return x < -9.9 ? -kOff : 0.0; }), ElementsAre(0, 199));
}

/// A tilt, and a bow of one half alone: their difference is a parabola.
double bent(double x) { return 1e-3 * x + (x > 0.0 ? 1e-4 * x * x : 0.0); }

TEST(Rims, AreLeftOutBesideADifferenceThatIsAParabola) {
  EXPECT_THAT(past_a_rim([](double x) { return bent(x) - (x > 9.7 ? kOff : 0.0); }),
              ElementsAre(0, 1, 2, 197, 198, 199));
}

TEST(Rims, KeepWhatBothEndsShowAndWhatAParabolaMakesOfThem) {
  EXPECT_THAT(past_a_rim([](double) { return 0.0; }), IsEmpty());
  EXPECT_THAT(past_a_rim([](double x) { return std::abs(x) > 9.7 ? -kOff : 0.0; }), IsEmpty());
  EXPECT_THAT(past_a_rim(bent), IsEmpty());
  EXPECT_THAT(past_a_rim([](double x) { return x > 9.7 ? -kOff : 0.0; }, Kind::slide), IsEmpty());
}

}  // namespace
}  // namespace slideway::rims_test
