#pragma once

#include <string>

namespace slideway {

/// The completion script of a shell, "bash" or "zsh", for every command and option there is.
/// @throws UsageError  another shell
std::string completion_script(const std::string& shell);

}  // namespace slideway
