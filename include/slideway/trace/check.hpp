#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "slideway/identify/design.hpp"
#include "slideway/identify/fault.hpp"
#include "slideway/identify/result.hpp"
#include "slideway/trace/confounding.hpp"

namespace slideway {

/// What a problem's profiles can and cannot determine, from where and how they were read alone.
struct DesignCheck {
  std::vector<std::string> effects;  // of the declared model
  DesignRank rank;
  std::vector<Confounding> confounding;  // of every effect, as confounding_of_all()
};

/// All that can be said of a problem before any fit.
struct ProblemCheck {
  std::filesystem::path path;
  Faults faults;                      // all that identify() would refuse, one after the other
  std::optional<Result> data;         // what the profiles are; none: there are faults
  std::optional<DesignCheck> design;  // the same
};

/// Reads a problem file and its profiles and finds every fault of both. What depends on a part with
/// a fault is not looked at.
ProblemCheck check_problem(const std::filesystem::path& path,
                           const std::optional<std::filesystem::path>& data_dir = std::nullopt);

}  // namespace slideway
