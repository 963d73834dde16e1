#pragma once

#include <filesystem>

#include "slideway/trace/analysis.hpp"

namespace slideway {

/// Reads a report back that json_report() wrote; json_report() of it makes the same bytes. Keys it
/// does not know are passed over.
/// @throws DataError  the file cannot be read or is no JSON; a schema other than
///                    slideway.report/1; a key that is missing or of the wrong type, named by its
///                    place: "result.json: fit.parameters[0].unit: ..."
Analysis read_report(const std::filesystem::path& path);

/// The parameters an analysis ends with: those of the loop where it was closed, else of the fit,
/// else none.
const std::vector<FittedParameter>& final_parameters(const Analysis& analysis);

}  // namespace slideway
