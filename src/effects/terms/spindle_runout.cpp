#include <algorithm>
#include <array>
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
constexpr double kRpmReach = 0.02;   // share of the nominal speed that is searched
constexpr int kMostAngleDegree = 5;  // of the angle as a polynomial in time
constexpr double kMostTurns = 1e3;   // of a drift

std::vector<Parameter> runout_parameters(int degree) {
  std::vector<Parameter> list;
  for (int h = 1; h <= kHarmonics; ++h) {
    const std::string order = std::to_string(h);
    list.push_back({"cos" + order + "_um", "a_" + order, "µm", 0.1});
    list.push_back({"sin" + order + "_um", "b_" + order, "µm", 0.1});
    list.push_back({"cos" + order + "_growth_um", "a'_" + order, "µm", 0.1});
    list.push_back({"sin" + order + "_growth_um", "b'_" + order, "µm", 0.1});
  }
  list.push_back({"rpm", "n", "1/min", 1.0, 1e-3, 1e6});
  for (int d = 2; d <= degree; ++d) {
    const std::string order = std::to_string(d);
    list.push_back({"drift" + order + "_turns", "q_" + order, "1", 0.1, -kMostTurns, kMostTurns});
  }
  return list;
}

std::vector<Shape> runout_shapes(int degree) {
  std::vector<Shape> list{{.parameter = kAmplitudes}};
  for (int d = 2; d <= degree; ++d)
    list.push_back({.parameter = kAmplitudes + d - 1, .higher_order = true});
  return list;
}

Description describe_spindle_runout() {
  return {
      .name = "spindle_runout",
      .plain_name = "spindle run-out",
      .standard_name =
          "synchronous axial and tilt error motion, run-out of a test bar "
          "(ISO 230-7)",
      .formula =
          "Σ_h (a_h + a'_h ξ) cos 2πhκ + (b_h + b'_h ξ) sin 2πhκ, h = 1, 2; ξ the position from "
          "-1 to 1; κ the angle of the spindle in turns, t n/60 + Σ_d q_d P_d(τ), d = 2 to degree "
          "(1 if not given: constant speed), P_d of Legendre, τ the time from -1 to 1 over a "
          "reading along the slide; n the speed of readings whose spindle_rpm is near it, others "
          "keep to theirs",
      .source = "ISO 230-7",
      .cause =
          "eccentric and tilted axis: one and two lines per turn that grow along the "
          "reading; a spindle without a fixed gear runs at a speed that drifts",
      .typical =
          "5 to 50 nm (aerostatic spindle), 0.1 to 10 µm for a test bar read along the "
          "slide",
      .variable = IndependentVariable::revolution,
      .confounded_with =
          "slide_periodic at one feed; on a face one groove per turn samples it at "
          "a fixed angle, so that its lines become constants and slow drifts; a drift of the "
          "speed looks like further lines beside those of the turn, time_periodic or "
          "revolution_periodic",
      .confounded_effects = {"slide_periodic", "time_periodic", "revolution_periodic"},
      .separated_by =
          "a second feed or spindle speed: the lines stay at whole orders per turn; the angle of "
          "the spindle read beside the height"};
}

// Position from -1 to 1: over the cut radius of a face, over the trace of a slide reading.
double scaled_position(const Stations& stations, Eigen::Index i) {
  const Setup& setup = stations.setup();
  const bool is_face = setup.kind == Kind::face;
  const double low = is_face ? 0.0 : setup.first_mm;
  const double high = is_face ? *setup.cut_radius_mm : setup.last_mm;
  return high > low ? 2.0 * (stations.radius(i) - low) / (high - low) - 1.0 : 0.0;
}

using Legendre = std::array<double, kMostAngleDegree + 1>;

