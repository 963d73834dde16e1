#include "structure.hpp"

#include <algorithm>
#include <cmath>

#include "slideway/identify/linear_algebra.hpp"
#include "slideway/signal/spectrum.hpp"
#include "slideway/signal/view.hpp"

namespace slideway {
namespace {

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

}  // namespace

Structure find_structure(const Model& model, const Whitened& data, const Linearisation& linear) {
  Structure found;
  Unnamed& out = found.description;
  for (ProcessVariable& variable : process_variables(model, linear)) {
    Process process = best_process(data, linear, variable);
    out.log_evidence.emplace_back(variable.symbol, process.log_evidence);
    if (!(process.log_evidence > found.process.log_evidence)) continue;
    out.clock = variable.symbol;
    out.correlation_length = process.length * variable.range;
    out.correlation_unit = variable.unit;
    found.columns = std::move(variable.cosines);
    found.process = std::move(process);
  }
  if (found.columns.empty()) {  // no variable makes anything beside the model
    for (const Observation* observation : linear.observations)
      found.columns.emplace_back(Eigen::MatrixXd::Zero(observation->values.size(), 1));
    found.process.sizes = found.process.coefficients = Eigen::VectorXd::Zero(1);
  }
  for (auto& [symbol, evidence] : out.log_evidence) evidence -= found.process.log_evidence;
  return found;
}

Unnamed describe(const Structure& found, const Whitened& data, const Linearisation& linear) {
  Unnamed out = found.description;
  double largest = -1.0;
  Eigen::VectorXd process = stack(
      linear, 1, [&](std::size_t i) { return found.columns[i] * found.process.coefficients; });
  const Eigen::MatrixXd span = model_span(linear);
  process -= span * least_squares(span, process).values;  // that part shows as parameters
  for (std::size_t i = 0; i < found.columns.size(); ++i) {
    const Observation& observation = *linear.observations[i];
    Eigen::VectorXd values = process.segment(data.first_row(i), data.count(i));
    const double standing_out = values.norm() / std::sqrt(static_cast<double>(values.size())) /
                                data.noise()[i].standard_deviation();
    if (standing_out <= largest) continue;
    largest = standing_out;
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
  return out;
}

}  // namespace slideway
