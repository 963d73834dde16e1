#include "slideway/identify/left_out.hpp"

#include <algorithm>
#include <cmath>

namespace slideway {
namespace {

/// Radii of the low-band values, and the width that one of them or one groove covers.
struct Radii {
  std::vector<double> radius, trace;
  double width = 0.0, largest = 0.0;

  Radii(const Observation& observation, const Machine& machine) {
    const Setup& setup = observation.profile->setup;
    const std::vector<double> positions =
        observation.low_band.positions(observation.profile->positions);
    const Stations stations(positions, setup, machine);
    for (Eigen::Index i = 0; i < stations.size(); ++i) {
      radius.push_back(stations.radius(i));
      trace.push_back(stations.trace(i));
      largest = std::max(largest, radius.back());
    }
    width = std::max((setup.last_mm - setup.first_mm) / static_cast<double>(positions.size()),
                     setup.feed_per_revolution().value_or(0.0));
  }

  [[nodiscard]] ValueIndices within(double centre, double reach) const {
    return those(radius, centre - reach, centre + reach);
  }

  /// Whose distance along the trace is so far below and above 0. None where that would be most of
  /// the trace: then its positions are wrong, not its centre.
  [[nodiscard]] ValueIndices at_axis(double below, double above) const {
    ValueIndices out = those(trace, -below, above);
    if (2 * out.size() > radius.size()) out.clear();
    return out;
  }

 private:
  static ValueIndices those(const std::vector<double>& places, double least, double most) {
    ValueIndices out;
    for (std::size_t i = 0; i < places.size(); ++i)
      if (places[i] >= least && places[i] <= most) out.push_back(static_cast<Eigen::Index>(i));
    return out;
  }
};

/// Radius out to which a nose cuts the curve visibly lower than it is; 0 if that is no matter of
/// the centre alone.
double lost_radius(const Radii& radii, const Observation& observation, const Gates& gates,
                   const Eigen::VectorXd& curve, double noise) {
  const double nose = observation.profile->setup.nose_radius_mm.value_or(gates.nose_radius_mm);
  const double height = std::sqrt(static_cast<double>(radii.radius.size()) /
                                  static_cast<double>(observation.low_band.samples()));
  double lost = 0.0;
  for (Eigen::Index i = 1; i < curve.size(); ++i) {
    const double slope = height * (curve[i] - curve[i - 1]) / (radii.trace[i] - radii.trace[i - 1]);
    if (0.5 * nose * slope * slope > height * noise)
      lost = std::max(lost, 0.5 * (radii.radius[i] + radii.radius[i - 1]));
  }
  return lost < gates.most_lost * radii.largest ? lost : 0.0;
}

}  // namespace

ValueIndices values_at_axis(const Observation& observation, const Machine& machine,
                            double axis_mm) {
  if (observation.profile->setup.kind != Kind::face) return {};
  const Radii radii(observation, machine);
  return radii.at_axis(radii.width + std::max(0.0, -axis_mm), radii.width + std::max(0.0, axis_mm));
}

ValueIndices undescribed_values(const Model& model, const Observation& observation,
                                const Eigen::VectorXd& curve, double noise) {
  const Setup& setup = observation.profile->setup;
  if (setup.kind != Kind::face) return {};
  const Radii radii(observation, model.machine);
  const double reach =
      std::max(radii.width, lost_radius(radii, observation, model.gates, curve, noise));
  return radii.at_axis(reach, reach);
}

ValueIndices values_beside_steps(const Model& model, const Estimate& estimate,
                                 const Observation& observation) {
  const Profile& profile = *observation.profile;
  if (profile.setup.kind != Kind::face) return {};
  const Radii radii(observation, model.machine);
  ValueIndices out;
  for (const ModelTerm& term : model.terms)
    for (std::size_t s = 0; s < term.effect->shapes().size(); ++s) {
      if (!term.effect->shapes()[s].stepwise || !term.acts_on(profile)) continue;
      const double place = estimate.shapes[term.first_shape + static_cast<Eigen::Index>(s)];
      const ValueIndices beside = radii.within(place, radii.width);
      out.insert(out.end(), beside.begin(), beside.end());
    }
  std::ranges::sort(out);
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

Eigen::VectorXd steep_curve(const Model& model, const Estimate& estimate,
                            const Observation& observation) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(observation.values.size());
  for (const ModelTerm& term : model.terms)
    if (term.effect->description().steep_at_centre)
      out += low_band_columns(model, term, observation, shapes_of(term, estimate.shapes)) *
             estimate.amplitudes.segment(term.first_amplitude, term.effect->amplitudes());
  return out;
}

double left_out_radius(const Model& model) {
  double largest = 0.0;
  for (const Observation& observation : model.observations) {
    if (observation.profile->setup.kind != Kind::face) continue;
    const Radii radii(observation, model.machine);
    for (const Eigen::Index row : left_out_values(observation))
      if (radii.radius[row] <= model.gates.most_lost * radii.largest)
        largest = std::max(largest, radii.radius[row]);
  }
  return largest;
}

}  // namespace slideway
