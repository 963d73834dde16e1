#include "sample_residuals.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "dictionary.hpp"
#include "slideway/identify/linear_algebra.hpp"

namespace slideway {

SampleResiduals::Trace::Trace(const Observation& observation)
    : profile(observation.profile), low_band(&observation.low_band) {
  const std::vector<double>& positions = profile->positions;
  std::vector<Eigen::Index> undescribed;
  std::ranges::set_difference(left_out_values(observation), low_band->unmeasured(),
                              std::back_inserter(undescribed));
  if (!undescribed.empty()) {
    const double step =
        (positions.back() - positions.front()) / static_cast<double>(low_band->samples() - 1);
    const double half = std::ldexp(0.5 * step, low_band->options().level);
    const std::vector<double> places = low_band->positions(positions);
    const auto at = [&](double place) {
      return std::ranges::lower_bound(positions, place) - positions.begin();
    };
    for (const Eigen::Index value : undescribed) {
      const double place = places[static_cast<std::size_t>(value)];
      left_out.emplace_back(at(place - half), at(place + half) - at(place - half));
    }
  }
  const auto count = std::ssize(positions);
  level.resize(count, 2);
  level.col(0).setOnes();
  level.col(1) = Eigen::Map<const Eigen::VectorXd>(positions.data(), count);
  for (const auto& [first, those] : left_out) level.middleRows(first, those).setZero();
  level = orthonormal(std::move(level));
}

Eigen::VectorXd SampleResiduals::Trace::levelled(Eigen::VectorXd signal) const {
  for (const auto& [first, those] : left_out) signal.segment(first, those).setZero();
  project_out(level, signal);
  return signal;
}

SampleResiduals::SampleResiduals(const Model& model, const Solution& fit) : model_(model) {
  for (const Observation* observation : fit.linear.observations) {
    if (observation->low_band.options().level == 0) continue;
    Trace& trace = traces_.emplace_back(*observation);
    const Profile& profile = *trace.profile;
    Eigen::VectorXd rest =
        Eigen::Map<const Eigen::VectorXd>(profile.values.data(), std::ssize(profile.values));
    for (const ModelTerm& term : model.terms)
      rest -= effect_signal(
          model, term, profile,
          fit.estimate.amplitudes.segment(term.first_amplitude, term.effect->amplitudes()),
          shapes_of(term, fit.estimate.shapes));
    trace.residual = trace.levelled(std::move(rest));
  }
}

bool SampleResiduals::have(const Refined& effect) const {
  const ModelTerm& term = effect.candidate->term;
  // A form of so many amplitudes may have taken a part of a slower line.
  double smooth = 0.0;
  for (const ModelTerm& each : model_.terms)
    if (!each.effect->description().kinematic) smooth += each.effect->amplitudes();
  double fall = 0.0;
  for (const Trace& trace : traces_) {
    if (!term.acts_on(*trace.profile)) continue;
    const auto lines = term.effect->lines(trace.profile->stations(model_.machine), effect.shape);
    const bool may_be_folded =
        is_kinematic(*effect.candidate) ||
        std::ranges::any_of(lines, [&](const LineBand& line) { return line.low > smooth; });
    const double square = trace.residual.squaredNorm();
    if (!may_be_folded || square == 0.0) continue;
    const Eigen::VectorXd signal = trace.levelled(
        effect_signal(model_, term, *trace.profile, effect.projection.amplitudes, effect.shape));
    fall += (2.0 * trace.residual.dot(signal) - signal.squaredNorm()) / square;
  }
  return fall >= 0.0;
}

}  // namespace slideway
