#include "slideway/identify/problem.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include "problem_assumed.hpp"
#include "problem_channel.hpp"
#include "problem_effect.hpp"
#include "problem_override.hpp"
#include "problem_plan.hpp"
#include "problem_profile.hpp"
#include "problem_section.hpp"
#include "problem_toml.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/identify/problem_tree.hpp"

namespace slideway {
namespace {

constexpr std::string_view kAboutKeys =
    "machine serial manufacturer operator responsible instrument instrument_serial calibrated "
    "workpiece place country conditions customer laboratory certificate date remark";
constexpr double kFarthest = 1e6;  // mm: no slide is longer than a kilometre
constexpr int kHighestInteger = std::numeric_limits<int>::max();

constexpr std::string_view kLevers =
    "\"paper\" (one p_x = r for every term, Eq. (16)), \"split\" (pitch terms act on the constant "
    "overhang_mm, squareness on r)";

std::vector<Body> read_bodies(const Section& machine) {
  if (!machine.has("body")) return Machine::paper_lathe();
  std::vector<Body> bodies;
  for (const Section& section : machine.tables("body")) {
    section.accept("name lower axis");
    Body body;
    body.name = section.required("name", section.text("name"), "a name of its own");
    body.lower = section.required("lower", section.integer("lower", 0, kHighestInteger),
                                  "number of the adjacent lower body, 0 for the bed");
    const auto axis = section.required("axis", section.one_of("axis", "x y z"), "x y z");
    body.axis = axis == "x" ? Axis::x : axis == "y" ? Axis::y : Axis::z;
    bodies.push_back(body);
  }
  return bodies;
}

std::vector<Body> checked_bodies(const Section& machine, Lever lever) {
  std::vector<Body> bodies = read_bodies(machine);
  try {
    static_cast<void>(Machine(bodies, lever));
  } catch (const UsageError& error) {
    machine.fail("body", error.what());
  }
  return bodies;
}

ProfileDefaults read_machine(const Section& root, Problem& problem) {
  ProfileDefaults defaults;
  problem.bodies = Machine::paper_lathe();
  const std::optional<Section> section = root.table("machine");
  if (!section) return defaults;
  section->accept("lever overhang_mm spindle_position_mm span_mm body");
  if (section->one_of("lever", "paper split") == "split") problem.lever = Lever::split;
  defaults.lever = problem.lever;
  problem.beam_span_mm = section->magnitude("span_mm").value_or(0.0);
  defaults.overhang_mm = section->coordinate("overhang_mm").value_or(0.0);
  check_overhang(*section, defaults.overhang_mm, problem.lever);
  defaults.spindle_position_mm =
      section->coordinate("spindle_position_mm", kFarthest).value_or(0.0);
  section->attempt([&] { problem.bodies = checked_bodies(*section, problem.lever); });
  return defaults;
}

void check_lever_is_given(const Section& root, const Problem& problem) {
  const auto is_face = [](const ProfileEntry& entry) {
    return entry.profile.setup.kind == Kind::face;
  };
  const bool face = std::ranges::any_of(problem.profiles, is_face) ||
                    std::ranges::any_of(problem.planned, is_face, &PlannedCut::entry);
  const std::optional<Section> machine = root.table("machine");
  if (!face || (machine && machine->has("lever"))) return;
  const std::string what = "missing; a face needs it; accepted: " + std::string(kLevers);
  machine ? machine->refuse("lever", what) : root.refuse("machine.lever", what);
}

LowBandOptions read_low_band(const Section& root) {
  const std::optional<Section> section = root.table("low_band");
  if (!section) return {};
  section->accept(kLowBandKeys);
  return read_low_band(*section, {});
}

/// @return those that nothing is wrong with
std::vector<ProfileEntry> read_profile_entries(const Section& root, const ProfileDefaults& defaults,
                                               const ProblemRules& rules, Problem& problem) {
  std::set<std::string> names;
  std::vector<ProfileEntry> sound;
  const std::vector<Section> sections = root.tables("profile");
  for (const Section& section : sections) {
    const bool is_sound = section.attempt([&] {
      problem.profiles.push_back(read_profile_entry(section, defaults, rules));
      const std::string& name = problem.profiles.back().profile.name;
      if (!name.empty() && !names.insert(name).second)
        section.refuse("name", "'" + name + "' is used twice; accepted: a name of its own");
    });
    if (is_sound) sound.push_back(problem.profiles.back());
  }
  if (sections.empty()) root.refuse("profile", "missing; accepted: at least one [[profile]]");
  return sound;
}

/// Adds what reading these profiles refuses.
void read_for_faults(const Problem& problem, std::vector<ProfileEntry> profiles, Faults& faults) {
  Problem part;
  part.path = problem.path;
  part.profiles = std::move(profiles);
  static_cast<void>(read_profiles(part, faults));
}

std::optional<Runout> read_runout(const Section& root) {
  const std::optional<Section> section = root.table("runout");
  if (!section) return std::nullopt;
  section->accept("r_um p_um diameter_mm standard_uncertainty_um");
  Runout runout;
  const auto read = [&](const char* key, std::optional<double> value, const char* accepted,
                        double& out) {
    section->attempt([&] { out = section->required(key, value, accepted); });
  };
  read("r_um", section->coordinate("r_um"), "a number", runout.r_um);
  read("p_um", section->coordinate("p_um"), "a number", runout.p_um);
  read("diameter_mm", section->magnitude("diameter_mm"), "a number above 0", runout.diameter_mm);
  read("standard_uncertainty_um", section->magnitude("standard_uncertainty_um"), "a number above 0",
       runout.standard_uncertainty_um);
  return runout;
}

std::map<std::string, std::string> read_about(const Section& root) {
  const std::optional<Section> section = root.table("about");
  if (!section) return {};
  section->accept(kAboutKeys);
  std::map<std::string, std::string> about;
  for (const std::string& key : section->keys())
    if (const auto text = section->text(key)) about[key] = *text;
  return about;
}

Tolerance read_tolerance(const Section& root) {
  const std::optional<Section> section = root.table("tolerance");
  if (!section) return {};
  section->accept("flatness_um straightness_um squareness_um_per_m");
  return {section->magnitude("flatness_um"), section->magnitude("straightness_um"),
          section->magnitude("squareness_um_per_m")};
}

TraceOptions read_trace_options(const Section& root, const std::vector<Channel>& channels,
                                Problem& problem) {
  TraceOptions options;
  const std::optional<Section> section = root.table("trace");
  root.attempt([&] { read_candidates(section, channels, problem, options); });
  if (!section) return options;
  std::vector<std::string> keys{"candidates", "candidate", "max_effects", "time_limit_s"};
  for (const Gate& gate : gate_table()) keys.emplace_back(gate.name);
  section->accept(keys);
  options.max_effects =
      section->integer("max_effects", 0, kHighestInteger).value_or(options.max_effects);
  options.time_limit_s = section->magnitude("time_limit_s");
  for (const Gate& gate : gate_table()) {
    double& value = options.gates.*gate.value;
    value = section->number(gate.name).value_or(value);
    if (!(value >= gate.lower && value <= gate.upper))
      section->refuse(gate.name, "out of range; accepted: from " + shortest(gate.lower) + " to " +
                                     shortest(gate.upper));
  }
  return options;
}

/// Effects, and what names them. A file or an effect that was refused has no name: what would name
/// it is not read then.
void read_model(const Section& root, const ProblemRules& rules, Problem& problem) {
  std::vector<Channel> channels;
  const bool known = root.attempt([&] { read_effect_files(root, rules, problem); });
  root.attempt([&] { channels = read_channels(root, rules, problem); });
  if (!known) return;
  const bool declared = root.attempt([&] {
    read_effects(root, channels, problem);
    if (root.tables("effect").empty() && rules.effect_is_needed)
      root.refuse("effect", "missing; accepted: at least one [[effect]]");
  });
  root.attempt([&] { problem.trace = read_trace_options(root, channels, problem); });
  if (declared) root.attempt([&] { problem.truth = read_truth(root, channels, problem); });
}

Problem problem_of(const TomlValue& tree, const std::filesystem::path& path,
                   const ProblemRules& rules, Faults* faults = nullptr) {
  const std::string file = path.string();
  const Section root(file, "", tree, faults);
  root.accept(
      "title about tolerance machine low_band profile channel effects effect runout trace plan "
      "truth");
  Problem problem;
  problem.path = path;
  problem.title = root.text("title").value_or("");
  root.attempt([&] { problem.about = read_about(root); });
  root.attempt([&] { problem.tolerance = read_tolerance(root); });
  ProfileDefaults defaults;
  root.attempt([&] { defaults = read_machine(root, problem); });
  root.attempt([&] { defaults.low_band = problem.low_band = read_low_band(root); });
  std::vector<ProfileEntry> sound;
  root.attempt([&] { sound = read_profile_entries(root, defaults, rules, problem); });
  root.attempt(
      [&] { problem.planned = planned_cuts_of(file, tree, defaults, rules, problem.profiles); });
  root.attempt([&] { check_lever_is_given(root, problem); });
  read_model(root, rules, problem);
  root.attempt([&] { problem.runout = read_runout(root); });
  if (faults == nullptr || faults->empty())
    problem.assumed = assumed_by(root, problem);
  else
    read_for_faults(problem, std::move(sound), *faults);
  return problem;
}

}  // namespace

Problem read_problem(const std::filesystem::path& path,
                     const std::optional<std::filesystem::path>& data_dir) {
  return problem_of(read_toml(path), path, {path.parent_path(), data_dir, true});
}

Problem read_problem(const std::filesystem::path& path,
                     const std::optional<std::filesystem::path>& data_dir,
                     std::span<const Override> overrides) {
  TomlValue tree = read_toml(path, true);  // a batch ends what takes too long
  for (const Override& override : overrides) put(override, path.string(), tree);
  return problem_of(tree, path, {path.parent_path(), data_dir, true});
}

std::optional<Problem> read_problem(const std::filesystem::path& path,
                                    const std::optional<std::filesystem::path>& data_dir,
                                    Faults& faults) {
  const std::size_t before = faults.size();
  try {
    Problem problem = problem_of(read_toml(path), path, {path.parent_path(), data_dir}, &faults);
    if (faults.size() == before) return problem;
  } catch (const FaultError& error) {
    faults.push_back(error.fault);
  }
  return std::nullopt;
}

Problem read_profiles_of_problem(const std::filesystem::path& path,
                                 const std::optional<std::filesystem::path>& data_dir) {
  return problem_of(read_toml(path), path, {path.parent_path(), data_dir, true, false});
}

Problem read_problem(const TomlValue& tree, const std::optional<std::filesystem::path>& data_dir) {
  return problem_of(tree, "problem", {{}, data_dir, false});
}

}  // namespace slideway
