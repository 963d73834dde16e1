#include "slideway/identify/noise_model.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "kept_values.hpp"
#include "noise_bounds.hpp"
#include "outstanding_line.hpp"
#include "repeats.hpp"
#include "shared_texture.hpp"
#include "slideway/base/parallel.hpp"
#include "slideway/base/statistics.hpp"
#include "slideway/base/units.hpp"
#include "slideway/identify/column_places.hpp"
#include "slideway/identify/departures.hpp"
#include "slideway/identify/identifiability.hpp"
#include "slideway/identify/lack_of_fit.hpp"
#include "slideway/identify/linear_algebra.hpp"
#include "whole_residuals.hpp"

namespace slideway {
namespace {

constexpr Eigen::Index kLeastSpare = 6;  // values beyond what is free, else the whole residual
constexpr double kSameStep = 0.1;        // relative; values as far apart have the same memory

/// First low-band value of the near half of a diameter; 0 where there is no far one.
Eigen::Index near_half(const Observation& observation) {
  const Setup& setup = observation.profile->setup;
  if (setup.kind != Kind::face) return 0;
  const std::vector<double> positions =
      observation.low_band.positions(observation.profile->positions);
  return std::ranges::lower_bound(positions, setup.center_mm) - positions.begin();
}

/// An orthonormal basis of what the columns add to two others.
Eigen::MatrixXd beyond(const Eigen::MatrixXd& basis, const Eigen::MatrixXd& more,
                       Eigen::MatrixXd columns) {
  constexpr double kNew = 1e-6;  // of a column: less is rounding
  const Eigen::RowVectorXd whole = columns.colwise().norm();
  for (int pass = 0; pass < 2; ++pass)
    for (const Eigen::MatrixXd* taken : {&basis, &more}) project_out(*taken, columns);
  for (Eigen::Index j = 0; j < columns.cols(); ++j)
    if (columns.col(j).norm() <= kNew * whole[j]) columns.col(j).setZero();
  return orthonormal(std::move(columns));
}

/// What the basis leaves of the residual, without the columns and without lines that stand out of
/// the spectrum. Those are not left free as the basis is: noise could then be put into the gaps
/// they make in the spectrum, where nobody would miss it. What they take of the noise's size is
/// given back. Zeros if too little is left to know a noise by.
/// @param middle  as outstanding_line()
Eigen::VectorXd without_lines(const Eigen::VectorXd& residual, const Eigen::MatrixXd& basis,
                              const Eigen::MatrixXd& columns, Eigen::Index middle,
                              const Gates& gates) {
  const Eigen::Index n = residual.size(), seen = n - basis.cols();
  Eigen::MatrixXd known(n, 0);
  Eigen::VectorXd rest = residual - basis * (basis.transpose() * residual);
  const auto take_out = [&](const Eigen::MatrixXd& more) {
    const Eigen::MatrixXd own = beyond(basis, known, more);
    rest -= own * (own.transpose() * rest);
    append_columns(known, own);
  };
  take_out(columns);
  for (int found = 0; found < static_cast<int>(gates.most_lines); ++found) {
    const double frequency = outstanding_line(rest, middle, gates.false_line);
    if (frequency == 0.0) break;
    take_out(line_on(n, middle, frequency));
  }
  const Eigen::Index left = seen - known.cols();
  if (left < kLeastSpare) return Eigen::VectorXd::Zero(n);
  return rest * std::sqrt(static_cast<double>(seen) / static_cast<double>(left));
}

/// Columns that lie in the basis for the most part, and those that do not.
std::pair<Eigen::MatrixXd, Eigen::MatrixXd> parted(const Eigen::MatrixXd& basis,
                                                   const Eigen::MatrixXd& columns) {
  std::array<std::vector<Eigen::Index>, 2> parts;
  for (Eigen::Index j = 0; j < columns.cols(); ++j) {
    const double inside = (basis.transpose() * columns.col(j)).squaredNorm();
    parts[inside < 0.5 * columns.col(j).squaredNorm() ? 1 : 0].push_back(j);
  }
  return {columns(Eigen::all, parts[0]), columns(Eigen::all, parts[1])};
}

/// What is left of a profile beside the slow band, or nothing if that is too little.
std::optional<LinearProfile> fine_band(const Linearisation& linear, std::size_t i,
                                       const Gates& gates,
                                       const std::vector<Eigen::MatrixXd>& suspect) {
  const Observation& observation = *linear.observations[i];
  const Eigen::Index n = observation.values.size();
  const Eigen::MatrixXd none(n, 0);
  Eigen::MatrixXd basis = slow_cosines(n, slow_cosine_count(n, gates)), columns = linear.columns[i];
  basis.colwise().normalize();  // orthogonal as they are
  append_columns(basis, beyond(basis, none, observation.nuisances));
  if (!suspect.empty()) append_columns(columns, suspect[i]);
  const auto [slow, lines] = parted(basis, columns);
  append_columns(basis, beyond(basis, none, slow));
  if (n - basis.cols() < kLeastSpare) return std::nullopt;
  Eigen::VectorXd rest =
      without_lines(linear.residuals[i], basis, lines, near_half(observation), gates);
  project_out(basis, rest);
  if (is_rounding(rest, observation.values)) return std::nullopt;
  return LinearProfile{std::move(basis), Eigen::MatrixXd(n, 0), std::move(rest),
                       observation.profile->standard_uncertainty};
}

/// What distinguishes instruments and tools, as far as profiles tell: kind, quantity and low band.
bool share_memory(const Observation& a, const Observation& b) {
  const auto step = [](const Observation& each) {
    return (each.profile->setup.last_mm - each.profile->setup.first_mm) /
           static_cast<double>(each.values.size());
  };
  const LowBandOptions &s = a.low_band.options(), &t = b.low_band.options();
  return a.profile->setup.kind == b.profile->setup.kind &&
         a.profile->setup.quantity == b.profile->setup.quantity &&
         a.profile->instrument == b.profile->instrument && s.wavelet == t.wavelet &&
         s.level == t.level && std::abs(step(a) - step(b)) <= kSameStep * step(a);
}

/// Index of the first profile that each shares its memory with.
std::vector<std::size_t> pools_of(const Linearisation& linear) {
  std::vector<std::size_t> out;
  for (const Observation* observation : linear.observations) {
    std::size_t first = 0;
    while (first < out.size() && !share_memory(*linear.observations[first], *observation)) ++first;
    out.push_back(first);
  }
  return out;
}

/// One estimate of the noise, from a part of some residuals.
struct PartialEstimate {
  std::vector<std::size_t> which;
  std::vector<LinearProfile> profiles;

