#pragma once

#include <map>
#include <string>
#include <vector>

namespace slideway {

// Exponents of the units that a unit is made of; rad, turns, % and 1 have none. A degree has: what
// cos() takes is in rad.
using UnitPowers = std::map<std::string, double>;

// "um/min", "mm^-2", "um/(m s)"; Hz is 1/s. Throws UsageError where it cannot be read.
UnitPowers powers_of(const std::string& unit);

// "um/s".
std::string spelled(const UnitPowers& powers);

// A number in a formula, and where it stands.
struct FormulaNumber {
  std::size_t first = 0, length = 0;
  double value = 0.0;
};

// Those that may carry a unit: all but those that laws are made of, 0 to 4 and 0.5.
std::vector<FormulaNumber> numbers_with_unit(const std::string& text);

}  // namespace slideway
