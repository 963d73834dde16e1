#include "slideway/identify/ranking.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <set>

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
constexpr double kAlike = 0.95;
constexpr double kNoSignal = 1e-9;  // a signal this small beside the profile is rounding
constexpr double kSignificant = 0.05;
// Smaller leads come and go with the next profile.
constexpr double kClearRest = 0.8;  // of the variance the next effect leaves unexplained
constexpr double kClearShare = 0.2;

int most_lags(std::size_t n) { return static_cast<int>(std::min(kMostLags, n / 4)); }

/// An effect's signal on one profile: in the low band, and how it correlates at full length.
struct Signal {
  const ModelTerm* term = nullptr;
  RunningCoefficient raw;
  Eigen::VectorXd low_band;
};

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
  const auto run = [&] {
    return running_pearson(
        profile.values,
        [&](std::size_t first, std::span<double> part) {
          Eigen::Map<Eigen::VectorXd> signal(part.data(), std::ssize(part));
          effect_signal(model, term, profile, amplitudes, shape, first, signal);
          squares += signal.squaredNorm();
        },
        kRunningPoints);
  };
  Signal out{&term, run(), {}};
  const Eigen::Map<const Eigen::VectorXd> values(profile.values.data(), std::ssize(profile.values));
  if (std::sqrt(squares) <= kNoSignal * values.norm()) {
    amplitudes.setConstant(amplitudes.size() == 1 ? 1.0 : 0.0);
    out.raw = run();
  }
  out.low_band = low_band_signal(model, fit, term, observation, amplitudes);
  return out;
}

Ranking rank_one(Signal& signal, const Observation& observation) {
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
  RunningCoefficient raw = std::move(signal.raw);
  out.raw = raw.coefficient.back();
  // The low band has fewer values: its coefficient stands at the same share of the trace.
  const RunningCoefficient low = running_pearson(measured, modelled, kRunningPoints);
  const auto reached = [](const RunningCoefficient& running, std::span<const double> positions) {
    std::vector<double> out;
    for (const std::size_t samples : running.samples) out.push_back(positions[samples - 1]);
    return out;
  };
  out.running.position_mm = reached(raw, profile.positions);
  out.running.low_band_position_mm =
      reached(low, observation.low_band.positions(profile.positions));
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

/// Effects with the largest and the next largest mean score.
struct Lead {
  std::string first, second;
  double score = 0.0, next = 0.0;
};

std::optional<Lead> lead(const std::map<std::string, double>& sums, std::size_t profiles) {
  Lead out;
  for (const auto& [effect, sum] : sums) {
    const double score = sum / static_cast<double>(profiles);
    if (score > out.score) {
      out = {effect, out.first, score, out.score};
    } else if (score >= out.next) {
      out.second = effect;
      out.next = score;
    }
  }
  if (out.first.empty()) return std::nullopt;
  return out;
}

/// Another effect whose share in the fit is a convention together with this one's.
std::optional<std::string> untold_from(const std::string& effect, const Identifiability& what) {
  for (const UndeterminedDirection& direction : what.unidentifiable) {
    std::set<std::string> effects;
    for (const auto& [parameter, factor] : direction.combination)
      effects.insert(parameter.substr(0, parameter.rfind('.')));
    if (effects.erase(effect) == 0 || effects.empty()) continue;
    return *effects.begin();
  }
  return std::nullopt;
}

std::string doubt(const Lead& correlation, const Lead& share, const Identifiability& what) {
  if (const std::optional<std::string> other = untold_from(share.first, what))
    return "these data do not tell " + share.first + " from " + *other +
           ", how the low band is shared out between them is a convention";
  const auto rest = [](double coefficient) { return 1.0 - coefficient * coefficient; };
  const bool correlates = rest(correlation.score) <= kClearRest * rest(correlation.next);
  const bool outweighs = share.score - share.next >= kClearShare;
  if (correlates && outweighs) return "";
  const auto against = [](const Lead& lead, double scale, const std::string& unit, int digits) {
    return joined(
        std::vector<std::string>{"", significant(scale * lead.score, digits) + unit, "against",
                                 lead.second, significant(scale * lead.next, digits) + unit},
        " ");
  };
  return "no clear lead, by correlation " + correlation.first +
         (correlates ? "" : against(correlation, 1.0, "", 3)) + ", by fit " + share.first +
         (outweighs ? "" : against(share, 100.0, " %", 2));
}

}  // namespace

RankingResult rank_effects(const Model& model, const Solution& fit) {
  RankingResult out;
  for (const Observation& observation : model.observations) {
    std::vector<const ModelTerm*> terms;
    for (const ModelTerm& term : model.terms)
      if (term.effect->applies_to(observation.profile->setup)) terms.push_back(&term);
    std::vector<Signal> signals(terms.size());
    std::vector<Ranking> entries(terms.size());
    parallel_for(terms.size(), [&](std::size_t i) {
      signals[i] = signal_of(model, fit, *terms[i], observation);
      entries[i] = rank_one(signals[i], observation);
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
    if (std::abs(pair.coefficient) > kAlike)
      out.notes.push_back("profile '" + pair.profile + "': " + pair.a + " and " + pair.b +
                          " are nearly one shape; their ranking says nothing");
  return out;
}

Dominant dominant_effects(const RankingResult& ranking, const ModelResult& fit) {
  std::map<std::string, double> coefficients, shares;
  std::set<std::string> profiles, fitted, significant_effects;
  for (const Ranking& entry : ranking.entries) {
    coefficients[entry.effect] += std::abs(entry.low_band);
    profiles.insert(entry.profile);
    if (entry.p_value < kSignificant) significant_effects.insert(entry.effect);
  }
  for (const Contribution& contribution : fit.contributions) {
    shares[contribution.effect] += contribution.share;
    fitted.insert(contribution.profile);
  }
  Dominant out;
  const std::optional<Lead> by_correlation = lead(coefficients, profiles.size());
  const std::optional<Lead> by_fit = lead(shares, fitted.size());
  if (coefficients.size() < 2 || !by_correlation ||
      !significant_effects.contains(by_correlation->first))
    return out;
  out.by_correlation = by_correlation->first;
  if (!by_fit) return out;
  out.by_fit = by_fit->first;
  out.doubt = doubt(*by_correlation, *by_fit, fit.identifiability);
  out.agree = out.doubt.empty() && by_correlation->first == by_fit->first;
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