  void add(std::size_t i, const std::optional<LinearProfile>& profile, const Observation& of,
           std::size_t pool) {
    if (!profile) return;
    which.push_back(i);
    profiles.push_back(kept(*profile, of));
    profiles.back().pool = pool;
  }
};

/// estimate_noise(), each noise within what is possible for its values.
std::vector<Noise> estimated(const PartialEstimate& part, const Linearisation& linear,
                             const Eigen::MatrixXd& priors, const Gates& gates) {
  std::vector<Noise> out = estimate_noise(part.profiles, priors, gates);
  for (std::size_t k = 0; k < out.size(); ++k)
    out[k] = bounded(out[k], *linear.observations[part.which[k]]->profile,
                     linear.observations[part.which[k]]->values);
  return out;
}

/// Noise of the profiles named, from their whole residuals, the model left free.
void from_whole_residuals(const Linearisation& linear, const std::vector<std::size_t>& which,
                          const Gates& gates, std::vector<Noise>& noise) {
  const WholeResiduals whole(linear, noise, gates);
  const std::vector<std::size_t> pools = pools_of(linear);
  PartialEstimate part;
  for (const std::size_t i : which) {
    const Observation& observation = *linear.observations[i];
    const Eigen::VectorXd& residual = linear.residuals[i];
    if (is_rounding(residual, observation.values))
      noise[i] =
          rounding_noise(observation, residual, whole.determined() + observation.nuisances.cols());
    else
      part.add(i, whole.of(i), observation, pools[i]);
  }
  std::vector<Noise> found = estimated(part, linear, whole.priors(), gates);
  for (std::size_t i = 0; i < found.size(); ++i) noise[part.which[i]] = std::move(found[i]);
}

/// One profile with the residual that a fit of it alone, all weights equal, leaves.
Linearisation fitted_alone(const Linearisation& all, std::size_t i) {
  const Eigen::MatrixXd& nuisances = all.observations[i]->nuisances;
  Eigen::MatrixXd free(nuisances.rows(), nuisances.cols() + all.columns[i].cols());
  free << nuisances, all.columns[i];
  Linearisation out;
  out.observations = {all.observations[i]};
  out.columns = {all.columns[i]};
  out.residuals = {all.residuals[i] - free * least_squares(free, all.residuals[i]).values};
  out.prior_rows = all.prior_rows;
  out.prior_residuals = Eigen::VectorXd::Zero(all.prior_residuals.size());
  return out;
}

/// What a profile fitted alone leaves of itself, or nothing where that is no value or rounding.
std::optional<LinearProfile> beside_all(const Linearisation& alone,
                                        const Observation& observation) {
  Eigen::MatrixXd free = observation.nuisances;
  append_columns(free, alone.columns[0]);
  Eigen::MatrixXd basis = orthonormal(std::move(free));
  const Eigen::Index n = observation.values.size();
  if (basis.cols() >= n || is_rounding(alone.residuals[0], observation.values)) return std::nullopt;
  return LinearProfile{std::move(basis), Eigen::MatrixXd(n, 0), alone.residuals[0],
                       observation.profile->standard_uncertainty};
}

void add_errors_of_causes(const Linearisation& linear, std::vector<Noise>& noise) {
  for (std::size_t i = 0; i < linear.errors_of_causes.size(); ++i)
    noise[i].add_known(linear.errors_of_causes[i]);
}

}  // namespace

Eigen::Index slow_cosine_count(Eigen::Index n, const Gates& gates) {
  return std::min(static_cast<Eigen::Index>(gates.slow_cosines),
                  static_cast<Eigen::Index>(static_cast<double>(n) / gates.values_per_cosine));
}

Eigen::MatrixXd slow_cosines(Eigen::Index n, Eigen::Index count) {
  Eigen::MatrixXd out(n, count);
  if (count == 0) return out;
  const Eigen::ArrayXd angles = kPi / static_cast<double>(n) *
                                Eigen::ArrayXd::LinSpaced(n, 0.5, static_cast<double>(n) - 0.5);
  out.col(0) = angles.cos();
  const Eigen::ArrayXd twice = 2.0 * out.col(0).array();
  for (Eigen::Index j = 1; j < count; ++j) {  // cos((j + 1) φ) = 2 cos φ cos(j φ) - cos((j - 1) φ)
    out.col(j) = twice * out.col(j - 1).array();
    if (j > 1)
      out.col(j) -= out.col(j - 2);
    else
      out.col(j).array() -= 1.0;
  }
  return out;
}

std::vector<Noise> first_noise(const Model& model) {
  std::vector<Noise> out;
  for (const Observation* observation : fitted_observations(model)) {
    const Eigen::VectorXd rest =
        observation->values -
        observation->nuisances * fitted_nuisances(*observation, observation->values);
    const std::optional<double>& declared = observation->profile->standard_uncertainty;
    Noise& noise = out.emplace_back(
        Noise::white(declared.value_or(rms(rest) > 0.0 ? rms(rest) : 1.0), rest.size()));
    noise.declared = declared.has_value();
  }
  return out;
}

std::vector<Noise> noise_beside(const Linearisation& linear, const Gates& gates,
                                std::vector<Eigen::MatrixXd> suspect) {
  const std::size_t count = linear.observations.size();
  if (!linear.errors_of_causes.empty()) suspect.resize(count);
  for (std::size_t i = 0; i < linear.errors_of_causes.size(); ++i)
    append_columns(suspect[i], directions_of_causes(linear, i));
  std::vector<std::optional<LinearProfile>> fine(count), repeats(count);
  const std::vector<OddRepeat> odd = odd_repeats(linear, gates);
  parallel_for(count, [&](std::size_t i) {
    fine[i] = fine_band(linear, i, gates, suspect);
    repeats[i] = deviation_from_repeats(linear, i, odd, gates, suspect);
  });
  // Noises from different parts of the residuals have no memory in common.
  const std::vector<std::size_t> pools = pools_of(linear);
  PartialEstimate beside, instrument;
  for (std::size_t i = 0; i < count; ++i) {
    beside.add(i, fine[i], *linear.observations[i], pools[i]);
    instrument.add(i, repeats[i], *linear.observations[i], pools[i] + count);
  }
  std::vector<Noise> out(count);
  std::vector<std::size_t> whole;
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = Noise::white(std::max(rms(linear.residuals[i]), 1e-300), linear.residuals[i].size());
    if (!fine[i] && !repeats[i]) whole.push_back(i);
  }
  if (!whole.empty()) from_whole_residuals(linear, whole, gates, out);
  for (const std::size_t i : whole) out[i].pool += 2 * count;
  const Eigen::MatrixXd no_priors(0, 0);
  std::vector<Noise> found = estimated(beside, linear, no_priors, gates);
  for (std::size_t k = 0; k < found.size(); ++k) out[beside.which[k]] = std::move(found[k]);
  weigh_shared_texture(linear, fine, suspect, gates, out);
  // Repeats hold no texture, and the fine band no slow noise: the larger in the long run.
  found = estimated(instrument, linear, no_priors, gates);
  for (std::size_t k = 0; k < found.size(); ++k) {
    Noise& noise = out[instrument.which[k]];
    if (!fine[instrument.which[k]] || found[k].long_run_deviation() > noise.long_run_deviation())
      noise = std::move(found[k]);
  }
  add_errors_of_causes(linear, out);
  return out;
}

