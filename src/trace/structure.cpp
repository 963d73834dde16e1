#include "structure.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "response.hpp"
#include "slideway/identify/linear_algebra.hpp"
#include "slideway/identify/uncertainty.hpp"
#include "slideway/signal/spectrum.hpp"
#include "slideway/signal/view.hpp"

namespace slideway {
namespace {

constexpr std::size_t kCurvePoints = 200;

/// Share of the square that is odd about the spindle axis, for a trace over (nearly) a diameter.
std::optional<double> odd_share(const Profile& profile, const Eigen::VectorXd& values) {
  const Setup& setup = profile.setup;
  const double left = setup.center_mm - setup.first_mm, right = setup.last_mm - setup.center_mm;
  if (setup.kind != Kind::face || std::min(left, right) < 0.8 * std::max(left, right))
    return std::nullopt;
  double odd = 0.0;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const double part = 0.5 * (values[i] - values[values.size() - 1 - i]);
    odd += part * part;
  }
  return odd / std::max(values.squaredNorm(), 1e-300);
}

/// Period with most power if it holds a third of it, over at least two cycles.
std::optional<double> dominant_period(const Profile& profile, const Eigen::VectorXd& values) {
  const std::vector<double> spectrum = power_spectrum(view(values));
  double best = 0.0, total = 0.0;
  std::size_t cycles = 0;
  for (std::size_t k = 1; k < spectrum.size(); ++k) {
    total += spectrum[k];
    if (spectrum[k] > best) best = spectrum[k], cycles = k;
  }
  if (cycles < 2 || best < total / 3.0) return std::nullopt;
  return (profile.setup.last_mm - profile.setup.first_mm) / static_cast<double>(cycles);
}

void locate(const Profile& profile, const std::vector<double>& positions,
            const Eigen::VectorXd& values, Unnamed& out) {
  Eigen::Index peak = 0;
  const double largest = values.cwiseAbs().maxCoeff(&peak);
  Eigen::Index first = peak, last = peak;
  while (first > 0 && std::abs(values[first - 1]) > 0.5 * largest) --first;
  while (last + 1 < values.size() && std::abs(values[last + 1]) > 0.5 * largest) ++last;
  out.profile = profile.name;
  out.from_mm = positions[static_cast<std::size_t>(first)];
  out.to_mm = positions[static_cast<std::size_t>(last)];
  out.odd_share = odd_share(profile, values);
  out.dominant_period_mm = dominant_period(profile, values);
}

/// Posterior standard deviations of a process at rows of its columns; see best_process().
Eigen::VectorXd deviations_of(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& white,
                              const Eigen::VectorXd& sizes) {
  const Eigen::MatrixXd scaled = white * sizes.asDiagonal();
  const Eigen::LLT<Eigen::MatrixXd> information(
      Eigen::MatrixXd::Identity(sizes.size(), sizes.size()) + scaled.transpose() * scaled);
  const Eigen::MatrixXd rows = columns * sizes.asDiagonal();
  return information.matrixL().solve(rows.transpose()).colwise().norm().transpose();
}

/// Signals in the low bands without what they put into the model and the levelling.
Eigen::MatrixXd beside_model(const Solution& fit, Eigen::MatrixXd signals) {
  signals -= stacked_model(fit.linear) * response(fit, signals);
  Eigen::Index row = 0;
  for (const Observation* observation : fit.linear.observations) {
    const Eigen::Index count = observation->values.size();
    signals.middleRows(row, count) = levelled(*observation, signals.middleRows(row, count));
    row += count;
  }
  return signals;
}

/// The values of one profile over the variable, one half of a diameter, without what is left out.
void set_curve(const Eigen::VectorXd& readings, const Eigen::VectorXd& values,
               const Eigen::VectorXd& deviations, const Observation& observation, Unnamed& out) {
  const Clock& clock = clock_of(out);
  const Setup& setup = observation.profile->setup;
  const bool both_halves = setup.kind != Kind::face || clock.symbol == std::string("X");
  const std::vector<double> positions =
      observation.low_band.positions(observation.profile->positions);
  const std::vector<Eigen::Index> left_out = left_out_values(observation);
  std::vector<Eigen::Index> order;
  for (Eigen::Index i = 0; i < readings.size(); ++i) {
    if (std::ranges::count(left_out, i) > 0) continue;
    if (both_halves || setup.last_mm <= setup.center_mm ||
        positions[static_cast<std::size_t>(i)] >= setup.center_mm)
      order.push_back(i);
  }
  std::ranges::stable_sort(order, {}, [&](Eigen::Index i) { return readings[i]; });
  const bool slope = setup.quantity == Quantity::slope;
  const double unit = low_band_scale(observation) * (slope ? kMicroradian : kMicrometre);
  out.curve = {clock.name, clock.unit, slope ? MicroUnit::urad : MicroUnit::um, {}, {}, {}};
  const std::size_t stride = std::max<std::size_t>(1, order.size() / kCurvePoints);
  for (std::size_t j = 0; j < order.size(); j += stride) {
    out.curve.at.push_back(readings[order[j]] / clock.per_unit);
    out.curve.residual.push_back(values[order[j]] / unit);
    out.curve.expanded_uncertainty.push_back(coverage_factor(std::nullopt) * deviations[order[j]] /
                                             unit);
  }
}

}  // namespace

