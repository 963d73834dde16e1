#pragma once

#include <optional>

#include "selection.hpp"

namespace slideway {

/// The smallest change of one gate within its range that changes the verdict.
///
/// The statistics that were held against a gate tell where a comparison turns over; nearest first
/// (by the logarithm of the ratio), the effects are selected once more with the gate there. None:
/// no such change does, of the nearest few.
std::optional<Fragile> smallest_change(const Problem& problem, SetStatistics& statistics,
                                       const Selection& selection, const Gates& gates);

}  // namespace slideway
