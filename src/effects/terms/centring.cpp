#include <algorithm>
#include <cmath>
#include <utility>

#include "../linear_effect.hpp"
#include "../request.hpp"
#include "../variable_range.hpp"

namespace slideway {
namespace {

constexpr double kFarthestFromAxis = 0.1;  // of the radius of the cut

// (|x| - |x - off|)/off is sgn x outside a ramp between 0 and the offset.
double centring_value(double x, double off) {
  if (off == 0.0) return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : 0.0;
  return std::clamp((2.0 * x - off) / std::abs(off), -1.0, 1.0);
}

double centring_derivative(double x, double off) {
  const bool on_ramp = off != 0.0 && std::abs(2.0 * x - off) < std::abs(off);
  return on_ramp ? -2.0 * x / (off * std::abs(off)) : 0.0;
}

std::pair<double, double> centring_search(const Stations& stations) {
  const double farthest = kFarthestFromAxis * *stations.setup().cut_radius_mm;
  return {-farthest, farthest};
}

// The step of a cone, in proportion to the slope of the face. Where that is known, the offset is
// what makes the step of it; the width of the ramp, which often no value shows, says where it lies.
class Centring final : public SingleAmplitude {
 public:
  Centring(SingleAmplitudeSpec spec, std::shared_ptr<const FaceSlope> slope)
      : SingleAmplitude(std::move(spec)), slope_(std::move(slope)) {
    if (slope_ && slope_->rms() == 0.0) slope_ = nullptr;
  }

  void columns(const Stations& stations, std::span<const double> shape,
               Eigen::Ref<Eigen::MatrixXd> out) const override {
    SingleAmplitude::columns(stations, shape, out);
    in_proportion(stations, out);
  }

  void columns_of_shapes(const Stations& stations, std::span<const std::vector<double>> shapes,
                         Eigen::Ref<Eigen::MatrixXd> out) const override {
    SingleAmplitude::columns_of_shapes(stations, shapes, out);
    in_proportion(stations, out);
  }

  void derivatives(const Stations& stations, std::span<const double> shape,
                   Eigen::Ref<Eigen::MatrixXd> out) const override {
    SingleAmplitude::derivatives(stations, shape, out);
    in_proportion(stations, out);
  }

  [[nodiscard]] ParameterValues parameter_values(const Eigen::VectorXd& amplitudes,
                                                 std::span<const double> shape) const override {
    ParameterValues out = SingleAmplitude::parameter_values(amplitudes, shape);
    if (!slope_) return out;
    out.values[1] = -amplitudes[0] / slope_->rms();
    out.jacobian.row(1) << -1.0 / slope_->rms(), 0.0;
    out.by_slope = Eigen::Vector2d(0.0, -out.values[1] / slope_->rms());
    return out;
  }

 private:
  void in_proportion(const Stations& stations, Eigen::Ref<Eigen::MatrixXd> out) const {
    if (!slope_) return;
    const double whole = slope_->rms();
    for (Eigen::Index i = 0; i < stations.size(); ++i)
      out.row(i) *= slope_->at(stations.radius(i)) / whole;
  }

  std::shared_ptr<const FaceSlope> slope_;
};

}  // namespace

std::unique_ptr<Effect> make_centring(const Request& request) {
  request.accept_only({});
  SingleAmplitudeSpec spec{
      .description =
          {.name = "centring",
           .plain_name = "trace off centre",
           .standard_name = "trace off the centre of the face (ISO 12781)",
           .formula = "-X0 z'(r) sgn X: A z'(r)/z'_rms (|X| - |X - X0|)/X0, A = -X0 z'_rms, z' the "
                      "slope of the face as the carriages make it",
           .source = "the form z at |X - X0| less that at |X|, to first order; of a cone exactly",
           .cause = "center_mm is not where the spindle axis lies in the trace",
           .typical = "X0 is 1 to 50 µm, up to 1 mm where a trace was trimmed by hand: 10 nm at "
                      "50 µm on a face that slopes by 200 µrad",
           .variable = IndependentVariable::trace,
           .confounded_with = "centre_step if X0 is not resolved",
           .confounded_effects = {"centre_step"},
           .separated_by =
               "center_mm from the nub or from the edges of the face; traces at three or "
               "more azimuths: a step of the spindle goes with the azimuth",
           .of_face = true},
      .amplitude = {"height_um", "A", "µm", 0.01},
      .reading = [](const Stations& stations, Eigen::Index i) { return stations.trace(i); },
      .value = centring_value,
      .applies_to = crosses_the_axis,
      .needs_cut_radius = true,
      .shape = ShapeSpec{.parameter = {"offset_mm", "X0", "mm", 0.05, -1e3, 1e3},
                         .shape = {.parameter = 1, .logarithmic = false, .stepwise = false},
                         .derivative = centring_derivative,
                         .range = centring_search}};
  return std::make_unique<Centring>(std::move(spec), request.range.face_slope);
}

}  // namespace slideway
