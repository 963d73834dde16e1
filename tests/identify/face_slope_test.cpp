#include "face_slope.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "cases.hpp"

namespace slideway {
namespace {

// X0 = -A / z'_rms, and z' goes with the parameters of the carriages: the derivative is what X0
// changes by where one of them changes.
TEST(FaceSlope, TheOffsetOfATraceChangesWithTheCarriages) {
  const std::vector<double> positions = cases::spaced(-10.0, 10.0, 400);
  std::vector<double> values;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double r = std::abs(positions[i] - 0.05);
    values.push_back(2e-4 * r + 5e-6 * r * r + 1e-6 * std::sin(37.0 * static_cast<double>(i * i)));
  }
  const std::vector<Profile> profiles{cases::face("diameter", 2.0, positions, values)};
  FittedModel fitted =
      fit_declared(cases::problem(Lever::paper, 1,
                                  {cases::effect("squareness"), cases::effect("straightness", 2),
                                   cases::effect("centring")}),
                   profiles);
  Model& model = fitted.model;
  const Estimate& estimate = fitted.fit.estimate;
  const auto at = std::ranges::find(model.terms, "centring", &ModelTerm::name);
  ASSERT_NE(at, model.terms.end());
  const Eigen::Index offset = at->first_parameter + 1;
  model.range.face_slope = face_slope(model, estimate);
  ASSERT_TRUE(follow_face(model));
  const ParameterValues known = all_parameters(model, estimate);
  EXPECT_NEAR(known.values[offset], 0.05, 0.01);
  for (Eigen::Index k = 0; k < model.amplitudes(); ++k) {
    Estimate moved = estimate;
    const double step = 1e-4 * std::abs(estimate.amplitudes[k]);
    moved.amplitudes[k] += step;
    model.range.face_slope = face_slope(model, moved);
    ASSERT_TRUE(follow_face(model));
    const double change = all_parameters(model, moved).values[offset] - known.values[offset];
    // The second derivative adds a ten-thousandth of the size it has where all of z' is moved.
    EXPECT_NEAR(change, known.jacobian(offset, k) * step, 1e-8 * known.values[offset]) << k;
  }
}

}  // namespace
}  // namespace slideway