std::vector<Noise> noise_of_each(const Linearisation& all, const std::vector<Noise>& joint,
                                 const Gates& gates) {
  if (all.curve_rows > 0) return joint;
  const std::size_t count = all.observations.size();
  const std::vector<std::size_t> pools = pools_of(all);
  std::vector<Noise> out(count);
  std::vector<Linearisation> alone(count);
  std::vector<std::optional<LinearProfile>> left(count);
  parallel_for(count, [&](std::size_t i) {
    alone[i] = fitted_alone(all, i);
    left[i] = fine_band(alone[i], 0, gates, {});
    if (!left[i]) left[i] = beside_all(alone[i], *all.observations[i]);
  });
  PartialEstimate beside;
  for (std::size_t i = 0; i < count; ++i) {
    beside.add(i, left[i], *all.observations[i], pools[i]);
    if (!left[i]) out[i] = joint[i];
  }
  const std::vector<Noise> found = estimated(beside, all, Eigen::MatrixXd(0, 0), gates);
  for (std::size_t k = 0; k < found.size(); ++k) {
    const std::size_t i = beside.which[k];
    out[i] = found[k];
    weigh_halves(alone[i], left[i], gates, out[i]);
  }
  return out;
}

std::vector<Noise> noise_if_complete(const Linearisation& linear, std::vector<Noise> beside,
                                     const Gates& gates) {
  std::vector<std::size_t> all(beside.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  std::vector<Noise::Weight> weights;
  for (const Noise& noise : beside) weights.push_back(noise.weight());
  from_whole_residuals(linear, all, gates, beside);
  for (std::size_t i = 0; i < weights.size(); ++i) beside[i] = beside[i].repeated(weights[i]);
  add_errors_of_causes(linear, beside);
  return beside;
}

FitNoise noise_under(const Linearisation& linear, const Gates& gates) {
  FitNoise out{noise_beside(linear, gates)};
  const LackOfFit left = lack_of_fit(linear, out.profiles, gates);
  if (left.significant(gates))
    out.inflation = left.ratio;
  else
    out.profiles = noise_if_complete(linear, std::move(out.profiles), gates);
  return out;
}

}  // namespace slideway
