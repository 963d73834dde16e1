#pragma once

#include <string>

#include "slideway/trace/analysis.hpp"

namespace slideway {

/// A report and the name it goes by.
struct NamedReport {
  std::string name;
  Analysis analysis;
};

/// Two reports held against each other: final parameters,
/// their difference B - A in units of its expanded uncertainty, E_n = |B - A| / sqrt(U_A² + U_B²)
/// with the two taken as independent; and what else is not the same in inputs, options, verdicts.
/// @throws DataError  a parameter has one unit in A and another in B
std::string comparison_text(const NamedReport& a, const NamedReport& b);

/// The same as JSON, schema "slideway.diff/1".
std::string comparison_json(const NamedReport& a, const NamedReport& b);

}  // namespace slideway
