#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace slideway {

/// What is wrong with a problem: "problem.toml:12: profile.value_unit: what is wrong; accepted:
/// ...".
struct Fault {
  std::string message;      // one line, with file and line where they are known
  std::string file = {};    // the problem file; "": the fault is at no place of it
  int line = 0;             // 0: at none
  std::string key = {};     // that stands on the line; "": the table that lacks one
  bool is_of_key = false;   // the key itself, not its value
  bool is_of_data = false;  // of a data file, not of the problem
};

using Faults = std::vector<Fault>;

/// The line of a fault, and which part of it: the key, its value, or the whole line.
struct Excerpt {
  std::string line;
  std::size_t first = 0, count = 0;  // characters
};

/// Nothing where the fault is at no line of a file that can be read.
std::optional<Excerpt> excerpt_of(const Fault& fault);

}  // namespace slideway
