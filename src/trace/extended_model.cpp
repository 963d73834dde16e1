#include "extended_model.hpp"

#include <algorithm>

#include "background.hpp"

namespace slideway {
namespace {

constexpr std::size_t kMostValues = 2048;  // of a profile, in a search

Problem for_search(Problem problem, const std::vector<Profile>& profiles) {
  std::size_t most = 0;
  for (const Profile& profile : profiles) most = std::max(most, profile.positions.size());
  while ((most >> problem.low_band.level) > kMostValues) ++problem.low_band.level;
  return problem;
}

Model with(Model model, const std::vector<Added>& added) {
  for (const Added& effect : added)
    if (effect.candidate->raises_degree)
      remake_term(model, effect.name(), effect.candidate->options);
    else
      append_term(model, {effect.name(), effect.candidate->options, {}}, model.range);
  return model;
}

}  // namespace

std::vector<Added> all_but(std::vector<Added> added, std::size_t i) {
  added.erase(std::next(added.begin(), static_cast<std::ptrdiff_t>(i)));
  return added;
}

Extender::Extender(const Problem& problem, const std::vector<Profile>& profiles,
                   const FittedModel& declared)
    : declared_(declared) {
  const Problem search = for_search(problem, profiles);
  if (search.low_band.level != problem.low_band.level) coarser_ = fit_declared(search, profiles);
}

Extended Extender::extend(std::vector<Added> added) const {
  if (added.empty()) return {{base().model, base().fit}, {}};
  FittedModel with_effects = fitted(with(base().model, added), shapes_of(added));
  Extended out(std::move(with_effects), std::move(added));
  out.lost_centre_mm = lost_centre(out.model, out.fit);
  if (out.lost_centre_mm > 0.0) {
    leave_out_centre(out.model, out.lost_centre_mm);
    out.fit = fit(out.model, out.fit.estimate.shapes);
  }
  return out;
}

const ModelResult& Extender::summary(const Extended& extended) const {
  if (!extended.numbers) extended.numbers = summarised(extended);
  return *extended.numbers;
}

ModelResult Extender::summarised(const Extended& extended) const {
  if (!coarser_) return summarise(extended.model, extended.fit);
  const auto& [model, fit] = refitted(extended);
  return summarise(model, fit);
}

FittedModel Extender::refitted(const Extended& extended) const {
  Model model = with(declared_.model, extended.added);
  leave_out_centre(model, extended.lost_centre_mm);
  return fitted(std::move(model), shapes_of(extended.added));
}

FittedModel Extender::in_declared_band(Extended extended) const {
  if (coarser_) return refitted(extended);
  return extended;
}

Eigen::VectorXd Extender::shapes_of(const std::vector<Added>& added) const {
  const Eigen::VectorXd& own = base().fit.estimate.shapes;
  std::vector<double> all(own.begin(), own.end());
  for (const Added& effect : added) all.insert(all.end(), effect.shape.begin(), effect.shape.end());
  return Eigen::Map<const Eigen::VectorXd>(all.data(), std::ssize(all));
}

}  // namespace slideway
