#include <algorithm>
#include <cmath>

#include "../linear_effect.hpp"
#include "../request.hpp"
#include "../variable_range.hpp"

namespace slideway {
namespace {

constexpr int kFewestLobes = 2, kMostLobes = 4;
constexpr int kLobeAmplitudes = 2 * (kMostLobes - kFewestLobes + 1);
constexpr double kHalfTurn = 180.0;         // degrees
constexpr std::size_t kFewestAzimuths = 3;  // the form all traces share, cosine and sine
constexpr double kSameAzimuth = 1e-6;       // degrees

Description describe_chucking_lobes() {
  return {.name = "chucking_lobes",
          .plain_name = "chucking lobes",
          .standard_name = "flatness deviation with lobes around the axis (ISO 12781)",
          .formula =
              "Σ_n (r/R)^n (a_n cos nθ + b_n sin nθ), n = 2, 3, 4; θ the azimuth_deg of the trace, "
              "half a turn more where X < 0",
          .source = "plate bending: r^n cos nθ bends a plate without a load on its face",
          .cause =
              "jaws or clamps: the workpiece is turned flat while bent and springs back; two "
              "jaws make two lobes, three jaws three",
          .typical = "0.05 to 2 µm",
          .variable = IndependentVariable::radius,
          .confounded_with =
              "at one azimuth even lobes are a cup and b_2, b_4 of straightness, "
              "three lobes are traverse_datum",
          .confounded_effects = {"cup", "traverse_datum", "straightness"},
          .separated_by =
              "traces at three or more azimuths that are no multiple of one another's "
              "lobe: 0°, 50°, 100°; another clamping"};
}

std::vector<Parameter> lobe_parameters() {
  std::vector<Parameter> list;
  for (int n = kFewestLobes; n <= kMostLobes; ++n) {
    const std::string order = std::to_string(n);
    list.push_back({"cos" + order + "_um", "a_" + order, "µm", 0.1});
    list.push_back({"sin" + order + "_um", "b_" + order, "µm", 0.1});
  }
  return list;
}

// In (-90, 90] of a trace over the diameter, which looks both ways, in (-180, 180] of a radius.
double direction_of(const Setup& setup) {
  const bool looks_both_ways = setup.first_mm < setup.center_mm && setup.center_mm < setup.last_mm;
  const double turn = looks_both_ways ? kHalfTurn : 2.0 * kHalfTurn;
  const double direction = std::remainder(setup.azimuth_deg, turn);
  return direction <= -turn / 2.0 + kSameAzimuth ? direction + turn : direction;
}

/// A lobe that no trace crosses has a column of zeros: sin 180° is none of 1e-16.
double without_rounding(double value) { return std::abs(value) < 1e-12 ? 0.0 : value; }

class ChuckingLobes : public LinearEffect {
 public:
  ChuckingLobes()
      : LinearEffect(describe_chucking_lobes(), lobe_parameters(),
                     diagonal_map(kLobeAmplitudes, kMicrometre)) {}

  [[nodiscard]] bool applies_to(const Setup& setup) const override { return is_face_height(setup); }

  [[nodiscard]] std::vector<std::string> lacking(const Setup& setup) const override {
    std::vector<std::string> keys = LinearEffect::lacking(setup);
    if (!setup.cut_radius_mm) keys.emplace_back("cut_radius_mm");
    return keys;
  }

  [[nodiscard]] std::vector<std::string> lacking_together(
      const std::vector<const Setup*>& setups) const override {
    std::vector<double> directions;
    for (const Setup* setup : setups) directions.push_back(direction_of(*setup));
    std::ranges::sort(directions);
    const auto same = [](double a, double b) { return b - a <= kSameAzimuth; };
    directions.erase(std::unique(directions.begin(), directions.end(), same), directions.end());
    if (directions.size() >= kFewestAzimuths) return {};
    return {"azimuth_deg of at least three traces in three directions"};
  }

  // r^n cos n(θ + 180°) = (-r)^n cos nθ: X takes the place of r on both halves of a diameter.
  void columns(const Stations& stations, std::span<const double> /*shape*/,
               Eigen::Ref<Eigen::MatrixXd> out) const override {
    if (!applies_to(stations.setup())) return void(out.setZero());
    const double azimuth = stations.setup().azimuth_deg * kPi / kHalfTurn;
    for (Eigen::Index i = 0; i < stations.size(); ++i) {
      const double ratio = stations.trace(i) / *stations.setup().cut_radius_mm;
      for (int n = kFewestLobes; n <= kMostLobes; ++n) {
        const double power = std::pow(ratio, n);
        out(i, 2 * (n - kFewestLobes)) = power * without_rounding(std::cos(n * azimuth));
        out(i, 2 * (n - kFewestLobes) + 1) = power * without_rounding(std::sin(n * azimuth));
      }
    }
  }

  [[nodiscard]] double size(const Eigen::VectorXd& values) const override { return values.norm(); }
};

}  // namespace

std::unique_ptr<Effect> make_chucking_lobes(const Request& request) {
  request.accept_only({});
  return std::make_unique<ChuckingLobes>();
}

}  // namespace slideway
