#include "slideway/identify/ranking.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "residual.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/parallel.hpp"
#include "slideway/base/text.hpp"
#include "slideway/format/table.hpp"
#include "slideway/signal/correlation.hpp"
#include "slideway/signal/view.hpp"

namespace slideway {
namespace {

constexpr std::size_t kRunningPoints = 200;
constexpr std::size_t kMostLags = 200;  // of the low band, on either side
constexpr double kNoSignal = 1e-9;      // a signal this small beside the profile is rounding

int most_lags(std::size_t n) { return static_cast<int>(std::min(kMostLags, n / 4)); }

/// An effect's signal on one profile: levelled in the low band, and how it correlates at full
/// length.
struct Signal {
  const ModelTerm* term = nullptr;
  RunningCoefficient raw;
  Eigen::VectorXd low_band;
};

/// Nothing where levelling leaves rounding only.
Eigen::VectorXd levelled_series(const Observation& observation, const Eigen::VectorXd& values) {
  Eigen::VectorXd out = levelled(observation, values);
  if (out.norm() <= kNoSignal * values.norm()) out.setZero();
  return out;
}

Eigen::VectorXd low_band_signal(const Model& model, const Solution& fit, const ModelTerm& term,
                                const Observation& observation, const Eigen::VectorXd& amplitudes) {
  const auto fitted = std::ranges::find(fit.linear.observations, &observation);
  if (fitted == fit.linear.observations.end())
    return low_band_columns(model, term, observation, shapes_of(term, fit.estimate.shapes)) *
           amplitudes;
  const Eigen::MatrixXd& columns = fit.linear.columns[fitted - fit.linear.observations.begin()];
  return columns.middleCols(term.first_amplitude, amplitudes.size()) * amplitudes;
}

/// A part of the trace at a time: a signal of full length is as large as the profile.
Signal signal_of(const Model& model, const Solution& fit, const ModelTerm& term,
                 const Observation& observation) {
  const auto shape = shapes_of(term, fit.estimate.shapes);
  Eigen::VectorXd amplitudes =
      fit.estimate.amplitudes.segment(term.first_amplitude, term.effect->amplitudes());
  const Profile& profile = *observation.profile;
  double squares = 0.0;
  const auto fill = [&](std::size_t first, std::span<double> part) {
    Eigen::Map<Eigen::VectorXd> signal(part.data(), std::ssize(part));
    effect_signal(model, term, profile, amplitudes, shape, first, signal);
    squares += signal.squaredNorm();
  };
  const bool is_tilted = std::ranges::count(observation.nuisance_names, "tilt") > 0;
  const auto run = [&] {
    return is_tilted ? running_pearson(profile.values, fill, kRunningPoints, profile.positions)
                     : running_pearson(profile.values, fill, kRunningPoints);
  };
  Signal out{&term, run(), {}};
  const Eigen::Map<const Eigen::VectorXd> values(profile.values.data(), std::ssize(profile.values));
  if (std::sqrt(squares) <= kNoSignal * values.norm()) {
    amplitudes.setConstant(amplitudes.size() == 1 ? 1.0 : 0.0);
    out.raw = run();
  }
  out.low_band =
      levelled_series(observation, low_band_signal(model, fit, term, observation, amplitudes));
  return out;
}

/// Positions at which a growing part of a series ends.
std::vector<double> ends(const std::vector<double>& positions,
                         const std::vector<std::size_t>& samples) {
  std::vector<double> out;
  for (const std::size_t count : samples) out.push_back(positions[count - 1]);
  return out;
}

Ranking rank_one(Signal& signal, const Observation& observation, const Eigen::VectorXd& values) {
  const Profile& profile = *observation.profile;
  const auto measured = view(values), modelled = view(signal.low_band);
  Ranking out{signal.term->name, profile.name};
  out.low_band = pearson(measured, modelled);
  const Lag lag = best_lag(measured, modelled, most_lags(measured.size()));
  const double step = (profile.setup.last_mm - profile.setup.first_mm) /
                      static_cast<double>(std::max<std::size_t>(measured.size() - 1, 1));
  out.lag_mm = lag.lag * step;
  out.lag_coefficient = lag.coefficient;
  out.effective_observations = effective_observations(measured, modelled);
  out.p_value = correlation_p_value(out.low_band, out.effective_observations);
  RunningCoefficient raw = std::move(signal.raw);
  out.raw = raw.coefficient.back();
  const RunningCoefficient low = running_pearson(measured, modelled, kRunningPoints);
  out.running.position_mm = ends(profile.positions, raw.samples);
  out.running.low_band_position_mm =
      ends(observation.low_band.positions(profile.positions), low.samples);
  out.running.samples = std::move(raw.samples);
  out.running.raw = std::move(raw.coefficient);
  out.running.low_band = low.coefficient;
  return out;
}

void compare_candidates(const std::vector<Signal>& signals, const std::string& profile,
                        RankingResult& out) {
  for (std::size_t i = 0; i < signals.size(); ++i)
    for (std::size_t j = i + 1; j < signals.size(); ++j)
      out.among_candidates.push_back(
          {signals[i].term->name, signals[j].term->name, profile,
           pearson(view(signals[i].low_band), view(signals[j].low_band))});
}

}  // namespace

RankingResult rank_effects(const Model& model, const Solution& fit) {
  RankingResult out;
  for (const Observation& observation : model.observations) {
    std::vector<const ModelTerm*> terms;
    for (const ModelTerm& term : model.terms)
      if (term.acts_on(*observation.profile)) terms.push_back(&term);
    std::vector<Signal> signals(terms.size());
    std::vector<Ranking> entries(terms.size());
    const Eigen::VectorXd values = levelled_series(observation, observation.values);
    parallel_for(terms.size(), [&](std::size_t i) {
      signals[i] = signal_of(model, fit, *terms[i], observation);
      entries[i] = rank_one(signals[i], observation, values);
    });
    std::ranges::move(entries, std::back_inserter(out.entries));
    compare_candidates(signals, observation.profile->name, out);
  }
  if (model.terms.size() > 1)
    out.notes.emplace_back(
        "two different effects can both correlate above 0.95 with the same profile (over half a "
        "face cone and r^2 correlate to 0.968 with one another): a high coefficient alone does not "
        "select one");
  for (const CandidateCorrelation& pair : out.among_candidates)
    if (std::abs(pair.coefficient) > model.gates.nearly_alike)
      out.notes.push_back("profile '" + pair.profile + "': " + pair.a + " and " + pair.b +
                          " are nearly one shape; their ranking says nothing");
  return out;
}

std::vector<ColumnRanking> rank_columns(
    const std::vector<double>& signal,
    const std::vector<std::pair<std::string, std::vector<double>>>& candidates,
    const LowBandOptions& options) {
  std::vector<double> rows(signal.size());
  std::iota(rows.begin(), rows.end(), 0.0);
  const LowBand low_band(options, rows);
  const auto filtered = [&](const std::vector<double>& column) {
    std::vector<double> out(low_band.values());
    low_band.apply(column, out);
    return out;
  };
  const std::vector<double> measured = filtered(signal);
  std::vector<ColumnRanking> out;
  for (const auto& [name, column] : candidates) {
    const std::vector<double> candidate = filtered(column);
    const Lag lag = best_lag(measured, candidate, most_lags(measured.size()));
    ColumnRanking entry{name, pearson(signal, column), pearson(measured, candidate), lag.lag,
                        lag.coefficient};
    entry.effective_observations = effective_observations(measured, candidate);
    entry.p_value = correlation_p_value(entry.low_band, entry.effective_observations);
    out.push_back(std::move(entry));
  }
  std::stable_sort(out.begin(), out.end(), [](const ColumnRanking& a, const ColumnRanking& b) {
    return std::abs(a.low_band) > std::abs(b.low_band);
  });
  return out;
}

std::vector<ColumnRanking> rank_columns(const std::filesystem::path& file,
                                        const std::string& signal,
                                        const std::vector<std::string>& candidates,
                                        const LowBandOptions& options) {
  std::vector<std::string> names{signal};
  names.insert(names.end(), candidates.begin(), candidates.end());
  Table table = read_table(file, names);
  std::vector<std::pair<std::string, std::vector<double>>> columns;
  for (std::size_t c = 0; c < candidates.size(); ++c)
    columns.emplace_back(candidates[c], std::move(table.columns[c + 1]));
  try {
    return rank_columns(table.columns[0], columns, options);
  } catch (const DataError& error) {
    throw DataError(file.string() + ": " + error.what());
  }
}

}  // namespace slideway
