#include "round.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "background.hpp"
#include "gates.hpp"
#include "slideway/base/parallel.hpp"
#include "slideway/base/text.hpp"

namespace slideway {
namespace {

constexpr double kWorthRefining = 30.0;  // behind the best on the grid, or
constexpr double kWorthShare = 0.6;      // of it: a line between two points of the grid loses some
constexpr std::size_t kMostRefined = 12;
constexpr int kNoiseRounds = 3;

const Finding& best_of(const std::vector<Finding>& findings) {
  return *std::min_element(findings.begin(), findings.end(),
                           [](const auto& a, const auto& b) { return a.delta_bic < b.delta_bic; });
}

/// Columns of a finding and of its neighbours on the grid (its shape lies between them), profile by
/// profile.
std::vector<Eigen::MatrixXd> columns_by_profile(const Whitened& data, const Finding& finding) {
  const Eigen::MatrixXd columns = finding.candidate->columns_around(finding.atom);
  std::vector<Eigen::MatrixXd> out;
  for (std::size_t i = 0; i < data.observations(); ++i)
    out.emplace_back(columns.middleRows(data.first_row(i), data.count(i)));
  return out;
}

std::string implausible(const Refined& refined) {
  const std::vector<Parameter>& parameters = refined.candidate->term.effect->parameters();
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const double value = refined.values[static_cast<Eigen::Index>(p)];
    if (value < parameters[p].lower || value > parameters[p].upper)
      return parameters[p].name + " = " + significant(value, 3) + " is physically impossible";
  }
  return "";
}

std::string reason_against(const Refined& refined, double p_value, double significance,
                           const std::optional<HeldOut>& held_out) {
  if (refined.projection.rank == 0) return "the model makes the same columns";
  if (refined.delta_bic > -kEnough)
    return "gains too little: difference in BIC " + significant(refined.delta_bic, 3);
  if (p_value > significance) return "noise gives as much: p = " + significant(p_value, 2);
  if (std::string why = implausible(refined); !why.empty()) return why;
  if (refined.at_end) return "its shape runs to the end of what is possible";
  if (refined.size_in_uncertainties < kLeastSize)
    return "its size is only " + significant(refined.size_in_uncertainties, 2) +
           " of its standard uncertainties";
  if (held_out && !held_out->helps) return "it predicts left-out profiles worse";
  return "";
}

/// Whether two parts of the residual are one and the same rather than each its own.
bool alike(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  constexpr double kAlike = 0.3;  // cosine
  return std::abs(a.dot(b)) > kAlike * a.norm() * b.norm();
}

/// Candidates worth a closer look at their best shapes, best BIC first: those near the best, and on
/// down while none of them can be accepted.
std::vector<Seen> look_closer(const Model& model, const Solution& fit, const Whitened& data,
                              std::vector<Finding> findings, double significance,
                              const Calibration& calibration) {
  std::stable_sort(findings.begin(), findings.end(),
                   [](const auto& a, const auto& b) { return a.delta_bic < b.delta_bic; });
  const auto looked_at = [&](const Finding& finding) {
    Seen seen;
    seen.refined = refine(model, data, finding);
    seen.p_value = calibration.p_value(-seen.refined.delta_bic);
    seen.held_out = leave_one_out(fit.linear, data, seen.refined);
    seen.refused = reason_against(seen.refined, seen.p_value, significance, seen.held_out);
    seen.fitted = data.outside(seen.refined.columns * seen.refined.projection.amplitudes);
    return seen;
  };
  const auto worth = [&](double most) {
    const auto first_not = std::find_if(findings.begin(), findings.end(), [&](const Finding& f) {
      return f.rank == 0 || f.delta_bic > most;
    });
    return std::min<std::size_t>(first_not - findings.begin(), kMostRefined);
  };
  const double best = findings.front().delta_bic;
  std::vector<Seen> out(worth(std::max(best + kWorthRefining, kWorthShare * best)));
  parallel_for(out.size(), [&](std::size_t i) { out[i] = looked_at(findings[i]); });
  const std::size_t pay = worth(kWorthRefining - kEnough);
  const auto none = [&] {
    return std::none_of(out.begin(), out.end(), [](const Seen& s) { return s.refused.empty(); });
  };
  while (out.size() < pay && none()) out.push_back(looked_at(findings[out.size()]));
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) {
    return a.refined.delta_bic < b.refined.delta_bic;
  });
  return out;
}

