#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "command.hpp"

namespace slideway {

using CommandMaker = std::unique_ptr<Command> (*)();

/// Every command by its name, in the order of --help.
const std::vector<std::pair<std::string, CommandMaker>>& commands();

/// What the program says to who types its name alone.
std::string first_steps();

/// What --help without a command prints.
std::string program_help();

/// @throws UsageError  no command or option of that name
std::unique_ptr<Command> make_command(const std::string& wanted);

inline constexpr const char* kExitCodes =
    "0 done, 1 failed while working, 2 bad usage or bad problem file,\n"
    "3 unreadable or invalid data, 4 negative verdict (--strict only),\n"
    "5 batch finished with failed items";

}  // namespace slideway
