#pragma once

#include <memory>
#include <string>
#include <vector>

#include "slideway/effects/effect.hpp"

namespace slideway {

inline constexpr int kMostPolynomialDegree = 20;

// What a factory of the catalogue gets; terms/<name>.cpp defines make_<name>(const Request&).
struct Request {
  const std::string& name;
  const EffectOptions& options;
  const Machine& machine;
  const TravelRange& range;

  // Refuses every option that is set and not in the list; each factory calls it first.
  void accept_only(const std::vector<std::string>& accepted) const;

  // The body the options name, else the only carriage along the axis on the tool's branch.
  [[nodiscard]] int carriage(Axis axis) const;

  // The degree the options must give.
  [[nodiscard]] int degree(int lowest, int highest) const;
};

}  // namespace slideway
