#include <gtest/gtest.h>

#include <vector>

#include "slideway/machine/machine.hpp"

namespace slideway::sensitivity_test {
namespace {

constexpr Pose kPose{.radius = 100.0, .z = 50.0, .overhang = 20.0};

TEST(Sensitivity, PaperLeverTurnsEveryAngleAtTheRadius) {
  const Machine machine(Machine::paper_lathe(), Lever::paper);
  for (const int body : {1, 2}) {
    EXPECT_DOUBLE_EQ(machine.height_sensitivity(body, Component::z, kPose), 1.0);
    EXPECT_DOUBLE_EQ(machine.height_sensitivity(body, Component::beta, kPose), -100.0);
    EXPECT_DOUBLE_EQ(machine.squareness_sensitivity(body, kPose), -100.0);
    for (const Component none : {Component::x, Component::y, Component::alpha, Component::gamma})
      EXPECT_EQ(machine.height_sensitivity(body, none, kPose), 0.0);
  }
}

TEST(Sensitivity, SplitLeverTurnsPitchAtTheOverhangAndSquarenessAtTheRadius) {
  const Machine machine(Machine::paper_lathe(), Lever::split);
  EXPECT_DOUBLE_EQ(machine.height_sensitivity(1, Component::z, kPose), 1.0);
  EXPECT_DOUBLE_EQ(machine.height_sensitivity(1, Component::beta, kPose), -20.0);
  EXPECT_DOUBLE_EQ(machine.height_sensitivity(2, Component::beta, kPose), -20.0);
  EXPECT_DOUBLE_EQ(machine.squareness_sensitivity(1, kPose), -100.0);
}

TEST(Sensitivity, FollowsTheOrderOfTheBodies) {
  // With the x carriage on the z carriage, the pitch of z turns the whole travel of x.
  const Machine machine({{"z_carriage", 0, Axis::z}, {"x_carriage", 1, Axis::x}}, Lever::split);
  EXPECT_DOUBLE_EQ(machine.height_sensitivity(1, Component::beta, kPose), -100.0);
  EXPECT_DOUBLE_EQ(machine.height_sensitivity(2, Component::beta, kPose), -20.0);
  EXPECT_DOUBLE_EQ(machine.squareness_sensitivity(2, kPose), -100.0);
}

TEST(Sensitivity, FirstOfTwoCrossCarriagesMakesTheTravel) {
  const Machine machine({{"cross", 0, Axis::x}, {"z_carriage", 1, Axis::z}, {"fine", 2, Axis::x}},
                        Lever::split);
  EXPECT_DOUBLE_EQ(machine.squareness_sensitivity(1, kPose), -100.0);
  EXPECT_DOUBLE_EQ(machine.squareness_sensitivity(3, kPose), -20.0);
}

TEST(Sensitivity, IsTheDerivativeOfTheExactChain) {
  // Central differences of the exact transforms: error of order step², against levers up to 100.
  constexpr double kStep = 1e-5;
  for (const Lever lever : {Lever::paper, Lever::split}) {
    const Machine machine(
        {{"y", 0, Axis::y}, {"z", 1, Axis::z}, {"x", 2, Axis::x}, {"tool", 3, Axis::z}}, lever);
    for (int body = 1; body <= 4; ++body) {
      const auto difference = [&](auto&& set) {
        std::vector<BodyErrors> plus(4), minus(4);
        set(plus[body - 1], kStep);
        set(minus[body - 1], -kStep);
        return (machine.volumetric_error(kPose, plus) - machine.volumetric_error(kPose, minus))
                   .z() /
               (2.0 * kStep);
      };
      EXPECT_NEAR(difference([](BodyErrors& e, double s) { e.motion.beta = s; }),
                  machine.height_sensitivity(body, Component::beta, kPose), 1e-7);
      EXPECT_NEAR(difference([](BodyErrors& e, double s) { e.motion.alpha = s; }),
                  machine.height_sensitivity(body, Component::alpha, kPose), 1e-7);
      EXPECT_NEAR(difference([](BodyErrors& e, double s) { e.motion.z = s; }),
                  machine.height_sensitivity(body, Component::z, kPose), 1e-7);
      EXPECT_NEAR(difference([](BodyErrors& e, double s) { e.squareness = s; }),
                  machine.squareness_sensitivity(body, kPose), 1e-7);
    }
  }
}

}  // namespace
}  // namespace slideway::sensitivity_test
