// A copy is told from a second reading by the noise that it lacks.

#include "copies.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "identify/cases.hpp"

namespace slideway {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A form of 5 µm with a texture of 50 nm, as an instrument with so much noise reads it, in mm.
Profile second_reading(const std::string& name, double noise_mm, unsigned seed) {
  std::mt19937_64 of_texture(1), of_noise(seed);
  std::normal_distribution<double> texture(0.0, 5e-5), noise(0.0, noise_mm);
  const std::vector<double> x = cases::spaced(1.0, 50.0, 400);
  std::vector<double> z;
  for (const double r : x)
    z.push_back(5e-3 * std::sin(r / 20.0) + texture(of_texture) + noise(of_noise));
  return cases::face(name, 8.0, x, z);
}

Profile rounded_to(Profile profile, double digit_mm) {
  for (double& each : profile.values) each = digit_mm * std::round(each / digit_mm);
  return profile;
}

Profile levelled_again(Profile profile, const std::string& name, double offset, double tilt) {
  profile.name = name;
  for (std::size_t i = 0; i < profile.values.size(); ++i)
    profile.values[i] += offset + tilt * profile.positions[i];
  return profile;
}

void expect_copy(std::vector<Profile> profiles) {
  hold_out_copies(profiles);
  EXPECT_EQ(profiles[0].role, Role::fit);
  EXPECT_EQ(profiles[1].role, Role::holdout);
  EXPECT_THAT(profiles[0].notes, Contains(HasSubstr("'b'")));
  EXPECT_THAT(profiles[1].doubts, Contains(HasSubstr("'a'")));
}

TEST(Copies, AreHeldOutHoweverTheyAreLevelledAndRounded) {
  const Profile exact = second_reading("a", 1e-5, 2), rounded = rounded_to(exact, 1e-6);
  expect_copy({exact, levelled_again(exact, "b", 0.0, 0.0)});
  expect_copy({exact, levelled_again(exact, "b", 3e-3, -2e-5)});
  expect_copy({rounded, levelled_again(rounded, "b", 3e-3, -2e-5)});
  expect_copy({rounded, rounded_to(levelled_again(exact, "b", 3e-3, -2e-5), 2e-6)});
  Profile shifted = levelled_again(exact, "b", 1e-3, 0.0);
  shifted.setup.center_mm = 7.0;
  for (double& each : shifted.positions) each += 7.0;
  expect_copy({exact, shifted});
}

TEST(Copies, SecondReadingsAreNone) {
  // Noise of five digits; of a fifth and a hundredth of a digit that the texture has five of.
  for (const auto& [noise, digit] :
       {std::pair{1e-5, 2e-6}, std::pair{2e-6, 1e-5}, std::pair{1e-7, 1e-5}}) {
    std::vector<Profile> profiles{rounded_to(second_reading("a", noise, 2), digit),
                                  rounded_to(second_reading("b", noise, 3), digit)};
    hold_out_copies(profiles);
    EXPECT_EQ(profiles[1].role, Role::fit) << noise << " " << digit;
    EXPECT_THAT(profiles[1].doubts, IsEmpty());
  }
}

TEST(Copies, SmoothCurvesThatAreEqualAreNone) {
  const std::vector<double> x = cases::spaced(1.0, 50.0, 400);
  std::vector<double> z;
  for (const double r : x) z.push_back(1e-6 * r * r);
  std::vector<Profile> profiles{cases::face("a", 8.0, x, z), cases::face("b", 2.0, x, z)};
  hold_out_copies(profiles);
  EXPECT_EQ(profiles[1].role, Role::fit);
}

}  // namespace
}  // namespace slideway
