#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "slideway/base/text.hpp"
#include "slideway/identify/ranking.hpp"
#include "slideway/identify/uncertainty.hpp"

namespace slideway {
namespace {

/// The shares of all effects and how each moves with amplitudes and shapes.
struct Shares {
  Eigen::VectorXd share;     // #terms
  Eigen::MatrixXd gradient;  // #terms by (A + S)
};

bool sees_two(const Model& model, const Profile& profile) {
  return std::ranges::count_if(model.terms,
                               [&](const ModelTerm& term) { return term.acts_on(profile); }) > 1;
}

/// Of one profile; nothing where the model puts nothing into it, or one effect only.
Shares shares_in(const Model& model, const Solution& fit, std::size_t which) {
  if (!sees_two(model, *fit.linear.observations[which]->profile)) return {};
  const Eigen::MatrixXd& columns = fit.linear.columns[which];
  const Eigen::MatrixXd level = levelled(*fit.linear.observations[which], columns);
  const Eigen::Index terms = std::ssize(model.terms), amplitudes = model.amplitudes();
  Shares out{Eigen::VectorXd::Zero(terms), Eigen::MatrixXd::Zero(terms, columns.cols())};
  for (Eigen::Index t = 0; t < terms; ++t) {
    const ModelTerm& term = model.terms[static_cast<std::size_t>(t)];
    const Eigen::Index first = term.first_amplitude, count = term.effect->amplitudes();
    const Eigen::Index shape = amplitudes + term.first_shape;
    const auto shapes = static_cast<Eigen::Index>(term.effect->shapes().size());
    const Eigen::VectorXd signal =
        level.middleCols(first, count) * fit.estimate.amplitudes.segment(first, count);
    out.share[t] = signal.squaredNorm();
    out.gradient.row(t).segment(first, count) =
        2.0 * signal.transpose() * level.middleCols(first, count);
    out.gradient.row(t).segment(shape, shapes) =
        2.0 * signal.transpose() * level.middleCols(shape, shapes);
  }
  const double total = out.share.sum();
  if (!(total > 0.0)) return {};
  const Eigen::RowVectorXd change = out.gradient.colwise().sum();
  out.share /= total;
  out.gradient = (out.gradient - out.share * change) / total;
  return out;
}

/// Effects with the largest and the next largest mean coefficient.
struct LeadByCorrelation {
  std::string first;
  double score = 0.0, next = 0.0;
};

std::optional<LeadByCorrelation> lead_by_correlation(const RankingResult& ranking,
                                                     const Gates& gates) {
  std::map<std::string, int> effects_in;
  for (const Ranking& entry : ranking.entries) ++effects_in[entry.profile];
  std::map<std::string, double> sums;
  std::set<std::string> profiles, significant_effects;
  for (const Ranking& entry : ranking.entries) {
    if (effects_in[entry.profile] < 2) continue;
    sums[entry.effect] += std::abs(entry.low_band);
    profiles.insert(entry.profile);
    if (entry.p_value < gates.ranking_p) significant_effects.insert(entry.effect);
  }
  if (sums.size() < 2) return std::nullopt;
  LeadByCorrelation out;
  for (const auto& [effect, sum] : sums) {
    const double score = sum / static_cast<double>(profiles.size());
    if (score > out.score)
      out = {effect, score, out.score};
    else
      out.next = std::max(out.next, score);
  }
  const auto rest = [](double coefficient) { return 1.0 - coefficient * coefficient; };
  const bool is_clear = rest(out.score) <= gates.ranking_lead * rest(out.next);
  if (!is_clear || !significant_effects.contains(out.first)) return std::nullopt;
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

std::string percent(double share) { return significant(100.0 * share, 2) + " %"; }

/// Why the larger share names no effect; "" if it does.
std::string doubt(const LeadByFit& lead, const Identifiability& what) {
  if (const std::optional<std::string> other = untold_from(lead.first, what))
    return "these data do not tell " + lead.first + " from " + *other +
           ", how the low band is shared out between them is a convention";
  if (lead.share - lead.next > lead.expanded_uncertainty) return "";
  return "no clear lead, by fit " + lead.first + " " + percent(lead.share) + " against " +
         lead.second + " " + percent(lead.next) + ", uncertainty of the difference " +
         percent(lead.expanded_uncertainty);
}

}  // namespace

std::optional<LeadByFit> lead_by_fit(const Model& model, const Solution& fit) {
  Shares sum;
  double profiles = 0.0;
  for (std::size_t i = 0; i < fit.linear.observations.size(); ++i) {
    const Shares own = shares_in(model, fit, i);
    if (own.share.size() == 0) continue;
    profiles += 1.0;
    sum = profiles > 1.0 ? Shares{sum.share + own.share, sum.gradient + own.gradient} : own;
  }
  if (sum.share.size() < 2) return std::nullopt;
  Eigen::Index first = 0, second = 0;
  const double largest = sum.share.maxCoeff(&first);
  Eigen::VectorXd others = sum.share;
  others[first] = -1.0;
  const double next = others.maxCoeff(&second);
  const Spread spread = fit.uncertainty.of(
      Eigen::RowVectorXd(sum.gradient.row(first) - sum.gradient.row(second)) / profiles);
  const double uncertainty =
      coverage_factor(spread.degrees_of_freedom) * spread.standard_uncertainty;
  const auto name = [&](Eigen::Index i) { return model.terms[static_cast<std::size_t>(i)].name; };
  return LeadByFit{name(first), name(second), largest / profiles, next / profiles,
                   std::isfinite(uncertainty) ? std::min(uncertainty, 1.0) : 1.0};
}

Dominant dominant_effects(const RankingResult& ranking, const std::optional<LeadByFit>& fit,
                          const Identifiability& identifiability, const Gates& gates) {
  Dominant out;
  if (const auto lead = lead_by_correlation(ranking, gates)) out.by_correlation = lead->first;
  if (!fit) return out;
  out.doubt = doubt(*fit, identifiability);
  if (out.doubt.empty()) out.by_fit = fit->first;
  if (out.by_correlation && out.by_fit) out.agree = *out.by_correlation == *out.by_fit;
  return out;
}

}  // namespace slideway
