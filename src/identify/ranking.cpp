#include "slideway/identify/ranking.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "residual.hpp"
#include "slideway/base/error.hpp"
#include "slideway/profile/table.hpp"
#include "slideway/signal/correlation.hpp"

namespace slideway {
namespace {

constexpr std::size_t kRunningPoints = 200;
constexpr std::size_t kMostLags = 200;  // of the low band, on either side
constexpr double kAlike = 0.95;

std::span<const double> view(const Eigen::VectorXd& values) {
  return {values.data(), static_cast<std::size_t>(values.size())};
}

int most_lags(std::size_t n) { return static_cast<int>(std::min(kMostLags, n / 4)); }

/// An effect's signal on one profile at full length and in the low band.
struct Signal {
  const ModelTerm* term = nullptr;
  Eigen::VectorXd raw, low_band;
};

Signal signal_of(const Model& model, const Fit& fit, const ModelTerm& term,
                 const Observation& observation) {
  const auto shape = shapes_of(term, fit.estimate.shapes);
  Eigen::VectorXd amplitudes =
      fit.estimate.amplitudes.segment(term.first_amplitude, term.effect->amplitudes());
  if (amplitudes.isZero(0.0) && amplitudes.size() == 1) amplitudes.setOnes();
  Signal out{&term, effect_signal(model, term, *observation.profile, amplitudes, shape), {}};
  out.low_band.resize(observation.low_band.values());
  observation.low_band.apply(view(out.raw),
                             {out.low_band.data(), static_cast<std::size_t>(out.low_band.size())});
  return out;
}

Ranking rank_one(const Signal& signal, const Observation& observation) {
  const Profile& profile = *observation.profile;
  const auto measured = view(observation.values), modelled = view(signal.low_band);
  Ranking out{signal.term->name, profile.name};
  out.low_band = pearson(measured, modelled);
  const Lag lag = best_lag(measured, modelled, most_lags(measured.size()));
  const double step = (profile.setup.last_mm - profile.setup.first_mm) /
                      static_cast<double>(std::max<std::size_t>(measured.size() - 1, 1));
  out.lag_mm = lag.lag * step;
  out.lag_coefficient = lag.coefficient;
  out.effective_observations = effective_observations(measured, modelled);
  out.p_value = correlation_p_value(out.low_band, out.effective_observations);
  RunningCoefficient raw = running_pearson(profile.values, view(signal.raw), kRunningPoints);
  out.raw = raw.coefficient.back();
  // The low band has fewer values: its coefficient stands at the same share of the trace.
  const RunningCoefficient low = running_pearson(measured, modelled, kRunningPoints);
  out.running = {std::move(raw.samples), std::move(raw.coefficient), low.coefficient};
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

RankingResult rank_effects(const Model& model, const Fit& fit) {
  RankingResult out;
  for (const Observation& observation : model.observations) {
    std::vector<Signal> signals;
    for (const ModelTerm& term : model.terms) {
      if (!term.effect->applies_to(observation.profile->setup)) continue;
      signals.push_back(signal_of(model, fit, term, observation));
      out.entries.push_back(rank_one(signals.back(), observation));
    }
    compare_candidates(signals, observation.profile->name, out);
  }
  out.notes.emplace_back(
      "a coefficient above 0.95 selects nothing by itself: over half a face different effects "
      "correlate with one another as strongly (cone and r^2: 0.968)");
  for (const CandidateCorrelation& pair : out.among_candidates)
    if (std::abs(pair.coefficient) > kAlike)
      out.notes.push_back("profile '" + pair.profile + "': " + pair.a + " and " + pair.b +
                          " are nearly one shape; their ranking says nothing");
  return out;
}

Dominant dominant_effects(const RankingResult& ranking, const FitResult& fit) {
  std::map<std::string, double> by_correlation, by_fit;
  for (const Ranking& entry : ranking.entries)
    by_correlation[entry.effect] += std::abs(entry.low_band);
  for (const Contribution& contribution : fit.contributions)
    by_fit[contribution.effect] += contribution.share;
  const auto largest =
      [](const std::map<std::string, double>& scores) -> std::optional<std::string> {
    const auto best =
        std::max_element(scores.begin(), scores.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    if (best == scores.end() || !(best->second > 0.0)) return std::nullopt;
    return best->first;
  };
  Dominant out{largest(by_correlation), largest(by_fit), std::nullopt};
  if (out.by_correlation && out.by_fit) out.agree = *out.by_correlation == *out.by_fit;
  return out;
}

std::vector<ColumnRanking> rank_columns(const std::filesystem::path& file,
                                        const std::string& signal,
                                        const std::vector<std::string>& candidates,
                                        const LowBandOptions& options) {
  std::vector<std::string> names{signal};
  names.insert(names.end(), candidates.begin(), candidates.end());
  const Table table = read_table(file, names);
  std::vector<double> rows(table.columns.front().size());
  std::iota(rows.begin(), rows.end(), 0.0);
  const LowBand low_band = [&] {
    try {
      return LowBand(options, rows);
    } catch (const DataError& error) {
      throw DataError(file.string() + ": " + error.what());
    }
  }();
  const auto filtered = [&](const std::vector<double>& column) {
    std::vector<double> out(low_band.values());
    low_band.apply(column, out);
    return out;
  };
  const std::vector<double> measured = filtered(table.columns[0]);
  std::vector<ColumnRanking> out;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    const std::vector<double> candidate = filtered(table.columns[c + 1]);
    const Lag lag = best_lag(measured, candidate, most_lags(measured.size()));
    ColumnRanking entry{candidates[c], pearson(table.columns[0], table.columns[c + 1]),
                        pearson(measured, candidate), lag.lag, lag.coefficient};
    entry.effective_observations = effective_observations(measured, candidate);
    entry.p_value = correlation_p_value(entry.low_band, entry.effective_observations);
    out.push_back(std::move(entry));
  }
  std::stable_sort(out.begin(), out.end(), [](const ColumnRanking& a, const ColumnRanking& b) {
    return std::abs(a.low_band) > std::abs(b.low_band);
  });
  return out;
}

}  // namespace slideway
