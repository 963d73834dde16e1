#include "whiten_beside.hpp"

#include <algorithm>
#include <set>
#include <string>

#include "slideway/identify/departures.hpp"
#include "slideway/identify/left_out.hpp"
#include "slideway/identify/linear_algebra.hpp"
#include "slideway/identify/noise_model.hpp"

namespace slideway {
namespace {

constexpr int kNoiseRounds = 3;

/// Whether it is of how one trace lies on the workpiece.
bool is_of_one_trace(const Candidate& candidate) {
  const Description& about = candidate.term.effect->description();
  return only(candidate) && (about.of_face || about.variable == IndependentVariable::trace);
}

/// What the data may lack: the best finding. Where that, or one as good, is of how one trace lies
/// on the workpiece, the best such finding of each other profile as well: no trace lies as another
/// does, and what one hides is no noise of the rest.
std::vector<Finding> suspects_among(std::vector<Finding> findings, const Gates& gates) {
  sort_by_priority(findings);
  const auto is_place = [](const Finding& each) { return is_of_one_trace(*each.candidate); };
  const auto place = std::ranges::find_if(findings, is_place);
  if (place == findings.end() || place->delta_bic > findings.front().delta_bic + gates.exchange_bic)
    return {findings.front()};
  std::vector<Finding> out{*place};
  for (const Finding& each : findings)
    if (each.delta_bic < 0.0 && is_place(each) && std::ranges::none_of(out, [&](const Finding& f) {
          return only(*f.candidate) == only(*each.candidate);
        }))
      out.push_back(each);
  return out;
}

/// directions_of_causes() of each profile beside a finding whose cause was logged; empty: none.
std::vector<Eigen::MatrixXd> directions_beside(const Model& model, const Whitened& data,
                                               const Linearisation& linear,
                                               const Finding& finding) {
  const Candidate& candidate = *finding.candidate;
  if (!is_measured(candidate) || finding.rank == 0) return {};
  const std::vector<double>& shape =
      candidate.grid.points()[static_cast<std::size_t>(finding.atom)];
  const Eigen::MatrixXd columns =
      stacked_columns(model, candidate.term, shape, data.rows() - data.values());
  const double size = project(data, columns).amplitudes[0];
  std::vector<Eigen::MatrixXd> out = errors_of_cause(model, linear, candidate.term, shape, size);
  const std::vector<Eigen::MatrixXd> own = by_profile(linear, columns);
  bool any = false;
  for (std::size_t i = 0; i < out.size(); ++i) {
    Eigen::VectorXd residual = linear.residuals[i];
    project_out(orthonormal(own[i]), residual);
    out[i] = directions_of_causes(out[i], std::move(residual));
    any |= out[i].cols() > 0;
  }
  return any ? out : std::vector<Eigen::MatrixXd>{};
}

/// What a hypothesis leaves free: a finding, and its directions_beside().
struct FreeFinding {
  Finding finding;
  std::vector<Eigen::MatrixXd> beside;
};

/// The findings, and the best one of every log whose error is more than noise.
std::vector<FreeFinding> with_measured(const Model& model, const Whitened& data,
                                       const Linearisation& linear,
                                       const std::vector<Finding>& suspects,
                                       std::vector<Finding> findings) {
  std::vector<FreeFinding> out;
  for (const Finding& each : suspects)
    out.push_back({each, directions_beside(model, data, linear, each)});
  sort_by_priority(findings);
  std::set<std::string> names;
  for (const Finding& each : findings) {
    if (!is_measured(*each.candidate) || !names.insert(each.candidate->effect_name()).second ||
        std::ranges::find(suspects, each.candidate, &Finding::candidate) != suspects.end())
      continue;
    std::vector<Eigen::MatrixXd> beside = directions_beside(model, data, linear, each);
    if (!beside.empty()) out.push_back({each, std::move(beside)});
  }
  return out;
}

/// Columns of the values left undescribed, profile by profile.
std::vector<Eigen::MatrixXd> columns_of(const Linearisation& linear,
                                        const FreeValues& undescribed) {
  std::vector<Eigen::MatrixXd> out;
  for (std::size_t i = 0; i < linear.observations.size(); ++i)
    out.push_back(unit_columns(undescribed[i], linear.observations[i]->values.size()));
  return out;
}

/// What a hypothesis adds to the model, profile by profile: values left undescribed, and the
/// columns of findings and of their neighbours on the grid (their shapes lie between them), with
/// what the error of a log makes beyond all noise.
std::vector<Eigen::MatrixXd> columns_by_profile(const Linearisation& linear,
                                                const FreeValues& undescribed,
                                                const std::vector<FreeFinding>& suspects) {
  std::vector<Eigen::MatrixXd> out = columns_of(linear, undescribed);
  for (const auto& [finding, beside] : suspects) {
    const std::vector<std::size_t>& part = finding.candidate->part;
    const std::vector<Eigen::MatrixXd> around =
        by_profile(linear, finding.candidate->columns_around(finding.atom));
    for (std::size_t i = 0; i < out.size(); ++i) {
      if (!part.empty() && std::ranges::count(part, i) == 0) continue;
      append_columns(out[i], around[i]);
      if (!beside.empty()) append_columns(out[i], beside[i]);
    }
  }
  return out;
}

}  // namespace

std::pair<Whitened, std::vector<Finding>> whiten_beside(const Model& model, const Solution& fit,
                                                        const FreeValues& undescribed,
                                                        const Candidates& candidates) {
  Whitened data(fit.linear,
                noise_beside(fit.linear, model.gates, columns_of(fit.linear, undescribed)),
                undescribed);
  if (candidates.empty()) return {std::move(data), std::vector<Finding>{}};
  std::vector<Finding> findings = search(data, candidates);
  std::vector<Finding> suspects = suspects_among(findings, model.gates);
  std::vector<Eigen::MatrixXd> free;
  for (int round = 0; round < kNoiseRounds; ++round) {
    const std::vector<FreeFinding> all = with_measured(model, data, fit.linear, suspects, findings);
    free = columns_by_profile(fit.linear, undescribed, all);
    data = Whitened(fit.linear, noise_beside(fit.linear, model.gates, free), undescribed);
    findings = search(data, candidates);
    const std::vector<Finding> before =
        std::exchange(suspects, suspects_among(findings, model.gates));
    if (suspects.front().delta_bic >= 0.0 ||
        std::ranges::equal(before, suspects, {}, &Finding::candidate, &Finding::candidate))
      break;
  }
  std::vector<Noise> noise = data.noise();
  rule_out_by_whole(fit.linear, model.gates, free, noise);
  data.set_alternatives(std::move(noise));
  return {std::move(data), std::move(findings)};
}

}  // namespace slideway
