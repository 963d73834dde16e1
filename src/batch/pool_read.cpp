#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <tuple>

#include "slideway/base/date.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/batch/pool.hpp"
#include "slideway/batch/results.hpp"

namespace slideway {
namespace {

/// A number at the start of the text, which it is taken from.
std::optional<int> digits(std::string_view& text, std::size_t count) {
  int value = 0;
  const std::string_view part = text.substr(0, count);
  const auto [stop, error] = std::from_chars(part.data(), part.data() + part.size(), value);
  if (error != std::errc() || part.size() < count || stop != part.data() + count || part[0] == '-')
    return std::nullopt;
  text.remove_prefix(count);
  return value;
}

bool take(std::string_view& text, std::string_view any_of) {
  if (text.empty() || any_of.find(text[0]) == std::string_view::npos) return false;
  text.remove_prefix(1);
  return true;
}

/// "2026-11-21", behind it perhaps "T08:30" or "T08:30:15" (or a blank for the T) and a Z, in days.
std::optional<double> parse_time(std::string_view text) {
  constexpr std::size_t kDate = 10;  // characters
  const auto date = parse_date(text.substr(0, kDate));
  if (!date) return std::nullopt;
  text.remove_prefix(kDate);
  const auto days = static_cast<double>(std::chrono::sys_days(*date).time_since_epoch().count());
  if (text.empty()) return days;
  const bool separated = take(text, "T ");
  const auto hours = digits(text, 2);
  const bool colon = take(text, ":");
  const auto minutes = digits(text, 2);
  const auto seconds = take(text, ":") ? digits(text, 2) : 0;
  take(text, "Z");
  if (!separated || !colon || !hours || !minutes || !seconds || !text.empty() || *hours > 23 ||
      *minutes > 59 || *seconds > 60)
    return std::nullopt;
  return days + (*hours + (*minutes + *seconds / 60.0) / 60.0) / 24.0;
}

/// Whose an item is, and when it was measured.
struct Owner {
  std::size_t place = 0;  // in the order of the items
  std::string machine;
  std::optional<double> time;
};

bool is_sound(const Evidence& evidence) {
  const std::size_t columns = evidence.parameters.size();
  constexpr double kMost = 1e100;  // whose square, and a sum of them, is finite
  const auto is_possible = [](double number) { return std::abs(number) < kMost; };
  return evidence.units.size() == columns && evidence.rows.size() == evidence.values.size() &&
         std::ranges::all_of(evidence.values, is_possible) &&
         std::ranges::all_of(evidence.rows, [&](const std::vector<double>& row) {
           return row.size() == columns && std::ranges::all_of(row, is_possible);
         });
}

/// The part of a line that a joint evaluation is made of; none: it is damaged.
std::optional<Evidence> evidence_of(std::string_view line) {
  constexpr std::string_view kFrom = ",\"evidence\":", kTo = ",\"report\":";
  const std::size_t from = line.find(kFrom) + kFrom.size();
  try {
    const auto json = nlohmann::json::parse(line.substr(from, line.find(kTo, from) - from));
    Evidence out{json.at("parameters").get<std::vector<std::string>>(),
                 json.at("units").get<std::vector<std::string>>(),
                 json.at("rows").get<std::vector<std::vector<double>>>(),
                 json.at("values").get<std::vector<double>>()};
    if (is_sound(out)) return out;
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
  return std::nullopt;
}

using Owners = std::map<std::string, Owner>;  // by the id of the item

/// Pools what has an owner, in the order of the first item of each machine.
std::vector<PooledMachine> pool_owned(const std::filesystem::path& results, const Owners& owners) {
  std::map<std::size_t, std::pair<std::string, PoolItem>> items;
  read_results(results, [&](const ResultHead& head, std::string_view line) {
    if (head.status != status::kOk) return;
    const auto owner = owners.find(head.id);
    if (owner == owners.end()) return;
    std::optional<Evidence> evidence = evidence_of(line);
    if (!evidence)
      throw DataError(results.string() + ": id '" + printable(head.id, 60) +
                      "': its evidence is damaged");
    const auto& [place, machine, time] = owner->second;
    items.try_emplace(place, machine, PoolItem{head.id, time, std::move(*evidence)});
  });
  std::map<std::string, std::vector<PoolItem>> machines;
  std::vector<std::string> order;
  for (auto& [place, item] : items) {
    if (!machines.contains(item.first)) order.push_back(item.first);
    machines[item.first].push_back(std::move(item.second));
  }
  std::vector<PooledMachine> out;
  for (const std::string& machine : order) out.push_back(pool(machine, machines[machine]));
  return out;
}

}  // namespace

Times read_times(const Manifest& manifest) {
  Times out;
  bool has_number = false;
  for (const ManifestItem& item : manifest.items) {
    out.values.emplace_back();
    if (item.time.empty()) continue;
    const std::optional<double> date = parse_time(item.time), number = parse_double(item.time);
    out.values.back() = date ? date : number;
    (date ? out.are_dates : has_number) = true;
    if (!out.values.back() || !(*out.values.back() < 1e300 && *out.values.back() > -1e300) ||
        (out.are_dates && has_number))
      throw DataError(manifest.path.string() + ": line " + std::to_string(item.line) +
                      ": column 'time': '" + printable(item.time) +
                      "' is not accepted; accepted: 2026-11-21, 2026-11-21T08:30 or a number, all "
                      "of one kind");
  }
  return out;
}

std::vector<PooledMachine> pool_machines(const Manifest& manifest,
                                         const std::filesystem::path& results) {
  const Times times = read_times(manifest);
  Owners owners;
  for (std::size_t i = 0; i < manifest.items.size(); ++i) {
    const ManifestItem& item = manifest.items[i];
    if (!item.machine.empty()) owners.emplace(item.id, Owner{i, item.machine, times.values[i]});
  }
  if (owners.empty())
    throw DataError(manifest.path.string() + ": names no machine; accepted: a column 'machine'");
  return pool_owned(results, owners);
}

PooledResults pool_machines(const std::filesystem::path& results) {
  std::vector<ResultHead> heads;
  read_results(results, [&](const ResultHead& head, std::string_view) {
    if (!head.machine.empty()) heads.push_back(head);
  });
  PooledResults out;
  out.are_dates = std::ranges::any_of(
      heads, [](const ResultHead& head) { return parse_time(head.time).has_value(); });
  const auto time_of = [&](const ResultHead& head) {
    return out.are_dates ? parse_time(head.time) : parse_double(head.time);
  };
  std::ranges::sort(heads, {}, [&](const ResultHead& head) {
    return std::tuple(head.machine, time_of(head), head.id);
  });
  Owners owners;
  for (const ResultHead& head : heads)
    owners.emplace(head.id, Owner{owners.size(), head.machine, time_of(head)});
  out.machines = pool_owned(results, owners);
  return out;
}

}  // namespace slideway
