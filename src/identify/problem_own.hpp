#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "problem_section.hpp"
#include "slideway/effects/channel.hpp"
#include "slideway/identify/problem.hpp"

namespace slideway {

/// Keys of every effect.
inline constexpr std::string_view kEffectOptions =
    "name body degree span_mm form resolution_mm harmonics each_half profiles scope";

/// A way to write down an effect that is not in the catalogue: its word in `name`, and its keys.
struct OwnKind {
  std::string_view name, keys;
  bool in_files = false;  // of effects alone, which know no profile and no log
  DeclaredEffect (*read)(const Section& section, const std::vector<Channel>& channels);
};

std::span<const OwnKind> own_kinds();

/// The kind a table names, or null.
const OwnKind* own_kind_of(const Section& section);

/// Refuses the name of an effect that another one has.
void check_name_is_free(const Section& section, std::string_view key, const std::string& name,
                        const std::vector<DeclaredEffect>& known);

}  // namespace slideway
