#include "problem_effect.hpp"

#include <algorithm>
#include <limits>

#include "problem_own.hpp"
#include "problem_toml.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/identify/model.hpp"

namespace slideway {
namespace {

constexpr int kHighestDegree = 20;
constexpr std::size_t kMostHarmonic = 1000;
constexpr int kHighestSeed = std::numeric_limits<int>::max();

EffectOptions read_effect_options(const Section& section, const Problem& problem) {
  EffectOptions options{section.text("body"), section.integer("degree", 0, kHighestDegree),
                        section.magnitude("span_mm")};
  std::vector<std::string> names;
  for (const ProfileEntry& entry : problem.profiles) names.push_back(entry.profile.name);
  if (const auto profiles = section.some_of("profiles", names)) {
    if (profiles->empty()) section.refuse("profiles", "is empty; accepted: " + joined(names, " "));
    options.profiles = *profiles;
  }
  if (const auto form = section.one_of("form", "polynomial curve"))
    options.form = *form == "curve" ? Form::curve : Form::polynomial;
  options.resolution_mm = section.magnitude("resolution_mm");
  if (const auto harmonics =
          section.indices("harmonics", "must be a list of whole numbers from 1 on, rising"))
    for (const std::size_t each : *harmonics)
      options.harmonics.push_back(static_cast<int>(std::min<std::size_t>(each, kMostHarmonic)));
  options.each_half = section.flag("each_half").value_or(false);
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

/// The options of an effect with one size in all its profiles, one for each instrument, or one for
/// each profile that can see it: by `scope`, and where the effect is of one profile each. Where no
/// profile can see it, the options unchanged.
std::vector<EffectOptions> by_scope(const Section& section, const Effect& effect,
                                    const EffectOptions& options, const Problem& problem) {
  std::vector<EffectOptions> out;
  std::vector<const Setup*> setups;
  std::vector<const Profile*> seen;
  for (const ProfileEntry& entry : problem.profiles) {
    const std::string& name = entry.profile.name;
    const Setup& setup = entry.profile.setup;
    const bool named = options.profiles.empty() || std::ranges::count(options.profiles, name) > 0;
    if (!named || !effect.applies_to(setup)) continue;
    setups.push_back(&setup);
    seen.push_back(&entry.profile);
    out.push_back(options);
    out.back().profiles = {name};
  }
  const bool of_one = !setups.empty() && !effect.lacking_together(setups).empty() &&
                      std::ranges::all_of(setups, [&](const Setup* setup) {
                        return effect.lacking_together({setup}).empty();
                      });
  const std::string scope =
      section.one_of("scope", "all instrument profile")
          .value_or(effect.description().of_instrument ? "instrument" : "all");
  if (!out.empty() && (scope == "profile" || of_one)) return out;
  return scope == "instrument" ? of_each_instrument(options, seen) : std::vector{options};
}

std::vector<std::string> names_of(const std::vector<DeclaredEffect>& effects) {
  std::vector<std::string> names;
  for (const DeclaredEffect& effect : effects) names.push_back(effect.name);
  return names;
}

/// Words of `name`: the catalogue, what the problem knows besides, ways to write down another one.
std::vector<std::string> accepted_names(const Problem& problem) {
  std::vector<std::string> names = effect_names();
  std::ranges::move(names_of(problem.own_effects), std::back_inserter(names));
  for (const OwnKind& kind : own_kinds()) names.emplace_back(kind.name);
  return names;
}

std::vector<std::string> accepted_keys(const Section& section) {
  std::vector<std::string> keys = words(kEffectOptions);
  if (const OwnKind* kind = own_kind_of(section))
    std::ranges::move(words(kind->keys), std::back_inserter(keys));
  return keys;
}

/// Name and options of an effect that is in the catalogue, known by name, or written down here.
DeclaredEffect read_effect(const Section& section, const std::vector<Channel>& channels,
                           const Problem& problem) {
  const std::vector<std::string> names = accepted_names(problem);
  DeclaredEffect effect;
  effect.name = section.required("name", section.one_of("name", names), joined(names, " "));
  effect.options = read_effect_options(section, problem);
  const std::vector<DeclaredEffect>& known = problem.own_effects;
  if (const OwnKind* kind = own_kind_of(section)) {
    DeclaredEffect own = kind->read(section, channels);
    // A channel is an effect by its own name, too; one with a response of its own takes its place.
    if (section.has("as")) check_name_is_free(section, "as", own.name, known);
    effect.name = std::move(own.name);
    effect.options.own = std::move(own.options.own);
  } else if (const auto at = std::ranges::find(known, effect.name, &DeclaredEffect::name);
             at != known.end()) {
    effect.options.own = at->options.own;
  }
  return effect;
}

std::vector<std::string> names_of(const std::vector<Parameter>& parameters) {
  std::vector<std::string> names;
  for (const Parameter& parameter : parameters) names.push_back(parameter.name);
  return names;
}

std::vector<Prior> read_priors(const Section& effect, const std::vector<std::string>& parameters) {
  constexpr std::size_t kMost = 100;
  std::vector<Prior> priors;
  const std::vector<Section> tables = effect.tables("priors");
  if (tables.size() > kMost)
    effect.fail("priors", std::to_string(tables.size()) + " priors; accepted: up to " +
                              std::to_string(kMost) + ", one for each value known of a parameter");
  for (const Section& section : tables) {
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

void remember(const Section& section, const DeclaredEffect& effect, Problem& problem) {
  if (!own_kind_of(section)) return;
  std::erase_if(problem.own_effects,
                [&](const DeclaredEffect& other) { return other.name == effect.name; });
  problem.own_effects.push_back({effect.name, {.own = effect.options.own}, {}});
}

/// The true value of a parameter, inside its bounds; one that is left out is 0, if that is
/// possible.
std::optional<double> read_true_value(const Section& section, const std::string& key,
                                      const Parameter& parameter) {
  const std::optional<double> value = section.number(key);
  if (!value && section.has(key)) return value;
  const double used = value.value_or(0.0);
  if (!(used >= parameter.lower && used <= parameter.upper))
    section.refuse(key, std::string(value ? "out of range" : "missing") + "; accepted: from " +
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
    if (const auto at = known.find(key); at != known.end())
      if (const auto value = read_true_value(*section, key, at->second)) values[key] = *value;
  return values;
}

/// A [[truth.effect]]: every key that is no option is a parameter of the effect.
void read_hidden_effect(const Section& section, const std::vector<Channel>& channels,
                        const Problem& problem, Truth& truth) {
  const DeclaredEffect hidden = read_effect(section, channels, problem);
  const auto effect = made(section, hidden.name, hidden.options, problem);
  std::vector<std::string> accepted = names_of(effect->parameters());
  std::ranges::move(accepted_keys(section), std::back_inserter(accepted));
  section.accept(accepted);
  std::map<std::string, double> parameters;
  for (const Parameter& parameter : effect->parameters())
    if (const auto value = read_true_value(section, parameter.name, parameter))
      parameters[parameter.name] = *value;
  for (const EffectOptions& each : by_scope(section, *effect, hidden.options, problem))
    truth.effects.push_back({hidden.name, each, parameters});
}

}  // namespace

namespace {

/// An [[effect]]
void read_declared(const Section& section, const std::vector<Channel>& channels, Problem& problem) {
  std::vector<std::string> keys = accepted_keys(section);
  keys.emplace_back("priors");
  section.accept(keys);
  DeclaredEffect effect = read_effect(section, channels, problem);
  const auto as_made = made(section, effect.name, effect.options, problem);
  effect.priors = read_priors(section, names_of(as_made->parameters()));
  for (const DeclaredEffect& other : problem.effects)
    if (is_same_effect(effect, other))
      section.fail("name", "'" + effect.name + "' is declared twice for the same body and profile");
  for (const EffectOptions& each : by_scope(section, *as_made, effect.options, problem))
    problem.effects.push_back({effect.name, each, effect.priors});
  remember(section, effect, problem);
}

/// A [[trace.candidate]]
void read_candidate(const Section& section, const std::vector<Channel>& channels, Problem& problem,
                    TraceOptions& options) {
  section.accept(accepted_keys(section));
  const DeclaredEffect effect = read_effect(section, channels, problem);
  const auto as_made = made(section, effect.name, effect.options, problem);
  std::erase_if(options.own, [&](const DeclaredEffect& other) {
    return other.name == effect.name && other.options.profiles.empty();
  });
  std::erase(options.candidates, effect.name);
  std::vector<EffectOptions> looked_for = by_scope(section, *as_made, effect.options, problem);
  // Of several cuts that have it, each alone explains little: it is looked for in all of them
  // first. What acts in all profiles, the search takes apart itself.
  if (looked_for.size() > 1 && section.text("scope") == "profile") {
    if (effect.options.profiles.empty()) looked_for.clear();
    looked_for.insert(looked_for.begin(), effect.options);
  }
  for (EffectOptions& each : looked_for) options.own.push_back({effect.name, std::move(each), {}});
  remember(section, effect, problem);
}

}  // namespace

void read_effect_files(const Section& root, const ProblemRules& rules, Problem& problem) {
  for (const std::string& file : root.texts("effects"))
    root.attempt([&] {
      const std::filesystem::path path = resolved(root, "effects", file, rules);
      for (DeclaredEffect& effect : read_effect_file(path)) {
        check_name_is_free(root, "effects", effect.name, problem.own_effects);
        problem.own_effects.push_back(std::move(effect));
      }
      problem.beside.push_back(path);
    });
}

void read_effects(const Section& root, const std::vector<Channel>& channels, Problem& problem) {
  for (const Section& section : root.tables("effect"))
    section.attempt([&] { read_declared(section, channels, problem); });
}

void read_candidates(const std::optional<Section>& trace, const std::vector<Channel>& channels,
                     Problem& problem, TraceOptions& options) {
  std::vector<std::string> accepted = effect_names();
  const std::vector<std::string> shared = names_of(problem.own_effects);
  accepted.insert(accepted.end(), shared.begin(), shared.end());
  accepted.emplace_back("all");
  const auto named = trace ? trace->some_of("candidates", accepted) : std::nullopt;
  const bool all = !named || std::ranges::count(*named, "all") > 0;
  const auto is_wanted = [&](const std::string& name) {
    return all || std::ranges::count(*named, name) > 0;
  };
  std::ranges::copy_if(effect_names(), std::back_inserter(options.candidates), is_wanted);
  std::ranges::copy_if(problem.own_effects, std::back_inserter(options.own), is_wanted,
                       &DeclaredEffect::name);
  if (!trace) return;
  for (const Section& section : trace->tables("candidate"))
    section.attempt([&] { read_candidate(section, channels, problem, options); });
}

std::optional<Truth> read_truth(const Section& root, const std::vector<Channel>& channels,
                                const Problem& problem) {
  const std::optional<Section> section = root.table("truth");
  if (!section) return std::nullopt;
  section->accept("seed noise_um noise_correlation_mm samples parameters effect");
  Truth truth;
  truth.seed = static_cast<std::uint64_t>(section->integer("seed", 0, kHighestSeed).value_or(1));
  truth.noise_um = section->not_negative("noise_um").value_or(0.0);
  truth.noise_correlation_mm = section->not_negative("noise_correlation_mm").value_or(0.0);
  if (const auto samples = section->integer("samples", 2, 100'000'000))
    truth.samples = static_cast<std::size_t>(*samples);
  truth.parameters = read_true_parameters(*section, problem);
  for (const Section& effect : section->tables("effect"))
    effect.attempt([&] { read_hidden_effect(effect, channels, problem, truth); });
  return truth;
}

}  // namespace slideway
