#include "slideway/identify/shape_grid.hpp"

#include <algorithm>
#include <cmath>

namespace slideway {
namespace {

constexpr std::size_t kMostPoints = 8192;  // cuts hours apart have no phase in common

/// Stations of the low-band values of a fitted profile: what is finer cannot be told apart.
struct CoarseProfile {
  const Profile* profile = nullptr;
  std::vector<double> positions;
};

std::vector<CoarseProfile> profiles_that_show(const Model& model, const ModelTerm& term) {
  std::vector<CoarseProfile> out;
  for (const Observation& observation : model.observations) {
    const Profile& profile = *observation.profile;
    if (profile.role != Role::fit || !term.acts_on(profile)) continue;
    std::vector<double> positions = observation.low_band.positions(profile.positions);
    std::sort(positions.begin(), positions.end());
    out.push_back({&profile, std::move(positions)});
  }
  return out;
}

/// Between neighbouring radii of the profile with the most of them.
std::vector<double> places_between(const std::vector<CoarseProfile>& profiles,
                                   const Machine& machine) {
  const auto finest = std::max_element(
      profiles.begin(), profiles.end(),
      [](const auto& a, const auto& b) { return a.positions.size() < b.positions.size(); });
  const Stations stations(finest->positions, finest->profile->setup, machine);
  std::vector<double> radii;
  for (Eigen::Index i = 0; i < stations.size(); ++i) radii.push_back(stations.radius(i));
  std::sort(radii.begin(), radii.end());
  std::vector<double> out;
  for (std::size_t i = 1; i < radii.size(); ++i)
    if (radii[i] > radii[i - 1]) out.push_back(0.5 * (radii[i - 1] + radii[i]));
  return out;
}

}  // namespace

std::vector<double> every(std::size_t step, const std::vector<double>& axis) {
  std::vector<double> out;
  for (std::size_t i = 0; i < axis.size(); i += step) out.push_back(axis[i]);
  if ((axis.size() - 1) % step != 0) out.push_back(axis.back());
  return out;
}

std::vector<double> shape_grid(const Model& model, const ModelTerm& term, int shape) {
  const Effect& effect = *term.effect;
  const Shape& kind = effect.shapes()[shape];
  const Parameter& parameter = effect.parameters()[kind.parameter];
  if (kind.higher_order) return {0.0};
  const std::vector<CoarseProfile> profiles = profiles_that_show(model, term);
  std::vector<double> out;
  if (!profiles.empty() && kind.stepwise) out = places_between(profiles, model.machine);
  if (!profiles.empty() && !kind.stepwise) {
    std::vector<Stations> stations;
    double low = INFINITY, high = -INFINITY;
    for (const CoarseProfile& profile : profiles) {
      stations.emplace_back(profile.positions, profile.profile->setup, model.machine);
      const auto range = effect.search_range(shape, stations.back());
      low = std::min(low, range.first);
      high = std::max(high, range.second);
    }
    low = std::max(low, parameter.lower);
    high = std::min(high, parameter.upper);
    for (double value = low; value <= high && out.size() < kMostPoints;) {
      constexpr double kRounding = 1e-12;  // of the range, about zero
      out.push_back(std::abs(value) > kRounding * (high - low) ? value : 0.0);
      double step = INFINITY;
      for (const Stations& one : stations)
        step = std::min(step, effect.resolution(shape, value, one));
      if (!(step > 0.0 && std::isfinite(step))) break;
      value += step;
    }
  }
  if (out.empty())
    out.push_back(std::isfinite(parameter.lower) && std::isfinite(parameter.upper)
                      ? 0.5 * (parameter.lower + parameter.upper)
                      : parameter.scale);
  return out;
}

std::vector<std::vector<double>> shape_axes(const Model& model, const ModelTerm& term) {
  std::vector<std::vector<double>> axes;
  for (std::size_t s = 0; s < term.effect->shapes().size(); ++s)
    axes.push_back(shape_grid(model, term, static_cast<int>(s)));
  const auto points = [&] {
    double product = 1.0;
    for (const std::vector<double>& axis : axes) product *= static_cast<double>(axis.size());
    return product;
  };
  while (axes.size() > 1 && points() > static_cast<double>(kMostPoints)) {
    const auto longest = std::ranges::max_element(axes, {}, &std::vector<double>::size);
    *longest = every(2, *longest);
  }
  return axes;
}

}  // namespace slideway
