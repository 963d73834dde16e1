#include "effect_sample.hpp"

#include <vector>

#include "slideway/base/error.hpp"
#include "slideway/effects/catalogue.hpp"

namespace slideway {

std::unique_ptr<Effect> sample_effect(const std::string& name) {
  const Machine machine(Machine::paper_lathe(), Lever::paper);
  const std::vector<EffectOptions> attempts{
      {}, {std::nullopt, 3, std::nullopt}, {std::nullopt, std::nullopt, 1000.0}};
  for (std::size_t i = 0; i + 1 < attempts.size(); ++i) {
    try {
      return make_effect(name, attempts[i], machine, TravelRange{});
    } catch (const UsageError&) {  // it needs an option: the next attempt has another
    }
  }
  return make_effect(name, attempts.back(), machine, TravelRange{});
}

}  // namespace slideway
