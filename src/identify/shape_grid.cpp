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

/// REQUIRES profiles that live as long.
std::vector<Stations> stations_of(const std::vector<CoarseProfile>& profiles,
                                  const Machine& machine) {
  std::vector<Stations> out;
  for (const CoarseProfile& profile : profiles)
    out.emplace_back(profile.positions, profile.profile->setup, machine);
  return out;
}

/// Over what any of these stations can show.
std::pair<double, double> search_range(const Effect& effect, int shape,
                                       const std::vector<Stations>& stations) {
  std::pair<double, double> out{INFINITY, -INFINITY};
  for (const Stations& one : stations) {
    const auto [low, high] = effect.search_range(shape, one);
    out = {std::min(out.first, low), std::max(out.second, high)};
  }
  const Parameter& parameter = effect.parameters()[effect.shapes()[shape].parameter];
  return {std::max(out.first, parameter.lower), std::min(out.second, parameter.upper)};
}

}  // namespace

std::pair<double, double> shape_bounds(const Model& model, const ModelTerm& term, int shape) {
  const Effect& effect = *term.effect;
  const Parameter& parameter = effect.parameters()[effect.shapes()[shape].parameter];
  const std::pair<double, double> own{parameter.lower, parameter.upper};
  if (std::ranges::count(term.priors, parameter.name, &Prior::parameter) > 0) return own;
  const std::vector<CoarseProfile> profiles = profiles_that_show(model, term);
  if (profiles.empty()) return own;
  const std::vector<Stations> stations = stations_of(profiles, model.machine);
  const auto [low, high] = search_range(effect, shape, stations);
  const auto cycles = [&](double at) {
    const std::vector<double> shapes(effect.shapes().size(), at);
    const std::vector<LineBand> lines = effect.lines(stations.front(), shapes);
    return lines.empty() ? 0.0 : lines.front().high;
  };
  if (!(effect.resolution(shape, low, stations.front()) < high - low)) return own;
  constexpr double kFold = 2.0;  // a search stops at four values a cycle
  std::pair<double, double> out = own;
  if (cycles(low) > cycles(high)) out.first = std::max(own.first, low / kFold);
  if (cycles(high) > cycles(low)) out.second = std::min(own.second, high * kFold);
  return out;
}

std::vector<bool> bounds_met(const Model& model, const Eigen::VectorXd& shapes) {
  std::vector<bool> out;
  for (const ModelTerm& term : model.terms)
    for (int s = 0; s < static_cast<int>(term.effect->shapes().size()); ++s) {
      const auto [lower, upper] = shape_bounds(model, term, s);
      const double value = shapes[static_cast<Eigen::Index>(out.size())];
      const double near = 1e-9 * std::max(1.0, std::abs(value));
      out.push_back(value - lower < near || upper - value < near);
    }
  return out;
}

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
    const std::vector<Stations> stations = stations_of(profiles, model.machine);
    const auto [low, high] = search_range(effect, shape, stations);
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
