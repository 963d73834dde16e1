#pragma once

#include <string_view>
#include <utility>
#include <vector>

namespace slideway {

/// The files of problems/demo by their names, the problem first.
const std::vector<std::pair<std::string_view, std::string_view>>& example_files();

}  // namespace slideway
