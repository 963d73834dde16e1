#include "problem_plan.hpp"

#include <algorithm>
#include <limits>
#include <set>

#include "slideway/base/text.hpp"

namespace slideway {
namespace {

constexpr std::string_view kOfThePlan = "like samples cost time_min";
constexpr std::string_view kOfTheCut = "name window surface start_s";
constexpr std::string_view kAsLike =
    "kind quantity position_column value_column position_unit value_unit base_mm center_mm z_mm "
    "overhang_mm feed_mm_per_min spindle_rpm cut_direction cut_radius_mm traverse_mm_per_s "
    "nose_radius_mm azimuth_deg instrument reversed level wavelet boundary free loss "
    "standard_uncertainty";
constexpr int kFewestSamples = 2, kMostSamples = 10'000'000;

using TomlTable = TomlValue::Table;

const TomlEntry* entry_of(const TomlTable& table, std::string_view key) {
  const auto found = std::ranges::find(table, key, &TomlEntry::key);
  return found == table.end() ? nullptr : &*found;
}

/// The tables of an array that Section has looked at.
std::vector<const TomlTable*> tables_of(const TomlTable& parent, std::string_view key) {
  std::vector<const TomlTable*> out;
  for (const TomlValue& each : std::get<TomlValue::Array>(entry_of(parent, key)->value.data))
    out.push_back(&std::get<TomlTable>(each.data));
  return out;
}

bool is_like(const Section& cut, const ProfileEntry& profile) {
  const Setup& setup = profile.profile.setup;
  const auto kind = cut.one_of("kind", "face slide"),
             quantity = cut.one_of("quantity", "height slope");
  return (!kind || (*kind == "face") == (setup.kind == Kind::face)) &&
         (!quantity || (*quantity == "height") == (setup.quantity == Quantity::height));
}

/// Index of the profile a cut is like; none of its kind and quantity: how many there are.
std::size_t like_which(const Section& cut, const std::vector<ProfileEntry>& profiles) {
  const auto wanted = cut.text("like");
  std::vector<std::string> names;
  for (std::size_t i = 0; i < profiles.size(); ++i) {
    names.push_back(profiles[i].profile.name);
    if (is_like(cut, profiles[i]) && wanted.value_or(names.back()) == names.back()) return i;
  }
  if (wanted)
    cut.fail("like", "'" + printable(*wanted) + "' is no profile of this kind and quantity" +
                         did_you_mean(*wanted, names) + "; accepted: " + joined(names, " "));
  return profiles.size();
}

/// What a cut says, and behind it what it leaves to the profile it is like.
TomlTable completed(const TomlTable& cut, const TomlTable* like) {
  TomlTable out;
  const std::vector<std::string> own = words(kOfThePlan), inherited = words(kAsLike);
  for (const TomlEntry& each : cut)
    if (std::ranges::count(own, each.key) == 0) out.push_back(each);
  if (like == nullptr) return out;
  for (const TomlEntry& each : *like)
    if (std::ranges::count(inherited, each.key) > 0 && entry_of(cut, each.key) == nullptr)
      out.push_back(each);
  const TomlEntry* quantity = entry_of(out, "quantity");
  const bool is_slope = quantity && std::get<std::string>(quantity->value.data) == "slope";
  const auto add = [&](const char* key, const char* word) {  // the file of `like` states its units
    if (entry_of(out, key) == nullptr) out.push_back({key, 0, {0, std::string(word)}});
  };
  add("position_unit", "mm");
  add("value_unit", is_slope ? "urad" : "um");
  return out;
}

/// A cut that is like no profile: nothing tells its positions and its noise.
void require_all(const Section& cut) {
  const char* const why =
      "which a cut needs that no profile of the problem is like in kind and quantity";
  if (!cut.has("window")) cut.missing("window", std::string("[first, last], ") + why);
  if (!cut.has("samples")) cut.missing("samples", std::string("a whole number, ") + why);
  if (!cut.has("standard_uncertainty"))
    cut.missing("standard_uncertainty", std::string("a number above 0, ") + why);
}

PlannedCut read_cut(const std::string& file, const Section& cut, const TomlTable& table,
                    const std::vector<const TomlTable*>& all, const ProfileDefaults& defaults,
                    const ProblemRules& rules, const std::vector<ProfileEntry>& profiles) {
  cut.accept(
      words(std::string(kOfThePlan) + " " + std::string(kOfTheCut) + " " + std::string(kAsLike)));
  const std::size_t like = like_which(cut, profiles);
  const bool is_new = like == profiles.size();
  if (is_new) require_all(cut);
  const TomlValue merged{cut.lines().at(""), completed(table, is_new ? nullptr : all[like])};
  PlannedCut out;
  out.entry = read_profile_entry(Section(file, "plan.cut", merged), defaults, rules);
  if (!is_new) out.like = profiles[like].profile.name;
  if (cut.has("samples") && !cut.has("window"))
    cut.missing("window", "[first, last], which samples belongs to");
  out.samples =
      static_cast<std::size_t>(cut.integer("samples", kFewestSamples, kMostSamples).value_or(0));
  out.cost = cut.not_negative("cost");
  out.time_min = cut.not_negative("time_min");
  return out;
}

}  // namespace

std::vector<PlannedCut> planned_cuts_of(const std::string& file, const TomlValue& tree,
                                        const ProfileDefaults& defaults, ProblemRules rules,
                                        const std::vector<ProfileEntry>& profiles) {
  const Section root(file, "", tree);
  const std::optional<Section> plan = root.table("plan");
  if (!plan) return {};
  plan->accept("cut");
  const std::vector<Section> sections = plan->tables("cut");
  if (sections.empty()) plan->missing("cut", "[[plan.cut]] tables");
  const auto& top = std::get<TomlTable>(tree.data);
  const std::vector<const TomlTable*> cuts =
      tables_of(std::get<TomlTable>(entry_of(top, "plan")->value.data), "cut");
  const std::vector<const TomlTable*> all = tables_of(top, "profile");
  rules.file_is_needed = false;
  std::set<std::string> names;
  for (const ProfileEntry& each : profiles) names.insert(each.profile.name);
  std::vector<PlannedCut> out;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    out.push_back(read_cut(file, sections[i], *cuts[i], all, defaults, rules, profiles));
    const std::string& name = out.back().entry.profile.name;
    if (!names.insert(name).second)
      sections[i].fail("name", "'" + name + "' is used twice; accepted: a name of its own");
  }
  return out;
}

}  // namespace slideway
