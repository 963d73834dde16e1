#include "slideway/effects/catalogue.hpp"

#include <algorithm>

#include "request.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"

namespace slideway {

// effect_list.inc holds one SLIDEWAY_EFFECT(name) line per effect, written by CMakeLists.txt.
#define SLIDEWAY_EFFECT(name) std::unique_ptr<Effect> make_##name(const Request& request);
#include "effect_list.inc"
#undef SLIDEWAY_EFFECT
std::unique_ptr<Effect> make_straightness_terms(int first, const Request& request);

namespace {

using Factory = std::unique_ptr<Effect> (*)(const Request&);

constexpr Factory kFactories[] = {
#define SLIDEWAY_EFFECT(name) make_##name,
#include "effect_list.inc"
#undef SLIDEWAY_EFFECT
};

}  // namespace

const std::vector<std::string>& effect_names() {
  static const std::vector<std::string> kNames = {
#define SLIDEWAY_EFFECT(name) #name,
#include "effect_list.inc"
#undef SLIDEWAY_EFFECT
  };
  return kNames;
}

bool is_carriage_effect(const std::string& name) {
  return name == "straightness" || name == "vertical_straightness" || name == "squareness";
}

std::unique_ptr<Effect> make_effect(const std::string& name, const EffectOptions& options,
                                    const Machine& machine, const TravelRange& range) {
  const std::vector<std::string>& names = effect_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw UsageError("no effect '" + name + "'" + did_you_mean(name, names) + "; there are " +
                     joined(names));
  return kFactories[found - names.begin()]({name, options, machine, range});
}

std::unique_ptr<Effect> make_straightness_terms(int first, const EffectOptions& options,
                                                const Machine& machine, const TravelRange& range) {
  return make_straightness_terms(first, {"straightness", options, machine, range});
}

}  // namespace slideway
