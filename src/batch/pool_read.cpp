#include <algorithm>
#include <charconv>
#include <chrono>
#include <map>
#include <nlohmann/json.hpp>

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
std::optional<double> parse_date(std::string_view text) {
  const auto year = digits(text, 4);
  const bool dash = take(text, "-");
  const auto month = digits(text, 2);
  const bool second_dash = take(text, "-");
  const auto day = digits(text, 2);
  if (!year || !month || !day || !dash || !second_dash) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(*year),
                                         std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(*day))};
  if (!date.ok()) return std::nullopt;
  double days = static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count());
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

/// The part of a line that a joint evaluation is made of.
PoolItem pool_item(const std::string& id, const std::optional<double>& time,
                   std::string_view line) {
  constexpr std::string_view kFrom = ",\"evidence\":", kTo = ",\"report\":";
  const std::size_t from = line.find(kFrom) + kFrom.size();
  const auto json = nlohmann::json::parse(line.substr(from, line.find(kTo, from) - from));
  return {id,
          time,
          {json.at("parameters").get<std::vector<std::string>>(),
           json.at("units").get<std::vector<std::string>>(),
           json.at("rows").get<std::vector<std::vector<double>>>(),
           json.at("values").get<std::vector<double>>()}};
}

bool is_sound(const PoolItem& item) {
  const std::size_t columns = item.evidence.parameters.size();
  return item.evidence.units.size() == columns &&
         item.evidence.rows.size() == item.evidence.values.size() &&
         std::all_of(item.evidence.rows.begin(), item.evidence.rows.end(),
                     [&](const auto& row) { return row.size() == columns; });
}

}  // namespace

Times read_times(const Manifest& manifest) {
  Times out;
  bool has_number = false;
  for (const ManifestItem& item : manifest.items) {
    out.values.emplace_back();
    if (item.time.empty()) continue;
    const std::optional<double> date = parse_date(item.time), number = parse_double(item.time);
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
  std::map<std::string, std::size_t> by_id;
  for (std::size_t i = 0; i < manifest.items.size(); ++i)
    if (!manifest.items[i].machine.empty()) by_id.emplace(manifest.items[i].id, i);
  if (by_id.empty())
    throw DataError(manifest.path.string() + ": names no machine; accepted: a column 'machine'");

  std::map<std::size_t, PoolItem> items;  // by the place in the manifest
  read_results(results, [&](const ResultHead& head, std::string_view line) {
    const auto at = by_id.find(head.id);
    if (at == by_id.end() || head.status != status::kOk) return;
    PoolItem item = pool_item(head.id, times.values[at->second], line);
    if (!is_sound(item))
      throw DataError(results.string() + ": id '" + printable(head.id, 60) +
                      "': its evidence is damaged");
    items.emplace(at->second, std::move(item));
  });

  std::map<std::string, std::vector<PoolItem>> machines;
  std::vector<std::string> order;
  for (auto& [place, item] : items) {
    const std::string& machine = manifest.items[place].machine;
    if (!machines.contains(machine)) order.push_back(machine);
    machines[machine].push_back(std::move(item));
  }
  std::vector<PooledMachine> out;
  for (const std::string& machine : order) out.push_back(pool(machine, machines[machine]));
  return out;
}

}  // namespace slideway
