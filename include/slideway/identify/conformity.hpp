#pragma once

#include <vector>

#include "slideway/identify/fit.hpp"
#include "slideway/identify/result.hpp"

namespace slideway {

/// ISO 14253-1 with the expanded uncertainty U as guard band: |value| + U within the limit
/// conforms, |value| - U beyond it does not, between the two it cannot be decided.
/// @param beside  by how much the value may be more or less besides
ConformityVerdict conformity_verdict(const QuantityValue& value, double limit, double beside = 0.0);

/// What a problem's [tolerance] asks, in the order flatness, straightness, squareness.
///
/// Flatness: peak to valley of the low band of a fitted face about its least-squares line (ISO
/// 12781-1 on one trace), of the largest; its U is that of the difference of two low-band values.
/// Values that the fit leaves out (a nub at the axis) may add what they do to it.
/// Not known where `free` has the tilt of a trace on one side of the axis only: then a cone is
/// levelled away. Straightness: E_ZX about the minimum zone lines, to which the
/// model's parts of E_ZX under other names (local_form, slide_periodic) that are not in it may add
/// their peak to valley. Squareness: its amount.
std::vector<Conformity> conformity_of(const Problem& problem, const FittedModel& fitted,
                                      const ModelResult& summary);

}  // namespace slideway
