#pragma once

#include <map>
#include <string>

namespace slideway {

/// What slideway gets for the numbers the paper states, as text, by the names reproduction.md.in
/// has for them.
std::map<std::string, std::string> reproduced_numbers();

}  // namespace slideway
