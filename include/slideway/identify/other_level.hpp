#pragma once

#include <optional>

#include "slideway/identify/model.hpp"

namespace slideway {

/// The same model on the low bands `by` levels further up (below 0: down). What stands where a
/// value is left out stays left out. None: a profile has no such level, or fewer than `least`
/// values there.
std::optional<Model> at_other_level(const Model& model, int by, Eigen::Index least);

}  // namespace slideway
