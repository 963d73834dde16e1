#include "slideway/identify/problem.hpp"

#include <algorithm>
#include <limits>
#include <set>

#include "problem_assumed.hpp"
#include "problem_override.hpp"
#include "problem_profile.hpp"
#include "problem_section.hpp"
#include "problem_toml.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/identify/model.hpp"
#include "slideway/identify/problem_tree.hpp"

namespace slideway {
namespace {

constexpr int kHighestDegree = 99;
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

constexpr const char* kEffectOptions = "name body degree span_mm form resolution_mm profiles scope";

EffectOptions read_effect_options(const Section& section, const Problem& problem) {
  EffectOptions options{section.text("body"), section.integer("degree", 0, kHighestDegree),
                        section.magnitude("span_mm")};
  std::vector<std::string> names;
  for (const ProfileEntry& entry : problem.profiles) names.push_back(entry.profile.name);
  options.profiles = section.some_of("profiles", names).value_or(options.profiles);
  if (section.has("profiles") && options.profiles.empty())
    section.fail("profiles", "is empty; accepted: " + joined(names, " "));
  if (const auto form = section.one_of("form", "polynomial curve"))
    options.form = *form == "curve" ? Form::curve : Form::polynomial;
  options.resolution_mm = section.magnitude("resolution_mm");
  return options;
}

std::unique_ptr<Effect> made(const Section& section, const std::string& name,
                             const EffectOptions& options, const Problem& problem) {
  try {
    return make_effect(name, options, problem.machine(),
                       TravelRange{.beam_span_mm = problem.beam_span_mm});
  } catch (const UsageError& error) {
    section.fail("", error.what());
  }
}

/// The options of an effect with one size in all its profiles, or one for each of them that can see
/// it: with scope = "profile", and where the effect is of one profile each.
std::vector<EffectOptions> by_scope(const Section& section, const Effect& effect,
                                    const EffectOptions& options, const Problem& problem) {
  std::vector<EffectOptions> out;
  std::vector<const Setup*> setups;
  for (const ProfileEntry& entry : problem.profiles) {
    const std::string& name = entry.profile.name;
    const Setup& setup = entry.profile.setup;
    const bool named = options.profiles.empty() || std::ranges::count(options.profiles, name) > 0;
    if (!named || !effect.applies_to(setup)) continue;
    setups.push_back(&setup);
    out.push_back(options);
    out.back().profiles = {name};
  }
  const bool of_one = !setups.empty() && !effect.lacking_together(setups).empty() &&
                      std::ranges::all_of(setups, [&](const Setup* setup) {
                        return effect.lacking_together({setup}).empty();
                      });
  const std::string scope = section.one_of("scope", "all profile").value_or("all");
  return scope == "profile" || of_one ? out : std::vector{options};
}

std::string read_effect_name(const Section& section) {
  return section.required("name", section.one_of("name", effect_names()),
                          joined(effect_names(), " "));
}

std::vector<std::string> names_of(const std::vector<Parameter>& parameters) {
  std::vector<std::string> names;
  for (const Parameter& parameter : parameters) names.push_back(parameter.name);
  return names;
}

std::vector<Prior> read_priors(const Section& effect, const std::vector<std::string>& parameters) {
  std::vector<Prior> priors;
  for (const Section& section : effect.tables("priors")) {
    section.accept("parameter value standard_uncertainty");
    Prior prior;
    prior.parameter = section.required("parameter", section.one_of("parameter", parameters),
                                       joined(parameters, " "));
    prior.value = section.required("value", section.number("value"), "a number");
    prior.standard_uncertainty = section.required(
        "standard_uncertainty", section.positive("standard_uncertainty"), "a number above 0");
    priors.push_back(prior);
  }
  return priors;
}

bool is_same_effect(const DeclaredEffect& a, const DeclaredEffect& b) {
  const std::vector<std::string>&p = a.options.profiles, &q = b.options.profiles;
  const bool meet = p.empty() || q.empty() || std::ranges::find_first_of(p, q) != p.end();
  return a.name == b.name && meet &&
         (!a.options.body || !b.options.body || a.options.body == b.options.body);
}

void read_effects(const Section& root, Problem& problem) {
  for (const Section& section : root.tables("effect")) {
    section.accept(kEffectOptions + std::string(" priors"));
    DeclaredEffect effect;
    effect.name = read_effect_name(section);
    effect.options = read_effect_options(section, problem);
    const auto as_made = made(section, effect.name, effect.options, problem);
    effect.priors = read_priors(section, names_of(as_made->parameters()));
    for (const DeclaredEffect& other : problem.effects)
      if (is_same_effect(effect, other))
        section.fail("name",
                     "'" + effect.name + "' is declared twice for the same body and profile");
    for (const EffectOptions& each : by_scope(section, *as_made, effect.options, problem))
      problem.effects.push_back({effect.name, each, effect.priors});
  }
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

TraceOptions read_trace(const Section& root) {
  TraceOptions options;
  options.candidates = effect_names();
  const std::optional<Section> section = root.table("trace");
  if (!section) return options;
  std::vector<std::string> keys{"candidates", "max_effects"};
  for (const Gate& gate : gate_table()) keys.emplace_back(gate.name);
  section->accept(keys);
  std::vector<std::string> accepted = effect_names();
  accepted.emplace_back("all");
  const auto named = section->some_of("candidates", accepted);
  if (named && std::find(named->begin(), named->end(), "all") == named->end())
    options.candidates = *named;
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

/// The true value of a parameter, inside its bounds; one that is left out is 0, if that is
/// possible.
std::optional<double> read_true_value(const Section& section, const std::string& key,
                                      const Parameter& parameter) {
  const std::optional<double> value = section.number(key);
  const double used = value.value_or(0.0);
  if (!(used >= parameter.lower && used <= parameter.upper))
    section.fail(key, std::string(value ? "out of range" : "missing") + "; accepted: from " +
                          shortest(parameter.lower) + " to " + shortest(parameter.upper) + " " +
                          parameter.unit);
  return value;
}

/// `parameters = { "squareness.dbeta_xz" = 2.8e-6 }`, against the declared effects.
std::map<std::string, double> read_true_parameters(const Section& truth, const Problem& problem) {
  const std::optional<Section> section = truth.table("parameters");
  if (!section) return {};
  std::map<std::string, Parameter> known;
  std::vector<std::string> accepted;
  for (const DeclaredEffect& declared : problem.effects) {
    const auto effect = make_effect(declared.name, declared.options, problem.machine(), {});
    for (const Parameter& parameter : effect->parameters()) {
      accepted.push_back(term_name(declared.name, declared.options.profiles) + "." +
                         parameter.name);
      known.emplace(accepted.back(), parameter);
    }
  }
  section->accept(accepted);
  std::map<std::string, double> values;
  for (const std::string& key : section->keys())
    values[key] = *read_true_value(*section, key, known.at(key));
  return values;
}

/// A [[truth.effect]]: every key that is no option is a parameter of the effect.
void read_hidden_effect(const Section& section, const Problem& problem, Truth& truth) {
  Truth::HiddenEffect hidden;
  hidden.name = read_effect_name(section);
  hidden.options = read_effect_options(section, problem);
  const auto effect = made(section, hidden.name, hidden.options, problem);
  std::vector<std::string> accepted = names_of(effect->parameters());
  for (const std::string& option : words(kEffectOptions)) accepted.push_back(option);
  section.accept(accepted);
  for (const Parameter& parameter : effect->parameters())
    if (const auto value = read_true_value(section, parameter.name, parameter))
      hidden.parameters[parameter.name] = *value;
  for (const EffectOptions& each : by_scope(section, *effect, hidden.options, problem))
    truth.effects.push_back({hidden.name, each, hidden.parameters});
}

std::optional<Truth> read_truth(const Section& root, const Problem& problem) {
  const std::optional<Section> section = root.table("truth");
  if (!section) return std::nullopt;
  section->accept("seed noise_um noise_correlation_mm samples parameters effect");
  Truth truth;
  truth.seed = static_cast<std::uint64_t>(section->integer("seed", 0, kHighestInteger).value_or(1));
  truth.noise_um = section->not_negative("noise_um").value_or(0.0);
  truth.noise_correlation_mm = section->not_negative("noise_correlation_mm").value_or(0.0);
  if (const auto samples = section->integer("samples", 2, 100'000'000))
    truth.samples = static_cast<std::size_t>(*samples);
  truth.parameters = read_true_parameters(*section, problem);
  for (const Section& effect : section->tables("effect"))
    read_hidden_effect(effect, problem, truth);
  return truth;
}

Problem problem_of(const TomlValue& tree, const std::filesystem::path& path,
                   const ProblemRules& rules) {
  const std::string file = path.string();
  const Section root(file, "", tree);
  root.accept("title machine low_band profile effect runout trace truth");
  Problem problem;
  problem.path = path;
  problem.title = root.text("title").value_or("");
  ProfileDefaults defaults = read_machine(root, problem);
  defaults.low_band = problem.low_band = read_low_band(root);
  read_profile_entries(root, defaults, rules, problem);
  check_lever_is_given(root, problem);
  read_effects(root, problem);
  if (problem.effects.empty() && rules.effect_is_needed)
    root.fail("effect", "missing; accepted: at least one [[effect]]");
  problem.runout = read_runout(root);
  problem.trace = read_trace(root);
  problem.truth = read_truth(root, problem);
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