/// P_0 to P_degree at τ, the time of a reading along the slide from -1 to 1.
/// Recurrence of Abramowitz and Stegun, Table 22.7.
Legendre legendre(const Stations& stations, double position) {
  static constexpr double kRise[] = {1.0, 3.0 / 2.0, 5.0 / 3.0, 7.0 / 4.0, 9.0 / 5.0};
  static constexpr double kFall[] = {0.0, 1.0 / 2.0, 2.0 / 3.0, 3.0 / 4.0, 4.0 / 5.0};
  const bool back = stations.setup().cut_direction == CutDirection::inward;
  Legendre p{1.0, back ? -position : position};
  for (int d = 1; d < kMostAngleDegree; ++d)
    p[d + 1] = kRise[d] * p[1] * p[d] - kFall[d] * p[d - 1];
  return p;
}

/// Whether a speed that is searched is that of this reading.
bool is_speed_of(const Setup& setup, double rpm) {
  return std::abs(rpm - *setup.spindle_rpm) < 2.0 * kRpmReach * *setup.spindle_rpm;
}

class SpindleRunout : public LinearEffect {
 public:
  explicit SpindleRunout(int degree)
      : LinearEffect(describe_spindle_runout(), runout_parameters(degree),
                     diagonal_map(kAmplitudes, kMicrometre), runout_shapes(degree)) {}

  [[nodiscard]] std::pair<double, double> search_range(int shape,
                                                       const Stations& stations) const override {
    if (shape > 0) return {-kMostTurns, kMostTurns};
    const double rpm = *stations.setup().spindle_rpm;
    // One groove per turn samples a face: another speed would be another alias, any slow line.
    const double reach = stations.setup().kind == Kind::face ? kRpmNoReach : kRpmReach;
    return {rpm * (1.0 - reach), rpm * (1.0 + reach)};
  }

  [[nodiscard]] double resolution(int shape, double /*value*/,
                                  const Stations& stations) const override {
    if (shape > 0) return kCyclesPerStep / kHarmonics;
    return kCyclesPerStep / kHarmonics * kMinute / range_of(stations, time_of).extent();
  }

  // On a face one groove per turn samples it: a drift of the speed moves the grooves.
  [[nodiscard]] bool applies_to(const Setup& setup) const override {
    return is_height(setup) && (shapes().size() == 1 || setup.kind == Kind::slide);
  }

  [[nodiscard]] std::vector<std::string> lacking_together(
      const std::vector<const Setup*>& setups) const override {
    const bool along_slide =
        std::ranges::any_of(setups, [](const Setup* setup) { return setup->kind == Kind::slide; });
    if (along_slide) return {};
    return {"a reading along the slide: on a face every groove meets it at one angle"};
  }

  [[nodiscard]] std::vector<std::string> lacking(const Setup& setup) const override {
    std::vector<std::string> keys = LinearEffect::lacking(setup);
    if (setup.kind == Kind::face && !setup.cut_radius_mm) keys.emplace_back("cut_radius_mm");
    return keys;
  }

  void columns(const Stations& stations, std::span<const double> shape,
               Eigen::Ref<Eigen::MatrixXd> out) const override {
    at_each_station(stations, shape, out, [&](Eigen::Index i, const Turned& at) {
      for (int h = 1; h <= kHarmonics; ++h) {
        const double cosine = at.cosines[h - 1], sine = at.sines[h - 1];
        out.row(i).segment<4>(4 * (h - 1)) << cosine, sine, at.position * cosine,
            at.position * sine;
      }
    });
  }

  void derivatives(const Stations& stations, std::span<const double> shape,
                   Eigen::Ref<Eigen::MatrixXd> out) const override {
    const bool moves = is_speed_of(stations.setup(), shape[0]);
    at_each_station(stations, shape, out, [&](Eigen::Index i, const Turned& at) {
      for (std::size_t s = 0; s < shape.size(); ++s) {
        const double own = moves ? stations.time(i) / kMinute : 0.0;
        const double turns = s == 0 ? own : at.legendre[s + 1];
        for (int h = 1; h <= kHarmonics; ++h) {
          const double angle = 2.0 * kPi * h * turns;
          const double cosine = -angle * at.sines[h - 1], sine = angle * at.cosines[h - 1];
          const auto first = static_cast<Eigen::Index>(s) * kAmplitudes + 4 * (h - 1);
          out.row(i).segment<4>(first) << cosine, sine, at.position * cosine, at.position * sine;
        }
      }
    });
  }

