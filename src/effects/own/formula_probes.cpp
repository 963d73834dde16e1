#include "formula_probes.hpp"

#include <algorithm>
#include <cmath>

#include "formula_parts.hpp"
#include "slideway/base/random.hpp"
#include "slideway/base/units.hpp"

namespace slideway {
namespace {

constexpr int kPlaces = 400;
constexpr double kRounding = 1e-9;  // of the largest value: what cancels loses digits
constexpr double kUnderflow = 1e-290;
constexpr double kSmallStep = 1e-5;  // of a shape's range
constexpr double kRarely = 0.02;     // changed by a small step, of those by a large one

double between(RandomStream& random, double low, double high) {
  return is_logarithmic(low, high) ? low * std::pow(high / low, random.uniform())
                                   : low + (high - low) * random.uniform();
}

/// The variables in the order of formula_variables(), of a cut as a workshop makes them.
std::vector<double> variables_at(RandomStream& random) {
  const double radius = between(random, 1.0, 500.0), r = radius * random.uniform();
  const double side = random.uniform() < 0.5 ? -1.0 : 1.0;
  const double feed = between(random, 0.5, 500.0), rpm = between(random, 10.0, 5000.0);
  const double t = between(random, 0.5, 5000.0);
  return {r,
          r + between(random, 0.1, 500.0),
          side * r,
          between(random, 0.0, 500.0),
          (2.0 * random.uniform() - 1.0) * kPi,
          t,
          between(random, 0.5, 5000.0),
          between(random, 0.5, 5000.0),
          t * rpm / kMinute,
          between(random, 0.01, 5000.0),
          radius,
          feed,
          rpm};
}

double parameter_at(const FormulaParameter& parameter, RandomStream& random) {
  if (parameter.lower && parameter.upper)
    return between(random, *parameter.lower, *parameter.upper);
  const double value = random.normal();
  if (parameter.lower) return *parameter.lower + std::abs(value);
  if (parameter.upper) return *parameter.upper - std::abs(value);
  return value;
}

}  // namespace

FormulaProbes::FormulaProbes(const Formula& formula, const Expression& expression)
    : parameters_(formula.parameters), evaluation_(expression), first_(formula_variables().size()) {
  RandomStream random(1, "formula");
  for (int i = 0; i < kPlaces; ++i) {
    std::vector<double> place = variables_at(random);
    std::vector<double> other = place;
    for (const FormulaParameter& parameter : parameters_) {
      place.push_back(parameter_at(parameter, random));
      other.push_back(parameter_at(parameter, random));
    }
    if (!std::isfinite(value(place)) || !std::isfinite(value(other))) continue;
    places_.push_back(std::move(place));
    others_.push_back(std::move(other));
  }
}

double FormulaProbes::value(const std::vector<double>& place) {
  std::ranges::copy(place, evaluation_.values().begin());
  return evaluation_.result();
}

bool FormulaProbes::are_linear(const std::vector<std::size_t>& parameters) {
  constexpr double kFactors[][2] = {{1.0, 1.0}, {-1.0, 2.0}, {1e3, 1e-3}};
  for (std::size_t i = 0; i < places_.size(); ++i) {
    std::vector<double> u = places_[i], v = u, sum = u, none = u;
    for (const std::size_t p : parameters) {
      v[first_ + p] = others_[i][first_ + p];
      none[first_ + p] = 0.0;
    }
    const double rest = value(none), of_u = value(u) - rest, of_v = value(v) - rest;
    for (const auto& [a, b] : kFactors) {
      for (const std::size_t p : parameters)
        sum[first_ + p] = a * u[first_ + p] + b * v[first_ + p];
      const double size = std::abs(a * of_u) + std::abs(b * of_v) + std::abs(rest);
      const double defect = std::abs(value(sum) - rest - a * of_u - b * of_v);
      if (!(defect <= kRounding * size + kUnderflow)) return false;
    }
  }
  return true;
}

bool FormulaProbes::moves_a_jump(std::size_t parameter) {
  const FormulaParameter& about = parameters_[parameter];
  const double step = kSmallStep * (*about.upper - *about.lower);
  std::size_t little = 0, much = 0;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    std::vector<double> moved = places_[i];
    const double here = value(moved);
    double& p = moved[first_ + parameter];
    p += p + step <= *about.upper ? step : -step;
    if (value(moved) != here) ++little;
    p = others_[i][first_ + parameter];
    if (value(moved) != here) ++much;
  }
  return static_cast<double>(little) <= kRarely * static_cast<double>(much);
}

std::optional<double> FormulaProbes::degree(const std::vector<double>& exponents,
                                            std::span<const std::size_t> sizes, std::size_t of) {
  constexpr double kScale = 2.0, kSame = 1e-6;
  std::optional<double> out;
  for (std::vector<double> place : places_) {
    for (const std::size_t size : sizes)
      if (size != of) place[size] = 0.0;
    std::vector<double> scaled = place;
    for (std::size_t i = 0; i < scaled.size(); ++i) scaled[i] *= std::pow(kScale, exponents[i]);
    const double here = value(place), there = value(scaled);
    if (std::abs(here) < kUnderflow || std::abs(there) < kUnderflow || !std::isfinite(there))
      continue;
    const double p = std::log(std::abs(there / here)) / std::log(kScale);
    if (there * here < 0.0 || std::abs(p - out.value_or(p)) > kSame) return std::nullopt;
    out = out.value_or(p);
  }
  return out;
}

bool FormulaProbes::vanishes_without(const std::vector<std::size_t>& parameters) {
  return std::ranges::all_of(places_, [&](std::vector<double> place) {
    const double size = std::abs(value(place));
    for (const std::size_t p : parameters) place[first_ + p] = 0.0;
    return std::abs(value(place)) <= kRounding * size + kUnderflow;
  });
}

}  // namespace slideway
