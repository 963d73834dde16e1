#pragma once

#include <string>

#include "slideway/trace/plan.hpp"

namespace slideway {

/// What a design is good for: "tells thermal_drift from tool_wear; U of Δβxz 0.30 -> 0.08 µm/m".
std::string reason_of(const PlannedDesign& design);

}  // namespace slideway
