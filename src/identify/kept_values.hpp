#pragma once

#include "slideway/identify/model.hpp"
#include "slideway/identify/noise.hpp"

namespace slideway {

/// The rows of the values that are not left out, with their stations.
LinearProfile kept(LinearProfile profile, const Observation& observation);

}  // namespace slideway
