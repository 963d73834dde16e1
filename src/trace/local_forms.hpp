#pragma once

#include <vector>

#include "slideway/identify/model.hpp"
#include "whitened.hpp"

namespace slideway {

/// Log evidence (nats) that up to three local forms of a variable x add to a model: a kink
/// max(x - p, 0), a bump exp(-((x - p)/w)²/2), or a smooth step (1 + tanh((x - p)/w))/2, one after
/// the other, each at its best place and width. A form with k unknowns gains
///   (fall of the white residual's square - k ln n) / 2,
/// k = 2 for a kink and 3 for the others: the price a named effect pays. 0 if none pays.
/// @param x  at the low-band values of every fitted profile, as slide_positions() and readings_of()
double local_forms(const std::vector<Eigen::VectorXd>& x, const Whitened& data,
                   const Linearisation& linear);

}  // namespace slideway
