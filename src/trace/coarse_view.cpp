#include "coarse_view.hpp"

#include <numeric>

#include "process.hpp"

namespace slideway {

CoarseView::CoarseView(const FittedModel& fitted, const Whitened& under)
    : fitted_(&fitted), model_(take_in()), linear_(scaled()), data_(whitened(under)) {}

Model CoarseView::take_in() {
  const Model& from = fitted_->model;
  const std::vector<const Observation*>& observations = fitted_->fit.linear.observations;
  Model out{from.machine, from.range, {}, {}, from.gates};
  profiles_.reserve(observations.size());
  for (const Observation* observation : observations) {
    const double scale = scales_.emplace_back(low_band_scale(*observation));
    Profile& profile = profiles_.emplace_back();
    profile.name = observation->profile->name;
    profile.setup = observation->profile->setup;
    profile.surface = observation->profile->surface;
    profile.positions = observation->low_band.positions(observation->profile->positions);
    std::vector<double> numbers(profile.positions.size());  // evenly spaced, whatever lies there
    std::iota(numbers.begin(), numbers.end(), 0.0);
    out.observations.push_back({&profile, LowBand({.level = 0}, numbers),
                                observation->values / scale, observation->nuisances / scale,
                                observation->nuisance_names});
  }
  return out;
}

Linearisation CoarseView::scaled() const {
  Linearisation out = fitted_->fit.linear;
  for (std::size_t i = 0; i < scales_.size(); ++i) {
    out.observations[i] = &model_.observations[i];
    out.columns[i] /= scales_[i];
    out.residuals[i] /= scales_[i];
  }
  return out;
}

Whitened CoarseView::whitened(const Whitened& under) const {
  std::vector<Noise> noise;
  for (std::size_t i = 0; i < scales_.size(); ++i)
    noise.push_back(under.noise()[i].scaled(1.0 / (scales_[i] * scales_[i])));
  return {linear_, std::move(noise), under.undescribed()};
}

}  // namespace slideway
