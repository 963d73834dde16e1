#pragma once

#include <optional>
#include <string>
#include <vector>

#include "slideway/identify/evidence.hpp"
#include "slideway/identify/result.hpp"

/// Joint evaluation of the items of one machine.
///
/// What the profiles of item i say of its parameters is A_i θ_i = y_i with errors of unit variance
/// (Evidence): stacked, with what is not the carriages' own left free in every item, that is the
/// least-squares fit of all profiles with one set of carriage parameters, and with levelling and
/// noise of each profile its own. Priors of the problem files take no part: they would count once
/// an item.
///
/// An item is held against the rest: v = y_i - A_i θ_rest, what the rest does not determine taken
/// out, is χ² distributed; E_n = sqrt(χ² / its 95.45 % quantile), which for one parameter is
/// |difference| / U(difference). Items can differ by more than their uncertainties know of: from
/// five items on, all uncertainties are multiplied by `scatter`, the square root of the median of
/// χ² / (its median), where that is above 1. An item whose χ² has a p-value below 0.05 / (number of
/// items) is left out, the worst first, and all are held against the rest again (Cox 2007, largest
/// consistent subset); never more than half. Where six items or more all have a time, the rest has
/// a drift: as many parameters again, times the time.
namespace slideway {

/// What one item brings to the joint evaluation.
struct PoolItem {
  std::string id;
  std::optional<double> time;  // days, or any unit
  Evidence evidence;
};

struct PooledItem {
  std::string id;
  std::optional<double> En;       // none: the rest determines nothing that it could be held against
  std::optional<double> p_value;  // of χ²
  bool fits = true;
};

/// One parameter of one machine over time, fitted to the items that determine it by themselves and
/// fit the rest: value = at_mean + rate (time - mean), weights 1 / (u² + τ²), with τ by the method
/// of moments (DerSimonian and Laird 1986) and Student's t.
struct Trend {
  std::string parameter, unit;
  std::size_t items = 0;
  double rate = 0.0, standard_uncertainty = 0.0, expanded_uncertainty = 0.0;  // unit per day or 1
  double p_value = 1.0;                                                       // of no trend
  double between_items = 0.0;                                                 // τ
};

struct PooledMachine {
  std::string machine;
  std::vector<PooledItem> items;
  std::vector<std::string> left_out;        // ids with other carriage parameters than the first
  std::vector<FittedParameter> parameters;  // of the items that fit
  double scatter = 1.0;
  std::vector<Trend> trends;  // where three items or more have a time
};

/// Whether a parameter is the machine's and not the item's: straightness, squareness.
bool is_carriage_parameter(const std::string& name);

PooledMachine pool(const std::string& machine, const std::vector<PoolItem>& items);

}  // namespace slideway
