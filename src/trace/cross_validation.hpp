#pragma once

#include "slideway/identify/fit.hpp"
#include "slideway/trace/trace.hpp"

namespace slideway {

/// A single profile predicted over gaps of several lengths, shortest first (Gates::most_blocks,
/// Gates::least_blocks): its low band is cut into blocks, every other block is predicted from the
/// least-squares fit of the others, and the other way round. Shapes move in first order. Empty
/// where several profiles are fitted.
///
/// @param before, after  without and with the effects that were added
std::vector<BlockPrediction> cross_validate(const Solution& before, const Solution& after,
                                            const Gates& gates);

/// Prediction if the error falls at every length of gap.
Gain gain_of(const std::vector<BlockPrediction>& predictions);

}  // namespace slideway
