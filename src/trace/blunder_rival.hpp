#pragma once

#include <vector>

#include "extended_model.hpp"

namespace slideway {

/// Whether an effect of all profiles leaves less of the residual than the blunder that leaves
/// least, or leaves no profile that disagrees: the sign of a drift, too, turns with the direction
/// of the cut. None outweighs a trace that is as long as no other, and as some in another unit.
/// REQUIRES a blunder.
bool explained_by_an_effect(const std::vector<Blunder>& blunders, ModelExtender& extender);

}  // namespace slideway
