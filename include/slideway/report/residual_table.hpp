#pragma once

#include <string>

#include "slideway/trace/analysis.hpp"

namespace slideway {

/// What is left without a name as a table of commas: its variable, the residual and the expanded
/// uncertainty U (95.45 %) of that, of the profile in which it stands out most. The lines in front,
/// which begin with #, say which; the first one names `source`.
/// @throws DataError  nothing is left without a name
std::string residual_table(const Analysis& analysis, const std::string& source);

}  // namespace slideway
