#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "slideway/trace/analysis.hpp"

namespace slideway {

/// Reads a report back that json_report() wrote; json_report() of it makes the same bytes. Keys it
/// does not know are passed over.
/// @param name  what the text goes by in messages
/// @throws DataError  it is no JSON; a schema other than slideway.report/2; a key that is missing
///                    or of the wrong type, named by its place:
///                    "result.json: final.parameters[0].unit: ..."
Analysis parse_report(std::string_view text, const std::string& name);

/// The same of a file. @throws DataError  it cannot be read, too
Analysis read_report(const std::filesystem::path& path);

}  // namespace slideway
