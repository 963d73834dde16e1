#include "round.hpp"

#include <algorithm>
#include <cmath>

#include "background.hpp"
#include "slideway/base/text.hpp"

namespace slideway {
namespace {

constexpr double kEnough = -10.0;        // ΔBIC
constexpr double kTied = 10.0;           // of BIC: no choice between these
constexpr double kLeastSize = 5.0;       // standard uncertainties of its own size
constexpr double kWorthRefining = 30.0;  // behind the best on the grid, or
constexpr double kWorthShare = 0.6;      // of it: a line between two points of the grid loses some
constexpr std::size_t kMostRefined = 8;
constexpr int kNoiseRounds = 3;

const Finding& best_of(const std::vector<Finding>& findings) {
  return *std::min_element(findings.begin(), findings.end(),
                           [](const auto& a, const auto& b) { return a.delta_bic < b.delta_bic; });
}

/// Columns of a finding and of its neighbours on the grid (its shape lies between them), profile by
/// profile.
std::vector<Eigen::MatrixXd> columns_by_profile(const Whitened& data, const Finding& finding) {
  const Eigen::Index a = finding.candidate->amplitudes();
  const Eigen::Index first = std::max<Eigen::Index>(finding.atom - 1, 0);
  const Eigen::Index last = std::min(finding.atom + 1, finding.candidate->atoms() - 1);
  const auto columns = finding.candidate->columns.middleCols(first * a, (last - first + 1) * a);
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
  if (refined.delta_bic > kEnough)
    return "gains too little: difference in BIC " + significant(refined.delta_bic, 3);
  if (p_value > significance) return "noise gives as much: p = " + significant(p_value, 2);
  if (std::string why = implausible(refined); !why.empty()) return why;
  if (refined.at_end) return "its shape runs to the end of what is possible";
  if (refined.size_in_uncertainties < kLeastSize)
    return "its size is only " + significant(refined.size_in_uncertainties, 2) +
           " of its standard uncertainties";
  if (held_out && !(held_out->after_rms < held_out->before_rms))
    return "it predicts left-out profiles worse";
  return "";
}

}  // namespace

std::optional<std::size_t> Look::choice() const {
  for (std::size_t i = 0; i < refined.size(); ++i)
    if (refused[i].empty() && refined[i].delta_bic <= refined.front().delta_bic + kTied) return i;
  return std::nullopt;
}

std::vector<std::size_t> Look::rivals(std::size_t chosen) const {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < refined.size(); ++i)
    if (i != chosen && refused[i].empty() &&
        refined[i].delta_bic <= refined[chosen].delta_bic + kTied)
      out.push_back(i);
  return out;
}

Look look(const Model& model, const Fit& fit, const Candidates& candidates, double significance,
          std::optional<Calibration>& calibration) {
  const Eigen::MatrixXd loose = loose_values(model, fit);
  Look out{Whitened(fit.linear, background_noise(fit, loose), loose), {}, {}, {}, {}};
  if (candidates.empty()) return out;
  std::vector<Finding> findings = search(out.data, candidates);
  for (int round = 0; round < kNoiseRounds && best_of(findings).delta_bic < 0.0; ++round) {
    const Finding suspect = best_of(findings);
    out.data = Whitened(fit.linear,
                        background_noise(fit, loose, columns_by_profile(out.data, suspect)), loose);
    findings = search(out.data, candidates);
    if (best_of(findings).candidate == suspect.candidate) break;
  }
  if (!calibration) calibration = calibrate(out.data, candidates);
  std::stable_sort(findings.begin(), findings.end(),
                   [](const auto& a, const auto& b) { return a.delta_bic < b.delta_bic; });
  for (const Finding& finding : findings) {
    const double best = findings.front().delta_bic;
    if (out.refined.size() == kMostRefined || finding.rank == 0 ||
        finding.delta_bic > std::max(best + kWorthRefining, kWorthShare * best))
      break;
    out.refined.push_back(refine(model, out.data, finding));
  }
  std::stable_sort(out.refined.begin(), out.refined.end(),
                   [](const auto& a, const auto& b) { return a.delta_bic < b.delta_bic; });
  for (const Refined& refined : out.refined) {
    out.p_values.push_back(calibration->p_value(-refined.delta_bic));
    out.held_out.push_back(leave_one_out(fit.linear, out.data, refined));
    out.refused.push_back(
        reason_against(refined, out.p_values.back(), significance, out.held_out.back()));
  }
  return out;
}

}  // namespace slideway
