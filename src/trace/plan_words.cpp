#include "plan_words.hpp"

#include <algorithm>
#include <cmath>

#include "slideway/base/text.hpp"

namespace slideway {
namespace {

constexpr std::size_t kNamed = 2;  // of each kind; the rest are counted
constexpr double kVisible = 0.9;   // of a U: a smaller fall is not worth a word
constexpr double kPerMetre = 1e6;  // rad as µm/m

/// "a", "a and b", "a, b and 3 more".
std::string listed(const std::vector<std::string>& all) {
  if (all.size() <= kNamed) return joined(all, " and ");
  return joined(std::vector<std::string>(all.begin(), all.begin() + kNamed)) + " and " +
         std::to_string(all.size() - kNamed) + " more";
}

struct InWords {
  double factor;
  std::string unit;
};
InWords unit_in_words(const std::string& unit) {
  if (unit == "rad") return {kPerMetre, " µm/m"};
  if (unit == "um") return {1.0, " µm"};
  return {1.0, unit.empty() ? "" : " " + unit};
}

std::string called(const PlannedQuantity& quantity) {
  return quantity.symbol.empty() ? quantity.name : quantity.symbol;
}

std::vector<std::string> determined(const PlannedDesign& design) {
  std::vector<std::string> out;
  for (const PlannedQuantity& each : design.quantities) {
    if (each.U_now || !each.U_planned) continue;
    const InWords unit = unit_in_words(each.unit);
    out.push_back(called(each) + " (U " + significant(unit.factor * *each.U_planned, 2) +
                  unit.unit + ")");
  }
  return out;
}

std::vector<std::string> told_apart(const PlannedDesign& design) {
  std::vector<std::string> out;
  for (const PlannedPair& each : design.pairs)
    if (each.told_apart) out.push_back(each.effect + " from " + each.rival);
  return out;
}

std::vector<std::string> shown(const PlannedDesign& design) {
  std::vector<std::string> out;
  for (const PlannedLimit& each : design.limits)
    if (!each.now && each.planned)
      out.push_back(each.effect + " (from " + significant(*each.planned, 2) + " " + each.unit +
                    " on)");
  return out;
}

/// The quantities whose U falls most, with both.
std::string falls(const PlannedDesign& design) {
  std::vector<const PlannedQuantity*> fallen;
  for (const PlannedQuantity& each : design.quantities)
    if (each.U_now && each.U_planned && *each.U_planned < kVisible * *each.U_now)
      fallen.push_back(&each);
  std::ranges::stable_sort(
      fallen, {}, [](const PlannedQuantity* each) { return *each->U_planned / *each->U_now; });
  std::vector<std::string> out;
  for (const PlannedQuantity* each : fallen) {
    const InWords unit = unit_in_words(each->unit);
    out.push_back("U of " + called(*each) + " " + significant(unit.factor * *each->U_now, 2) +
                  " -> " + significant(unit.factor * *each->U_planned, 2) + unit.unit);
    if (out.size() == kNamed) break;
  }
  return joined(out, ", ");
}

}  // namespace

std::string reason_of(const PlannedDesign& design) {
  std::vector<std::string> out;
  const auto say = [&](const std::string& before, const std::vector<std::string>& what) {
    if (!what.empty()) out.push_back(before + listed(what));
  };
  say(std::string(kDetermines), determined(design));
  say("tells ", told_apart(design));
  say("shows ", shown(design));
  say("makes testable: ", design.testable);
  if (const std::string U = falls(design); !U.empty()) out.push_back(U);
  if (out.empty()) out.emplace_back("brings little: no U falls by a tenth, no pair is told apart");
  if (design.cost) out.push_back("cost " + significant(*design.cost, 3));
  if (design.time_min) out.push_back(significant(*design.time_min, 3) + " min");
  return joined(out, "; ");
}

}  // namespace slideway
