#include "slideway/trace/details.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "identify/cases.hpp"
#include "slideway/base/random.hpp"

namespace slideway::details_test {
namespace {

// What is shown of a profile does not hang on whether it was fitted.
TEST(Details, OfAHeldOutTwinAreThoseOfTheFittedProfile) {
  RandomStream random(6, "twin");
  const std::vector<double> r = cases::spaced(0.0, 20.0, 300);
  std::vector<double> z;
  for (const double at : r) z.push_back(1e-5 * at + 3e-7 * at * at + 1e-5 * random.normal());
  std::vector<Profile> profiles{cases::face("fitted", 2.0, r, z), cases::face("twin", 2.0, r, z)};
  profiles[1].role = Role::holdout;
  const Problem problem = cases::problem(
      Lever::paper, 1, {cases::effect("straightness", 2), cases::effect("squareness")});
  const FittedModel fitted = fit_declared(problem, profiles);
  const Details details = make_details(problem, fitted, nullptr, true);
  ASSERT_EQ(details.what_if.size(), 8U);  // as measured, without each effect, without all
  for (std::size_t i = 0; i < 4; ++i) {
    const PredictedFlatness &own = details.what_if[i], &twin = details.what_if[i + 4];
    EXPECT_EQ(own.corrected, twin.corrected);
    EXPECT_NEAR(*own.rms_um, *twin.rms_um, 1e-9) << own.corrected;
    EXPECT_NEAR(*own.pv_um, *twin.pv_um, 1e-9) << own.corrected;
  }
  ASSERT_TRUE(details.curves);
  const ProfileCurves &own = details.curves->profiles[0], &twin = details.curves->profiles[1];
  ASSERT_EQ(own.contributions.size(), 2U);
  EXPECT_EQ(own.contributions, twin.contributions);
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 2; ++j)
      EXPECT_NEAR(own.correlation[i][j], twin.correlation[i][j], 1e-9);
  EXPECT_FALSE(make_details(problem, fitted, nullptr, false).curves);
}

}  // namespace
}  // namespace slideway::details_test
