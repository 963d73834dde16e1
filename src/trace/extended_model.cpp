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

Extender::Extender(const Problem& problem, const std::vector<Profile>& profiles)
    : base_(build_model(for_search(problem, profiles), profiles)), base_fit_(fit(base_)) {
  if (base_.observations.front().low_band.options().level != problem.low_band.level)
    declared_ = build_model(problem, profiles);
}

Extended Extender::extend(std::vector<Added> added) const {
  Extended out(std::move(added), base_, {});
  if (out.added.empty()) {
    out.fit = base_fit_;
    return out;
  }
  out.model = with(std::move(out.model), out.added);
  out.fit = fit(out.model, shapes_of(out.added));
  out.lost_centre_mm = lost_centre(out.model, out.fit);
  if (out.lost_centre_mm > 0.0) {
    leave_out_centre(out.model, out.lost_centre_mm);
    out.fit = fit(out.model, out.fit.estimate.shapes);
  }
  return out;
}

const FitResult& Extender::summary(const Extended& extended) const {
  if (!extended.numbers) extended.numbers = summarised(extended);
  return *extended.numbers;
}

FitResult Extender::summarised(const Extended& extended) const {
  if (!declared_) return summarise(extended.model, extended.fit);
  Model model = with(*declared_, extended.added);
  leave_out_centre(model, extended.lost_centre_mm);
  return summarise(model, fit(model, shapes_of(extended.added)));
}

Eigen::VectorXd Extender::shapes_of(const std::vector<Added>& added) const {
  std::vector<double> all(base_fit_.estimate.shapes.begin(), base_fit_.estimate.shapes.end());
  for (const Added& effect : added) all.insert(all.end(), effect.shape.begin(), effect.shape.end());
  return Eigen::Map<const Eigen::VectorXd>(all.data(), std::ssize(all));
}

}  // namespace slideway
