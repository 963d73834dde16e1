#pragma once

#include "problem_toml.hpp"
#include "slideway/identify/override.hpp"

namespace slideway {

/// Puts the value in. @throws UsageError  "file: key: what is wrong; accepted: ..."
void put(const Override& override, const std::string& file, TomlValue& root);

}  // namespace slideway
