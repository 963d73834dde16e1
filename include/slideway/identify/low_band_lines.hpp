#pragma once

#include <span>

#include "slideway/identify/model.hpp"

/// Lines of effects, as the low band of a profile shows them.
namespace slideway {

/// How often a wave goes up and down along a trace, of which a line counts what lies over the
/// radius of a face, or over the trace where the effect is of the measurement.
double cycles_along(const Setup& setup, const Effect& effect, const LineBand& line);

/// Whether an effect makes a wave of which the low band of a profile has fewer values a cycle than
/// Gates::values_per_cycle: it may fold it, and the nose of the tool takes off its crests.
bool is_too_fine(const Model& model, const ModelTerm& term, std::span<const double> shape,
                 const Observation& observation);

/// The same in any of several profiles that an effect acts on.
bool is_too_fine(const Model& model, const ModelTerm& term, std::span<const double> shape,
                 std::span<const Observation* const> observations);

}  // namespace slideway
