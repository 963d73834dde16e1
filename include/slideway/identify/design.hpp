#pragma once

#include <string>
#include <vector>

#include "slideway/identify/model.hpp"
#include "slideway/identify/model_result.hpp"

namespace slideway {

/// What the stations of the fitted profiles determine of a model, whatever is read there.
struct DesignRank {
  std::vector<std::string> determined;  // parameters by name
  std::vector<UndeterminedDirection> undetermined;
};

/// Rank of the model's columns in the low bands, what is free in each trace taken out: shapes in
/// the middle of their ranges, every amplitude as large as the others, white noise.
/// @throws UsageError, DataError  as require_enough_data()
DesignRank rank_of_design(Model model);

}  // namespace slideway