  // The rate of the angle from one end of the drift to the other.
  [[nodiscard]] std::vector<LineBand> lines(const Stations& stations,
                                            std::span<const double> shape) const override {
    const VariableRange time = range_of(stations, time_of);
    double low = INFINITY, high = -INFINITY;
    const auto turn_at = [&](Eigen::Index i) {
      return turn(stations, shape, i, polynomials(stations, shape, scaled_position(stations, i)));
    };
    double before = turn_at(0);
    for (Eigen::Index i = 1; i < stations.size(); ++i) {
      const double passed = stations.time(i) - stations.time(i - 1);
      const double now = turn_at(i);
      const double rate = (now - before) / passed;
      before = now;
      low = std::min(low, rate * time.extent());
      high = std::max(high, rate * time.extent());
    }
    std::vector<LineBand> out;
    for (int h = 1; h <= kHarmonics; ++h) out.push_back({h * low, h * high});
    return out;
  }

  // A drift of the speed, degree by degree: the search takes the one that pays.
  [[nodiscard]] std::vector<EffectOptions> hypotheses(
      const EffectOptions* declared) const override {
    EffectOptions options = declared ? *declared : EffectOptions{};
    std::vector<EffectOptions> out;
    for (int degree = declared ? options.degree.value_or(1) + 1 : 1; degree <= kMostAngleDegree;
         ++degree) {
      options.degree = degree;
      out.push_back(options);
    }
    return out;
  }

  [[nodiscard]] double size(const Eigen::VectorXd& values) const override {
    return values.head(kAmplitudes).norm();
  }

 private:
  // Of a drift; at a constant speed nothing asks for them.
  static Legendre polynomials(const Stations& stations, std::span<const double> shape,
                              double position) {
    return shape.size() == 1 ? Legendre{} : legendre(stations, position);
  }

  // κ: the angle of the spindle in turns.
  static double turn(const Stations& stations, std::span<const double> shape, Eigen::Index i,
                     const Legendre& p) {
    const Setup& setup = stations.setup();
    const double rpm = is_speed_of(setup, shape[0]) ? shape[0] : *setup.spindle_rpm;
    double turns = stations.time(i) * rpm / kMinute;
    for (std::size_t d = 1; d < shape.size(); ++d) turns += shape[d] * p[d + 1];
    return turns;
  }

  // A station and the angle of the spindle there.
  struct Turned {
    double position = 0.0;  // from -1 to 1
    Legendre legendre{};
    std::array<double, kHarmonics> cosines{}, sines{};  // of the angle, harmonic by harmonic
  };

  // Calls fill(i, Turned) for each station; where the effect does not apply, `out` is 0.
  template <typename Fill>
  void at_each_station(const Stations& stations, std::span<const double> shape,
                       Eigen::Ref<Eigen::MatrixXd> out, Fill&& fill) const {
    if (!applies_to(stations.setup())) return void(out.setZero());
    Phasor phasor;
    for (Eigen::Index i = 0; i < stations.size(); ++i) {
      const double position = scaled_position(stations, i);
      const Legendre p = polynomials(stations, shape, position);
      phasor.turn_to(2.0 * kPi * turn(stations, shape, i, p));
      const double c = phasor.cosine(), s = phasor.sine();
      fill(i, Turned{position, p, {c, (c - s) * (c + s)}, {s, 2.0 * s * c}});
    }
  }
};

}  // namespace

std::unique_ptr<Effect> make_spindle_runout(const Request& request) {
  request.accept_only({"degree"});
  return std::make_unique<SpindleRunout>(
      request.options.degree ? request.degree(1, kMostAngleDegree) : 1);
}

}  // namespace slideway
