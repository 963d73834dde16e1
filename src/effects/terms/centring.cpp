#include <cmath>

#include "../linear_effect.hpp"
#include "../request.hpp"
#include "../variable_range.hpp"

namespace slideway {
namespace {

constexpr int kMostDegree = 3;  // of the form of the face in r

Description describe() {
  return {.name = "centring",
          .standard_name = "trace off the centre of the face (ISO 12781)",
          .formula =
              "Σ_k d_k (r/R)^(k-1) sgn X, k = 1 to degree (1 if not given); of a form Σ_k z_k r^k "
              "off the centre by X0, d_k = -X0 k z_k R^(k-1): X0 is -d_1 over the slope z_1 of the "
              "face",
          .source = "the form at |X - X0| less that at |X|, to first order -X0 z'(r) sgn X",
          .cause = "center_mm is not where the spindle axis lies in the trace",
          .typical =
              "X0 is 1 to 50 µm, more where a trace was trimmed by hand: 10 nm at 50 µm on "
              "a face that slopes by 200 µrad",
          .variable = IndependentVariable::trace,
          .confounded_with = "centre_step, exactly, on a cone",
          .confounded_effects = {"centre_step"},
          .separated_by =
              "center_mm from the nub or from the edges of the face; traces at three "
              "or more azimuths: a step of the spindle goes with the azimuth"};
}

std::vector<Parameter> centring_parameters(int degree) {
  std::vector<Parameter> list;
  for (int k = 1; k <= degree; ++k)
    list.push_back({"d" + std::to_string(k) + "_um", "d_" + std::to_string(k), "µm", 0.01});
  return list;
}

class Centring : public LinearEffect {
 public:
  explicit Centring(int degree)
      : LinearEffect(describe(), centring_parameters(degree), diagonal_map(degree, kMicrometre)) {}

  // On one side of the axis it would be the form itself.
  [[nodiscard]] bool applies_to(const Setup& setup) const override {
    return is_face_height(setup) && setup.first_mm < setup.center_mm &&
           setup.center_mm < setup.last_mm;
  }

  [[nodiscard]] std::vector<std::string> lacking(const Setup& setup) const override {
    std::vector<std::string> keys = LinearEffect::lacking(setup);
    if (!setup.cut_radius_mm) keys.emplace_back("cut_radius_mm");
    return keys;
  }

  [[nodiscard]] std::vector<EffectOptions> hypotheses(
      const EffectOptions* declared) const override {
    if (declared) return {};
    std::vector<EffectOptions> out(kMostDegree);
    for (int degree = 1; degree <= kMostDegree; ++degree) out[degree - 1].degree = degree;
    return out;
  }

  void columns(const Stations& stations, std::span<const double> /*shape*/,
               Eigen::Ref<Eigen::MatrixXd> out) const override {
    if (!applies_to(stations.setup())) return void(out.setZero());
    for (Eigen::Index i = 0; i < stations.size(); ++i) {
      const double x = stations.trace(i);
      double power = x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : 0.0;
      for (Eigen::Index k = 0; k < out.cols(); ++k) {
        out(i, k) = power;
        power *= stations.radius(i) / *stations.setup().cut_radius_mm;
      }
    }
  }

  [[nodiscard]] double size(const Eigen::VectorXd& values) const override {
    return values.cwiseAbs().maxCoeff();
  }
};

}  // namespace

std::unique_ptr<Effect> make_centring(const Request& request) {
  request.accept_only({"degree"});
  return std::make_unique<Centring>(request.options.degree ? request.degree(1, kMostDegree) : 1);
}

}  // namespace slideway
