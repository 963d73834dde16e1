#include <algorithm>
#include <cmath>

#include "../linear_effect.hpp"
#include "../request.hpp"
#include "../variable_range.hpp"

namespace slideway {
namespace {

constexpr int kHysteresisAmplitudes = 3;

Description describe_hysteresis() {
  return {
      .name = "hysteresis",
      .plain_name = "reversal error",
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
          "own of thermal_drift; zero_drift where a slide is read there and back at one pace",
      .confounded_effects = {"straightness", "thermal_drift", "zero_drift"},
      .separated_by =
          "two cuts in each direction: what goes with the direction repeats, what one cut alone "
          "has does not; along the slide a reading at another pace",
      .axisymmetric = true};
}

std::ptrdiff_t of_rarer_direction(const std::vector<const Setup*>& setups) {
  const auto count = [&](CutDirection direction) {
    return std::ranges::count(setups, direction,
                              [](const Setup* setup) { return travel_direction(*setup); });
  };
  return std::min(count(CutDirection::inward), count(CutDirection::outward));
}

/// R of a face, the largest size of x along a slide; mm.
double reach_of(const Setup& setup) {
  if (setup.kind == Kind::face) return *setup.cut_radius_mm;
  return std::max(std::abs(setup.first_mm), std::abs(setup.last_mm));
}

class Hysteresis : public LinearEffect {
 public:
  Hysteresis()
      : LinearEffect(describe_hysteresis(),
                     {{"offset_um", "h_0", "µm", 0.1},
                      {"tilt_um", "h_1", "µm", 0.1},
                      {"bow_um", "h_2", "µm", 0.1}},
                     diagonal_map(kHysteresisAmplitudes, kMicrometre)) {}

  [[nodiscard]] bool applies_to(const Setup& setup) const override {
    return is_height(setup) || setup.kind == Kind::slide;
  }

  [[nodiscard]] std::vector<std::string> lacking(const Setup& setup) const override {
    std::vector<std::string> keys = LinearEffect::lacking(setup);
    if (!travel_direction(setup)) keys.emplace_back("cut_direction");
    if (setup.kind == Kind::face && !setup.cut_radius_mm) keys.emplace_back("cut_radius_mm");
    return keys;
  }

  [[nodiscard]] std::vector<std::string> lacking_together(
      const std::vector<const Setup*>& setups) const override {
    if (of_rarer_direction(setups) > 0) return {};
    return {"readings of both cut_direction"};
  }

  [[nodiscard]] std::vector<std::string> lacking_to_be_told(
      const std::vector<const Setup*>& setups) const override {
    const bool of_faces =
        std::ranges::any_of(setups, [](const Setup* setup) { return setup->kind == Kind::face; });
    if (!of_faces || of_rarer_direction(setups) > 1) return {};
    return {"two cuts of each cut_direction"};
  }

  void columns(const Stations& stations, std::span<const double> /*shape*/,
               Eigen::Ref<Eigen::MatrixXd> out) const override {
    const Setup& setup = stations.setup();
    const double reach = reach_of(setup);
    if (!applies_to(setup) || !(reach > 0.0)) return void(out.setZero());
    const double sign = travel_direction(setup) == CutDirection::outward ? 1.0 : -1.0;
    for (Eigen::Index i = 0; i < stations.size(); ++i) {
      const double u = stations.radius(i) / reach;
      if (is_height(setup))
        out.row(i) << sign, sign * u, sign * u * u;
      else
        out.row(i) << 0.0, sign / reach, sign * 2.0 * u / reach;
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
