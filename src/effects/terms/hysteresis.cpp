#include <cmath>

#include "../linear_effect.hpp"
#include "../request.hpp"
#include "../variable_range.hpp"

namespace slideway {
namespace {

constexpr int kAmplitudes = 3;

Description describe() {
  return {.name = "hysteresis",
          .standard_name = "reversal error of the straightness of X (ISO 230-2)",
          .formula =
              "±(h_0 + h_1 u + h_2 u²), + outward, - inward; u = r/R on a face, x over its "
              "largest size along the slide",
          .source = "ISO 230-2, reversal value",
          .cause =
              "clearance and friction of the guideway: the carriage leans the other way when "
              "it travels the other way",
          .typical = "below 20 nm (aerostatic), 0.05 to 1 µm (sliding ways)",
          .variable = IndependentVariable::slide,
          .confounded_with =
              "with cuts in one direction only, straightness; a size of each cut's "
              "own of thermal_drift",
          .confounded_effects = {"straightness", "thermal_drift"},
          .separated_by = "a second cut in each direction: what goes with the direction repeats"};
}

double relative_place(const Stations& stations, Eigen::Index i) {
  const Setup& setup = stations.setup();
  if (setup.kind == Kind::face) return stations.radius(i) / *setup.cut_radius_mm;
  const double reach = std::max(std::abs(setup.first_mm), std::abs(setup.last_mm));
  return reach > 0.0 ? stations.slide(i) / reach : 0.0;
}

class Hysteresis : public LinearEffect {
 public:
  Hysteresis()
      : LinearEffect(describe(),
                     {{"offset_um", "h_0", "µm", 0.1},
                      {"tilt_um", "h_1", "µm", 0.1},
                      {"bow_um", "h_2", "µm", 0.1}},
                     diagonal_map(kAmplitudes, kMicrometre)) {}

  [[nodiscard]] bool applies_to(const Setup& setup) const override { return is_height(setup); }

  [[nodiscard]] std::vector<std::string> lacking(const Setup& setup) const override {
    std::vector<std::string> keys = LinearEffect::lacking(setup);
    if (!setup.cut_direction) keys.emplace_back("cut_direction");
    if (setup.kind == Kind::face && !setup.cut_radius_mm) keys.emplace_back("cut_radius_mm");
    return keys;
  }

  [[nodiscard]] std::vector<std::string> lacking_together(
      const std::vector<const Setup*>& setups) const override {
    bool inward = false, outward = false;
    for (const Setup* setup : setups) {
      inward = inward || setup->cut_direction == CutDirection::inward;
      outward = outward || setup->cut_direction == CutDirection::outward;
    }
    if (inward && outward) return {};
    return {"cuts of both cut_direction"};
  }

  void columns(const Stations& stations, std::span<const double> /*shape*/,
               Eigen::Ref<Eigen::MatrixXd> out) const override {
    if (!applies_to(stations.setup())) return void(out.setZero());
    const double sign = stations.setup().cut_direction == CutDirection::outward ? 1.0 : -1.0;
    for (Eigen::Index i = 0; i < stations.size(); ++i) {
      const double u = relative_place(stations, i);
      out.row(i) << sign, sign * u, sign * u * u;
    }
  }

  [[nodiscard]] double size(const Eigen::VectorXd& values) const override {
    return values.cwiseAbs().maxCoeff();
  }
};

}  // namespace

std::unique_ptr<Effect> make_hysteresis(const Request& request) {
  request.accept_only({});
  return std::make_unique<Hysteresis>();
}

}  // namespace slideway
