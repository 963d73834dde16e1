#include <cmath>

#include "../linear_effect.hpp"
#include "../periodic_effect.hpp"
#include "../phasor.hpp"
#include "../request.hpp"
#include "../variable_range.hpp"

namespace slideway {
namespace {

constexpr int kHarmonics = 2;
constexpr int kAmplitudes = 4 * kHarmonics;  // cos, sin and their growth
constexpr double kRpmNoReach = 1e-9;
constexpr double kRpmReach = 0.02;  // share of the nominal speed that is searched

std::vector<Parameter> runout_parameters() {
  std::vector<Parameter> list;
  for (int h = 1; h <= kHarmonics; ++h) {
    const std::string order = std::to_string(h);
    list.push_back({"cos" + order + "_um", "a_" + order, "µm", 0.1});
    list.push_back({"sin" + order + "_um", "b_" + order, "µm", 0.1});
    list.push_back({"cos" + order + "_growth_um", "a'_" + order, "µm", 0.1});
    list.push_back({"sin" + order + "_growth_um", "b'_" + order, "µm", 0.1});
  }
  list.push_back({"rpm", "n", "1/min", 1.0, 1e-3, 1e6});
  return list;
}

Description describe() {
  return {
      .name = "spindle_runout",
      .standard_name =
          "synchronous axial and tilt error motion, run-out of a test bar "
          "(ISO 230-7)",
      .formula =
          "Σ_h (a_h + a'_h ξ) cos 2πhk + (b_h + b'_h ξ) sin 2πhk, h = 1, 2; k = t n/60, "
          "ξ the position from -1 to 1, phase from t = 0",
      .source = "ISO 230-7",
      .cause =
          "eccentric and tilted axis: one and two lines per turn that grow along the "
          "reading",
      .typical =
          "5 to 50 nm (aerostatic spindle), 0.1 to 10 µm for a test bar read along the "
          "slide",
      .variable = IndependentVariable::revolution,
      .confounded_with =
          "slide_periodic at one feed; on a face one groove per turn samples it at "
          "a fixed angle, so that its lines become constants and slow drifts",
      .confounded_effects = {"slide_periodic"},
      .separated_by = "a second feed or spindle speed: the lines stay at whole orders per turn"};
}

// Position from -1 to 1: over the cut radius of a face, over the trace of a slide reading.
double scaled_position(const Stations& stations, Eigen::Index i) {
  const Setup& setup = stations.setup();
  const bool is_face = setup.kind == Kind::face;
  const double low = is_face ? 0.0 : setup.first_mm;
  const double high = is_face ? *setup.cut_radius_mm : setup.last_mm;
  return high > low ? 2.0 * (stations.radius(i) - low) / (high - low) - 1.0 : 0.0;
}

class SpindleRunout : public LinearEffect {
 public:
  SpindleRunout()
      : LinearEffect(describe(), runout_parameters(), diagonal_map(kAmplitudes, kMicrometre),
                     {{.parameter = kAmplitudes, .logarithmic = false, .stepwise = false}}) {}

  [[nodiscard]] std::pair<double, double> search_range(int /*shape*/,
                                                       const Stations& stations) const override {
    const double rpm = *stations.setup().spindle_rpm;
    // One groove per turn samples a face: another speed would be another alias, any slow line.
    const double reach = stations.setup().kind == Kind::face ? kRpmNoReach : kRpmReach;
    return {rpm * (1.0 - reach), rpm * (1.0 + reach)};
  }

  [[nodiscard]] double resolution(int /*shape*/, double /*value*/,
                                  const Stations& stations) const override {
    return kCyclesPerStep / kHarmonics * kMinute / range_of(stations, time_of).extent();
  }

  [[nodiscard]] bool applies_to(const Setup& setup) const override { return is_height(setup); }

  [[nodiscard]] std::vector<std::string> lacking(const Setup& setup) const override {
    std::vector<std::string> keys = LinearEffect::lacking(setup);
    if (setup.kind == Kind::face && !setup.cut_radius_mm) keys.emplace_back("cut_radius_mm");
    return keys;
  }

  void columns(const Stations& stations, std::span<const double> shape,
               Eigen::Ref<Eigen::MatrixXd> out) const override {
    fill(stations, shape[0], out, [](double /*angle_per_rpm*/, double& /*c*/, double& /*s*/) {});
  }

  void derivatives(const Stations& stations, std::span<const double> shape, int /*which*/,
                   Eigen::Ref<Eigen::MatrixXd> out) const override {
    fill(stations, shape[0], out, [](double angle_per_rpm, double& cosine, double& sine) {
      const double slope = -angle_per_rpm * sine;
      sine = angle_per_rpm * cosine;
      cosine = slope;
    });
  }

  [[nodiscard]] double size(const Eigen::VectorXd& values) const override {
    return values.head(kAmplitudes).norm();
  }

 private:
  template <typename Line>
  void fill(const Stations& stations, double rpm, Eigen::Ref<Eigen::MatrixXd> out,
            Line&& line) const {
    if (!applies_to(stations.setup())) return void(out.setZero());
    Phasor phasor;
    for (Eigen::Index i = 0; i < stations.size(); ++i) {
      const double position = scaled_position(stations, i);
      const double turn = 2.0 * kPi * stations.time(i) / kMinute;
      phasor.turn_to(turn * rpm);
      const double c = phasor.cosine(), s = phasor.sine();
      const double cosines[] = {c, (c - s) * (c + s)}, sines[] = {s, 2.0 * s * c};
      for (int h = 1; h <= kHarmonics; ++h) {
        double cosine = cosines[h - 1], sine = sines[h - 1];
        line(h * turn, cosine, sine);
        out.row(i).segment<4>(4 * (h - 1)) << cosine, sine, position * cosine, position * sine;
      }
    }
  }
};

}  // namespace

std::unique_ptr<Effect> make_spindle_runout(const Request& request) {
  request.accept_only({});
  return std::make_unique<SpindleRunout>();
}

}  // namespace slideway
