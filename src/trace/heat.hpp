#pragma once

#include "slideway/identify/model.hpp"
#include "whitened.hpp"

namespace slideway {

/// Log evidence (nats) that heat which lifts and tilts the slide (ISO 230-3) adds to a model, with
/// x the slide coordinate and t the cutting time:
///   a (1 - exp(-t / τ_a)) + b x (1 - exp(-t / τ_b)),
/// at its best τ_a and τ_b, or the tilt alone. With k unknowns, 4 or 2, it gains
///   (fall of the white residual's square - k ln n) / 2,
/// the price a named effect pays. 0 where it does not pay or a profile has no cutting time.
double heat_lifts_and_tilts(const Model& model, const Whitened& data, const Linearisation& linear);

}  // namespace slideway
