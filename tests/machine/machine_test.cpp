#include "slideway/machine/machine.hpp"

#include <gmock/gmock.h>

#include <array>
#include <vector>

#include "slideway/base/error.hpp"

namespace slideway::machine_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr BodyErrors kX{{1e-4, 2e-4, 3e-4, 4e-6, 5e-6, 6e-6}, 0.0};
constexpr BodyErrors kZ{{7e-4, 8e-4, 9e-4, 1e-6, 2e-6, 3e-6}, 0.0};

std::string refusal(const std::vector<Body>& bodies) {
  try {
    Machine machine(bodies, Lever::paper);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Machine, FirstOrderErrorIsTheMendedEquation5) {
  // P = (r, 0, 0): Ex = Σx, Ey = Σγ p_x + Σy, Ez = -Σβ p_x + Σz, computed by hand for r = 100 mm.
  const Machine machine(Machine::paper_lathe(), Lever::paper);
  const std::array errors{kX, kZ};
  const Eigen::Vector3d error =
      machine.volumetric_error_first_order({.radius = 100.0, .z = 55.0, .overhang = 7.0}, errors);
  EXPECT_NEAR(error.x(), 8e-4, 1e-17);
  EXPECT_NEAR(error.y(), 9e-6 * 100.0 + 1e-3, 1e-17);
  EXPECT_NEAR(error.z(), -7e-6 * 100.0 + 12e-4, 1e-17);
}

TEST(Machine, SplitLeverSeparatesTravelOverhangAndHeight) {
  // By hand for x_carriage below z_carriage, r = 100, z = 50, overhang = 20: seen from the joint of
  // the x carriage the tool is at (20, 0, 50), from that of the z carriage at (20, 0, 0).
  const Machine machine(Machine::paper_lathe(), Lever::split);
  BodyErrors x = kX;
  x.squareness = 1e-5;  // turns the whole travel: lever (100, 0, 50)
  const std::array errors{x, kZ};
  const Eigen::Vector3d error =
      machine.volumetric_error_first_order({.radius = 100.0, .z = 50.0, .overhang = 20.0}, errors);
  EXPECT_NEAR(error.x(), 8e-4 + 5e-6 * 50.0 + 1e-5 * 50.0, 1e-17);
  EXPECT_NEAR(error.y(), 1e-3 + 9e-6 * 20.0 - 4e-6 * 50.0, 1e-17);
  EXPECT_NEAR(error.z(), 12e-4 - 7e-6 * 20.0 - 1e-5 * 100.0, 1e-17);
}

TEST(Machine, ExactAndFirstOrderDifferBySecondOrderOnly) {
  for (const Lever lever : {Lever::paper, Lever::split}) {
    const Machine machine(Machine::paper_lathe(), lever);
    const Pose pose{.radius = 300.0, .z = 120.0, .overhang = 40.0};
    const auto difference = [&](double scale) {
      std::array errors{kX, kZ};
      for (BodyErrors& body : errors) {
        ErrorMotion& m = body.motion;
        for (double* v : {&m.x, &m.y, &m.z, &m.alpha, &m.beta, &m.gamma}) *v *= 100.0 * scale;
        body.squareness = 3e-4 * scale;
      }
      return (machine.volumetric_error(pose, errors) -
              machine.volumetric_error_first_order(pose, errors))
          .norm();
    };
    // A quarter per halving; the third order is about 1e-3 of the second at these sizes (1e-3 rad).
    EXPECT_GT(difference(1.0), 1e-6);
    EXPECT_NEAR(difference(1.0) / difference(0.5), 4.0, 0.02);
    EXPECT_NEAR(difference(0.5) / difference(0.25), 4.0, 0.02);
  }
}

TEST(Machine, ExactErrorVanishesWithoutErrors) {
  const Machine machine(Machine::paper_lathe(), Lever::split);
  const std::vector<BodyErrors> none(2);
  const Eigen::Vector3d error =
      machine.volumetric_error({.radius = 300.0, .z = 120.0, .overhang = 40.0}, none);
  EXPECT_EQ(error.norm(), 0.0);
}

TEST(Machine, BodyOnASideBranchDoesNotMoveTheTool) {
  // The tailstock stands on the bed; the tool is on body 3.
  const Machine machine(
      {{"x_carriage", 0, Axis::x}, {"tailstock", 0, Axis::x}, {"z_carriage", 1, Axis::z}},
      Lever::split);
  std::vector<BodyErrors> errors(3);
  errors[1] = kX;
  errors[1].squareness = 1e-3;
  const Pose pose{.radius = 10.0, .z = 5.0, .overhang = 2.0};
  EXPECT_EQ(machine.volumetric_error(pose, errors).norm(), 0.0);
  EXPECT_EQ(machine.volumetric_error_first_order(pose, errors).norm(), 0.0);
  EXPECT_EQ(machine.height_sensitivity(2, Component::z, pose), 0.0);
  EXPECT_EQ(machine.squareness_sensitivity(2, pose), 0.0);
  EXPECT_THAT(machine.carriages(Axis::x), ElementsAre(1));
}

TEST(Machine, FindsBodiesByName) {
  const Machine machine(Machine::paper_lathe(), Lever::paper);
  EXPECT_EQ(machine.body("z_carriage"), 2);
  try {
    (void)machine.body("x_carage");
    FAIL() << "an unknown body was found";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("there are x_carriage, z_carriage"));
  }
}

TEST(Machine, RefusesWhatIsNoMachine) {
  EXPECT_THAT(refusal({}), HasSubstr("no body"));
  EXPECT_THAT(refusal({{"a", 0, Axis::x}, {"a", 1, Axis::z}}), HasSubstr("both named 'a'"));
  EXPECT_THAT(refusal({{"a", 2, Axis::x}, {"b", 1, Axis::z}}), HasSubstr("cycle"));
  EXPECT_THAT(refusal({{"a", 5, Axis::x}}), HasSubstr("lower = 5"));
}

TEST(Machine, NamesErrorsAsIso230Part1Does) {
  EXPECT_EQ(error_name(Axis::x, Component::z), "E_ZX");
  EXPECT_EQ(error_name(Axis::x, Component::beta), "E_BX");
  EXPECT_EQ(error_name(Axis::z, Component::x), "E_XZ");
  EXPECT_EQ(error_name(Axis::z, Component::beta), "E_BZ");
  EXPECT_EQ(error_name(Axis::y, Component::alpha), "E_AY");
  EXPECT_EQ(error_name(Axis::x, Component::gamma), "E_CX");
  EXPECT_EQ(error_name(Axis::y, Component::y), "E_YY");
}

}  // namespace
}  // namespace slideway::machine_test
