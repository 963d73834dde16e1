#include "slideway/identify/problem.hpp"

#include <algorithm>
#include <limits>
#include <set>

#include "problem_assumed.hpp"
#include "problem_channel.hpp"
#include "problem_effect.hpp"
#include "problem_override.hpp"
#include "problem_profile.hpp"
#include "problem_section.hpp"
#include "problem_toml.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/identify/problem_tree.hpp"

namespace slideway {
namespace {

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
  problem.bodies = read_bodies(*section);
  try {
    static_cast<void>(problem.machine());
  } catch (const UsageError& error) {
    section->fail("body", error.what());
  }
  return defaults;
}

void check_lever_is_given(const Section& root, const Problem& problem) {
  const bool face =
      std::any_of(problem.profiles.begin(), problem.profiles.end(),
                  [](const ProfileEntry& entry) { return entry.profile.setup.kind == Kind::face; });
  const std::optional<Section> machine = root.table("machine");
  if (!face || (machine && machine->has("lever"))) return;
  const std::string what = "missing; a face needs it; accepted: " + std::string(kLevers);
  if (machine) machine->fail("lever", what);
  root.fail("machine.lever", what);
}

LowBandOptions read_low_band(const Section& root) {
  const std::optional<Section> section = root.table("low_band");
  if (!section) return {};
  section->accept(kLowBandKeys);
  return read_low_band(*section, {});
}

void read_profile_entries(const Section& root, const ProfileDefaults& defaults,
                          const ProblemRules& rules, Problem& problem) {
  std::set<std::string> names;
  for (const Section& section : root.tables("profile")) {
    problem.profiles.push_back(read_profile_entry(section, defaults, rules));
    const std::string& name = problem.profiles.back().profile.name;
    if (!names.insert(name).second)
      section.fail("name", "'" + name + "' is used twice; accepted: a name of its own");
  }
  if (problem.profiles.empty()) root.fail("profile", "missing; accepted: at least one [[profile]]");
}

std::optional<Runout> read_runout(const Section& root) {
  const std::optional<Section> section = root.table("runout");
  if (!section) return std::nullopt;
  section->accept("r_um p_um diameter_mm standard_uncertainty_um");
  Runout runout;
  runout.r_um = section->required("r_um", section->coordinate("r_um"), "a number");
  runout.p_um = section->required("p_um", section->coordinate("p_um"), "a number");
  runout.diameter_mm =
      section->required("diameter_mm", section->magnitude("diameter_mm"), "a number above 0");
  runout.standard_uncertainty_um = section->required(
      "standard_uncertainty_um", section->magnitude("standard_uncertainty_um"), "a number above 0");
  return runout;
}

TraceOptions read_trace(const Section& root, const std::vector<Channel>& channels,
                        Problem& problem) {
  TraceOptions options;
  const std::optional<Section> section = root.table("trace");
  read_candidates(section, channels, problem, options);
  if (!section) return options;
  std::vector<std::string> keys{"candidates", "candidate", "max_effects"};
  for (const Gate& gate : gate_table()) keys.emplace_back(gate.name);
  section->accept(keys);
  options.max_effects =
      section->integer("max_effects", 0, kHighestInteger).value_or(options.max_effects);
  for (const Gate& gate : gate_table()) {
    double& value = options.gates.*gate.value;
    value = section->number(gate.name).value_or(value);
    if (!(value >= gate.lower && value <= gate.upper))
      section->fail(gate.name, "out of range; accepted: from " + shortest(gate.lower) + " to " +
                                   shortest(gate.upper));
  }
  return options;
}

Problem problem_of(const TomlValue& tree, const std::filesystem::path& path,
                   const ProblemRules& rules) {
  const std::string file = path.string();
  const Section root(file, "", tree);
  root.accept("title machine low_band profile channel effects effect runout trace truth");
  Problem problem;
  problem.path = path;
  problem.title = root.text("title").value_or("");
  ProfileDefaults defaults = read_machine(root, problem);
  defaults.low_band = problem.low_band = read_low_band(root);
  read_profile_entries(root, defaults, rules, problem);
  check_lever_is_given(root, problem);
  read_effect_files(root, rules, problem);
  const std::vector<Channel> channels = read_channels(root, rules, problem);
  read_effects(root, channels, problem);
  if (problem.effects.empty() && rules.effect_is_needed)
    root.fail("effect", "missing; accepted: at least one [[effect]]");
  problem.runout = read_runout(root);
  problem.trace = read_trace(root, channels, problem);
  problem.truth = read_truth(root, channels, problem);
  problem.assumed = assumed_by(root, problem);
  return problem;
}

}  // namespace

Problem read_problem(const std::filesystem::path& path,
                     const std::optional<std::filesystem::path>& data_dir) {
  return read_problem(path, data_dir, {});
}

Problem read_problem(const std::filesystem::path& path,
                     const std::optional<std::filesystem::path>& data_dir,
                     std::span<const Override> overrides) {
  TomlValue tree = read_toml(path);
  for (const Override& override : overrides) put(override, path.string(), tree);
  return problem_of(tree, path, {path.parent_path(), data_dir, true});
}

Problem read_profiles_of_problem(const std::filesystem::path& path,
                                 const std::optional<std::filesystem::path>& data_dir) {
  return problem_of(read_toml(path), path, {path.parent_path(), data_dir, true, false});
}

Problem read_problem(const TomlValue& tree, const std::optional<std::filesystem::path>& data_dir) {
  return problem_of(tree, "problem", {{}, data_dir, false});
}

}  // namespace slideway