Structure find_structure(const Model& model, const Whitened& data, const Linearisation& linear) {
  Structure found;
  Unnamed& out = found.description;
  std::optional<ProcessVariable> best;
  std::vector<ProcessVariable> variables = process_variables(model, linear);
  std::vector<Process> processes = best_processes(data, variables);
  for (std::size_t v = 0; v < variables.size(); ++v) {
    ProcessVariable& variable = variables[v];
    Process& process = processes[v];
    if (process.sizes.size() == 0) continue;  // it makes nothing beside the model
    out.log_evidence.emplace_back(variable.symbol, process.log_evidence);
    if (!(process.log_evidence > found.process.log_evidence)) continue;
    out.clock = variable.symbol;
    out.correlation_length = process.length * variable.range;
    out.correlation_unit = variable.unit;
    best = std::move(variable);
    found.process = std::move(process);
  }
  if (best) {
    found.columns = best->columns(linear);
  } else {  // no variable makes anything beside the model
    for (const Observation* observation : linear.observations)
      found.columns.emplace_back(Eigen::MatrixXd::Zero(observation->values.size(), 1));
    found.process.sizes = found.process.coefficients = Eigen::VectorXd::Zero(1);
  }
  for (auto& [symbol, evidence] : out.log_evidence) evidence -= found.process.log_evidence;
  return found;
}

double shared_evidence(const FittedModel& fitted) {
  const Linearisation& linear = fitted.fit.linear;
  const auto faces = std::ranges::count(linear.observations, Kind::face,
                                        [](const auto* each) { return each->profile->setup.kind; });
  if (faces < 2 || fitted.fit.uncertainty.inflation > 1.0) return 0.0;
  const Whitened data(linear, fitted.fit.noise);
  double out = 0.0;
  for (const Process& process : best_processes(data, shared_variables(fitted.model, linear)))
    out = std::max(out, process.log_evidence);
  return out;
}

const Clock& clock_of(const Unnamed& unnamed) {
  static constexpr Clock kClocks[] = {
      {"r", "x", "mm", 1.0, IndependentVariable::slide},
      {"t", "t", "s", 1.0, IndependentVariable::time},
      {"s", "s", "m", 1e3, IndependentVariable::distance},
      {"t_read", "t_read", "s", 1.0, IndependentVariable::reading_time},
      {"X", "X", "mm", 1.0, IndependentVariable::trace}};
  const auto found = std::ranges::find(kClocks, unnamed.clock, &Clock::symbol);
  return found == std::end(kClocks) ? std::end(kClocks)[-1] : *found;
}

Unnamed describe(const FittedModel& fitted, const Structure& found, const Whitened& data,
                 const Eigen::VectorXd& wave) {
  const Linearisation& linear = fitted.fit.linear;
  Unnamed out = found.description;
  out.has_folded_wave = wave.size() > 0;
  double largest = -1.0;
  std::size_t which = 0;
  Eigen::MatrixXd columns =
      stack(linear, found.columns.front().cols(), [&](std::size_t i) { return found.columns[i]; });
  const Eigen::MatrixXd white = data.outside(columns);
  columns = beside_model(fitted.fit, std::move(columns));  // the other part shows as parameters
  const Eigen::VectorXd process = columns * found.process.coefficients;
  for (std::size_t i = 0; i < found.columns.size(); ++i) {
    const Observation& observation = *linear.observations[i];
    Eigen::VectorXd values = process.segment(data.first_row(i), data.count(i));
    if (out.has_folded_wave) values += wave.segment(data.first_row(i), data.count(i));
    const double standing_out = values.norm() / std::sqrt(static_cast<double>(values.size())) /
                                data.noise()[i].standard_deviation();
    if (standing_out <= largest) continue;
    largest = standing_out;
    which = i;
    const bool slope = observation.profile->setup.quantity == Quantity::slope;
    values /= low_band_scale(observation) * (slope ? kMicroradian : kMicrometre);
    const double rms = values.norm() / std::sqrt(static_cast<double>(values.size()));
    const double pv = values.maxCoeff() - values.minCoeff();
    out.rms_um = slope ? std::nullopt : std::optional(rms);
    out.pv_um = slope ? std::nullopt : std::optional(pv);
    out.rms_urad = slope ? std::optional(rms) : std::nullopt;
    out.pv_urad = slope ? std::optional(pv) : std::nullopt;
    locate(*observation.profile, observation.low_band.positions(observation.profile->positions),
           values, out);
  }
  const Eigen::VectorXd deviations = deviations_of(
      columns.middleRows(data.first_row(which), data.count(which)), white, found.process.sizes);
  set_curve(readings_of(fitted.model, linear, out.clock)[which],
            process.segment(data.first_row(which), data.count(which)), deviations,
            *linear.observations[which], out);
  return out;
}

}  // namespace slideway
