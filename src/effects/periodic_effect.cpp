#include "periodic_effect.hpp"

#include <cmath>

#include "linear_effect.hpp"
#include "phasor.hpp"

namespace slideway {
namespace {

constexpr double kTurn = 2.0 * kPi;

// Cosine and sine of 2π cycles q(i).
template <typename Reading>
void fill(double cycles, const Reading& q, Eigen::Ref<Eigen::MatrixXd> out) {
  Phasor phasor;
  for (Eigen::Index i = 0; i < out.rows(); ++i) {
    phasor.turn_to(kTurn * cycles * q(i));
    out(i, 0) = phasor.cosine();
    out(i, 1) = phasor.sine();
  }
}

}  // namespace

PeriodicEffect::PeriodicEffect(PeriodicSpec spec)
    : spec_(std::move(spec)),
      parameters_{{"amplitude_um", "A", "µm", 0.1}, spec_.rate, {"phase_rad", "φ", "rad", 1.0}},
      shapes_{{.parameter = 1, .logarithmic = spec_.rate_is_period, .stepwise = false}} {}

std::pair<double, double> PeriodicEffect::search_range(int /*shape*/,
                                                       const Stations& stations) const {
  return within_bounds(spec_.range(stations), spec_.rate);
}

double PeriodicEffect::resolution(int /*shape*/, double value, const Stations& stations) const {
  const double cycles = kCyclesPerStep / range_of(stations, spec_.reading).extent();
  return spec_.rate_is_period ? value * value * cycles : cycles;
}

bool PeriodicEffect::applies_to(const Setup& setup) const { return spec_.applies_to(setup); }

double PeriodicEffect::cycles(std::span<const double> shape) const {
  return spec_.rate_is_period ? 1.0 / shape[0] : shape[0];
}

void PeriodicEffect::columns(const Stations& stations, std::span<const double> shape,
                             Eigen::Ref<Eigen::MatrixXd> out) const {
  if (!applies_to(stations.setup())) return void(out.setZero());
  fill(
      cycles(shape), [&](Eigen::Index i) { return spec_.reading(stations, i); }, out);
}

void PeriodicEffect::columns_of_shapes(const Stations& stations,
                                       std::span<const std::vector<double>> shapes,
                                       Eigen::Ref<Eigen::MatrixXd> out) const {
  if (!applies_to(stations.setup())) return void(out.setZero());
  const Eigen::VectorXd q = readings(stations, spec_.reading);
  for (std::size_t s = 0; s < shapes.size(); ++s)
    fill(cycles(shapes[s]), q, out.middleCols(static_cast<Eigen::Index>(2 * s), 2));
}

void PeriodicEffect::derivatives(const Stations& stations, std::span<const double> shape,
                                 Eigen::Ref<Eigen::MatrixXd> out) const {
  if (!applies_to(stations.setup())) return void(out.setZero());
  const double rate = cycles(shape), rate_slope = spec_.rate_is_period ? -rate * rate : 1.0;
  Phasor phasor;
  for (Eigen::Index i = 0; i < stations.size(); ++i) {
    const double q = spec_.reading(stations, i);
    phasor.turn_to(kTurn * rate * q);
    const double angle_slope = kTurn * rate_slope * q;
    out(i, 0) = -phasor.sine() * angle_slope;
    out(i, 1) = phasor.cosine() * angle_slope;
  }
}

std::vector<LineBand> PeriodicEffect::lines(const Stations& stations,
                                            std::span<const double> shape) const {
  const double count = cycles(shape) * range_of(stations, spec_.reading).extent();
  return {{count, count}};
}

ParameterValues PeriodicEffect::parameter_values(const Eigen::VectorXd& amplitudes,
                                                 std::span<const double> shape) const {
  const double c = amplitudes[0];
  const double s = amplitudes[1];
  const double modulus = std::hypot(c, s);
  ParameterValues result;
  result.values.resize(3);
  result.values << modulus / kMicrometre, shape[0], modulus > 0.0 ? std::atan2(-s, c) : 0.0;
  result.jacobian = Eigen::MatrixXd::Zero(3, 3);
  result.jacobian(1, 2) = 1.0;
  // At zero the modulus grows alike in every direction, and nothing is known of the phase.
  const double cosine = modulus > 0.0 ? c / modulus : 1.0;
  const double sine = modulus > 0.0 ? s / modulus : 0.0;
  result.jacobian.row(0) << cosine / kMicrometre, sine / kMicrometre, 0.0;
  if (modulus > 0.0) result.jacobian.row(2) << sine / modulus, -cosine / modulus, 0.0;
  return result;
}

Eigen::VectorXd PeriodicEffect::from_parameters(const Eigen::VectorXd& values) const {
  const double modulus = values[0] * kMicrometre;
  Eigen::VectorXd result(3);
  result << modulus * std::cos(values[2]), -modulus * std::sin(values[2]), values[1];
  return result;
}

std::pair<double, double> period_range(const Stations& stations, VariableReading reading) {
  const VariableRange range = range_of(stations, reading);
  return {4.0 * range.step, 2.0 * range.extent()};
}

}  // namespace slideway
