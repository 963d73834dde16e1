#pragma once

#include <optional>
#include <string>
#include <vector>

#include "slideway/batch/manifest.hpp"
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

/// One item as it goes in.
struct PoolItem {
  std::string id, time;  // the manifest's; time may be empty
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

/// @param times  of the items, or nothing where they have none (read_times())
PooledMachine pool(const std::string& machine, const std::vector<PoolItem>& items,
                   const std::vector<std::optional<double>>& times);

/// The column `time` of a manifest: numbers as they are, or dates (2026-11-21, 2026-11-21T08:30,
/// 2026-11-21 08:30:00Z) in days since 1970.
struct Times {
  std::vector<std::optional<double>> values;
  bool are_dates = false;
};
/// @throws DataError  "line 3: ..." neither, or some the one and some the other
Times read_times(const Manifest& manifest);

/// Pools a results file by the manifest's column `machine`, in the order of the first item of each.
/// @throws DataError  no column `machine`; the results cannot be read
std::vector<PooledMachine> pool_machines(const Manifest& manifest,
                                         const std::filesystem::path& results);

/// The machines for people, and as a JSON array. @param are_dates  as Times has it
std::string pooled_text(const std::vector<PooledMachine>& machines, bool are_dates);
std::string pooled_json(const std::vector<PooledMachine>& machines, bool are_dates);

}  // namespace slideway
