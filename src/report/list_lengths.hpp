#pragma once

#include <initializer_list>
#include <string>
#include <utility>

#include "document_node.hpp"
#include "slideway/trace/analysis.hpp"

/// Lists of a record that belong together, value by value, are of one length.
namespace slideway {

using NamedLength = std::pair<const char*, std::size_t>;

inline void check_lengths(const Node& node, const NamedLength& first,
                          std::initializer_list<NamedLength> others) {
  for (const auto& [key, length] : others)
    if (length != first.second)
      node[key].fail("as many numbers as " + std::string(first.first) + " has, " +
                     std::to_string(first.second));
}

template <typename T>
void check_lengths(const Node& /*node*/, const T& /*record*/) {}

inline void check_lengths(const Node& node, const StraightnessCurve& curve) {
  check_lengths(node, {"position_mm", curve.position_mm.size()},
                {{"deviation_um", curve.deviation_um.size()},
                 {"expanded_uncertainty_um", curve.expanded_uncertainty_um.size()}});
  check_lengths(node, {"tip_um", curve.tip_um.size()},
                {{"tip_expanded_uncertainty_um", curve.tip_expanded_uncertainty_um.size()}});
  if (!curve.tip_um.empty())
    check_lengths(node, {"position_mm", curve.position_mm.size()},
                  {{"tip_um", curve.tip_um.size()}});
}

inline void check_lengths(const Node& node, const ProfileCheck& check) {
  check_lengths(node, {"value_um", check.value_um.size()}, {{"U_um", check.U_um.size()}});
}

inline void check_lengths(const Node& node, const RunningSeries& running) {
  check_lengths(node, {"samples", running.samples.size()},
                {{"position_mm", running.position_mm.size()}, {"raw", running.raw.size()}});
  check_lengths(node, {"low_band_position_mm", running.low_band_position_mm.size()},
                {{"low_band", running.low_band.size()}});
}

inline void check_lengths(const Node& node, const UnnamedCurve& curve) {
  check_lengths(node, {"at", curve.at.size()},
                {{"residual", curve.residual.size()},
                 {"expanded_uncertainty", curve.expanded_uncertainty.size()}});
}

}  // namespace slideway
