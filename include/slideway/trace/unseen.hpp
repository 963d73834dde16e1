#pragma once

#include <string>
#include <vector>

#include "slideway/effects/effect.hpp"
#include "slideway/identify/fit.hpp"
#include "slideway/identify/result.hpp"
#include "slideway/trace/trace.hpp"

/// What effects that the data do not show may do to the numbers.
namespace slideway {

/// A number that such an effect moves: Δβxz or E_ZX.
using MovedUnseen = std::optional<double> DetectionLimit::*;

/// The effect that moves it most while it is just not seen; null: of none is that known.
const DetectionLimit* worst_unseen(const TraceResult& trace, MovedUnseen number);

/// Effects whose columns an error of the carriages makes, but for the one that is so by Eq. (16).
std::vector<std::string> same_columns_as(MotionError error, const TraceResult& trace);

/// Says with the squareness, the straightness and their conformity which effects have the same
/// columns, or nearly: of faces same_columns_as(), and effects that are not in the model and of
/// which one standard uncertainty moves the form by more than its own (a squareness that nobody
/// declared; beside readings of the slide, a form of the workpiece); of readings of the slide the
/// error that looks like its form, and with the squareness, too, where it is a rival.
void add_conditions(const FittedModel& fitted, const TraceResult& trace, Result& result);

/// Whether such effects may move Δβxz, and E_ZX, by more than its U.
bool may_be_moved_unseen(const ModelResult& model, const TraceResult& trace);
bool may_be_bent_unseen(const ModelResult& model, const TraceResult& trace);

/// Whether a number is open that a further cut or trace may settle.
bool wants_another_cut(const ModelResult& model, const TraceResult& trace);

}  // namespace slideway
