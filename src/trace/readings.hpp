#pragma once

#include <string>
#include <vector>

#include "slideway/identify/model.hpp"

/// Readings along the slide itself, and what may be in them beside its form.
namespace slideway {

bool reads_slide(const Observation* observation);

/// Whether the model has an effect of this name, in whichever profiles.
bool has_effect(const Model& model, const std::string& effect);

/// Errors of the readings of the slide that look like its form. At an even pace a drift of the zero
/// makes slopes so: read there and back, or reversed, only one of the two changes its sign. Of
/// heights it is the form of what they are measured against, which is asked only where faces do not
/// show the same: there the difference is laid to the workpiece.
std::vector<std::string> errors_of_readings(const Model& model);

}  // namespace slideway
