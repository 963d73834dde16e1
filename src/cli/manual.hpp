#pragma once

#include <string>

#include "command.hpp"

namespace slideway {

/// The manual page slideway-COMMAND(1), in roff with the man macros; of --help's own words.
std::string manual_page(const Command& command, const std::string& version);

/// slideway(1).
std::string manual_page(const std::string& version);

}  // namespace slideway