/// The data made white for a model that lacks what the candidates can bring, and their findings:
/// noise and effect are estimated together.
std::pair<Whitened, std::vector<Finding>> whiten_beside(const Solution& fit,
                                                        const Eigen::MatrixXd& loose,
                                                        const Candidates& candidates) {
  Whitened data(fit.linear, background_noise(fit, loose), loose);
  if (candidates.empty()) return {std::move(data), std::vector<Finding>{}};
  std::vector<Finding> findings = search(data, candidates);
  for (int round = 0; round < kNoiseRounds && best_of(findings).delta_bic < 0.0; ++round) {
    const Finding suspect = best_of(findings);
    data = Whitened(fit.linear, background_noise(fit, loose, columns_by_profile(data, suspect)),
                    loose);
    findings = search(data, candidates);
    if (best_of(findings).candidate == suspect.candidate) break;
  }
  return {std::move(data), std::move(findings)};
}

}  // namespace

bool is_possible(const Seen& each) {
  return each.refined.projection.rank > 0 && implausible(each.refined).empty();
}

const Seen* Look::choice(const std::vector<std::string>& taken) const {
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (!seen[i].refused.empty() ||
        std::find(taken.begin(), taken.end(), seen[i].name()) != taken.end())
      continue;
    const auto stands_before = [&](const Seen& better) {
      return better.refined.delta_bic < seen[i].refined.delta_bic - kTied &&
             alike(better.fitted, seen[i].fitted);
    };
    if (std::none_of(seen.begin(), seen.begin() + static_cast<std::ptrdiff_t>(i), stands_before))
      return &seen[i];
  }
  return nullptr;
}

std::vector<const Seen*> Look::rivals(const Seen& chosen) const {
  std::vector<const Seen*> out;
  const auto unknowns = [](const Seen& each) {
    return each.refined.candidate->unknowns(each.refined.projection.rank);
  };
  const bool comes_near_all = chosen.refined.candidate->term.effect->is_carriage();
  for (const Seen& each : seen) {
    const bool counts =
        each.refused.empty() ||
        (is_possible(each) && (unknowns(each) <= unknowns(chosen) || comes_near_all));
    const bool known = std::any_of(out.begin(), out.end(),
                                   [&](const Seen* other) { return other->name() == each.name(); });
    if (counts && !known && each.name() != chosen.name() &&
        each.refined.delta_bic <= chosen.refined.delta_bic + kTied &&
        alike(each.fitted, chosen.fitted))
      out.push_back(&each);
  }
  return out;
}

Look look(const Model& model, const Solution& fit, const Candidates& candidates,
          double significance, std::optional<Calibration>& calibration,
          const std::function<void(double)>& told) {
  const Eigen::MatrixXd loose = loose_values(model, fit, fit.noise);
  auto [data, findings] = whiten_beside(fit, loose, candidates);
  Look out{std::move(data), {}};
  if (candidates.empty()) return out;
  if (!calibration) calibration = calibrate(out.data, candidates, told);
  out.seen = look_closer(model, fit, out.data, findings, significance, *calibration);
  if (!out.seen.empty() && is_centred(*out.seen.front().refined.candidate->term.effect)) {
    const Refined& best = out.seen.front().refined;
    const Eigen::MatrixXd looser =
        loose_values(model, fit, out.data.noise(), best.columns * best.projection.amplitudes);
    if (looser.cols() > loose.cols()) {
      std::tie(out.data, findings) = whiten_beside(fit, looser, candidates);
      out.seen = look_closer(model, fit, out.data, findings, significance, *calibration);
    }
  }
  return out;
}

}  // namespace slideway
