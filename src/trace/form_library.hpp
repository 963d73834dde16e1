#pragma once

#include <string>
#include <vector>

#include "slideway/effects/formula.hpp"
#include "slideway/identify/model.hpp"

namespace slideway {

/// What forms are written over, in the words of a formula.
struct FormVariable {
  std::string name, unit;        // "x", "mm"
  double low = 0.0, high = 0.0;  // of the readings
  double step = 0.0;             // between two low-band values, on average: nothing is narrower
  std::string size_unit = "um";  // of the readings: um, urad
};

/// A short formula with the grid that its shapes are searched on.
struct ShortForm {
  std::string name;  // "bump", "bump + step"
  Formula formula;
  std::vector<std::vector<double>> axes;
  bool is_local = false;  // worth a second one beside it: sum_of()
};

/// Straight and bent lines, exponentials, powers, a step, a kink, a bump, waves of one period and
/// of one that changes, and products of two of them.
std::vector<ShortForm> short_forms(const FormVariable& variable);

/// The sum of two that are local, by their names. Shapes of the first, then of the second.
ShortForm sum_of(const FormVariable& variable, const std::string& first, const std::string& second);

}  // namespace slideway
