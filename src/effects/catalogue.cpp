#include "slideway/effects/catalogue.hpp"

#include <algorithm>
#include <map>

#include "request.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"

namespace slideway {

// effect_list.inc holds one SLIDEWAY_EFFECT(name) line per effect, written by CMakeLists.txt.
#define SLIDEWAY_EFFECT(name) std::unique_ptr<Effect> make_##name(const Request& request);
#include "effect_list.inc"
#undef SLIDEWAY_EFFECT

namespace {

using Factory = std::unique_ptr<Effect> (*)(const Request&);

constexpr Factory kFactories[] = {
#define SLIDEWAY_EFFECT(name) make_##name,
#include "effect_list.inc"
#undef SLIDEWAY_EFFECT
};

struct Specimen {
  std::unique_ptr<Effect> effect;
  EffectOptions options;  // those it cannot do without
};

std::map<std::string, Specimen> make_specimens() {
  const Machine machine(Machine::paper_lathe(), Lever::paper);
  const TravelRange range{.beam_span_mm = 1000.0};
  std::map<std::string, Specimen> out;
  for (const std::string& name : effect_names()) {
    Specimen& own = out[name];
    try {
      own.effect = make_effect(name, own.options, machine, range);
    } catch (const UsageError&) {
      own.options.degree = 3;
      own.effect = make_effect(name, own.options, machine, range);
    }
  }
  return out;
}

const Specimen& specimen_of(const std::string& name) {
  static const std::map<std::string, Specimen> kSpecimens = make_specimens();
  return kSpecimens.at(name);
}

/// The specimen a term or a parameter is of, or null.
const Effect* effect_of(const std::string& name) {
  const std::string effect = name.substr(0, name.find_first_of(".["));
  return std::ranges::count(effect_names(), effect) > 0 ? &specimen(effect) : nullptr;
}

}  // namespace

const std::vector<std::string>& effect_names() {
  static const std::vector<std::string> kNames = {
#define SLIDEWAY_EFFECT(name) #name,
#include "effect_list.inc"
#undef SLIDEWAY_EFFECT
  };
  return kNames;
}

std::unique_ptr<Effect> make_effect(const std::string& name, const EffectOptions& options,
                                    const Machine& machine, const TravelRange& range) {
  const std::vector<std::string>& names = effect_names();
  if (options.own) {
    Request{name, options, machine, range}.accept_only({});
    return options.own(machine, range);
  }
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw UsageError("no effect '" + name + "'" + did_you_mean(name, names) + "; there are " +
                     joined(names));
  return kFactories[found - names.begin()]({name, options, machine, range});
}

const Effect& specimen(const std::string& name) { return *specimen_of(name).effect; }

bool is_part_of_straightness(const Description& effect) {
  return effect.motion == MotionError::none && effect.standard_name.starts_with("E_ZX,");
}

bool is_drift_of_instrument(const Description& effect) {
  return effect.of_instrument && effect.variable == IndependentVariable::reading_time &&
         !effect.measured;
}

const EffectOptions& needed_options(const std::string& name) { return specimen_of(name).options; }

MotionError motion_error_of(const std::string& name) {
  const Effect* effect = effect_of(name);
  return effect ? effect->description().motion : MotionError::none;
}

std::string plain_name(const std::string& term) {
  const std::size_t end = std::min(term.find('['), term.size());
  const Effect* effect = effect_of(term.substr(0, end));
  const std::string name =
      effect ? effect->description().plain_name : in_words(term.substr(0, end));
  return name + term.substr(end);
}

bool fixed_by_convention(const std::string& parameter) {
  const Effect* effect = effect_of(parameter);
  return effect && std::ranges::any_of(effect->parameters(), [&](const Parameter& p) {
           return p.by_convention && parameter.ends_with("." + p.name);
         });
}

std::unique_ptr<Effect> make_effect_with(const std::string& name,
                                         const std::vector<std::string>& parameters,
                                         const Machine& machine, const TravelRange& range) {
  for (int degree = 0;; ++degree) {
    auto effect = make_effect(name, {.degree = degree}, machine, range);
    if (std::ranges::all_of(parameters, [&](const std::string& each) {
          return std::ranges::count(effect->parameters(), each, &Parameter::name) > 0;
        }))
      return effect;
  }
}

}  // namespace slideway
