#pragma once

#include <string>
#include <vector>

#include "slideway/identify/fit.hpp"

namespace slideway {

/// What one source contributes to the uncertainty of a parameter; the squares of all lines of a
/// parameter add up to that of its standard uncertainty (GUM 5.1.2).
struct BudgetLine {
  std::string source;  // "noise of feed2, estimated from the residual"
  char type = 'A';     // evaluated by statistics (A) or otherwise (B), GUM 3.3.4
  double standard_uncertainty = 0.0;
};

struct Budget {
  std::string parameter, unit;
  std::vector<BudgetLine> lines;
};

/// One budget for each identifiable parameter.
std::vector<Budget> uncertainty_budget(const Model& model, const Solution& fit);

}  // namespace slideway
