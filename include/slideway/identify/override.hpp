#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "slideway/identify/problem.hpp"

namespace slideway {

/// A key of the problem file with another value. The key is the way to it, with dots between:
/// "title", "low_band.level"; in a list of tables the table's name leads on, "profile.feed2.file",
/// "effect.straightness.degree", "machine.body.x_carriage.axis" (a prior goes by its parameter:
/// "effect.straightness.priors.b2.value"). The value is text where the file has a text there, else
/// what it is in TOML, else text; a list is written as in TOML, [0.0, 10.0].
struct Override {
  std::string key, value;
};

/// read_problem() of the file with these keys put in, or put in the place of what is there. They
/// are checked as if they stood in the file.
/// @throws UsageError  as read_problem(); also for a way that leads nowhere
Problem read_problem(const std::filesystem::path& path,
                     const std::optional<std::filesystem::path>& data_dir,
                     std::span<const Override> overrides);

}  // namespace slideway
