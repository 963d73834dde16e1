#pragma once

#include <memory>
#include <string>
#include <vector>

#include "slideway/effects/effect.hpp"

namespace slideway {

/// Names of all effects, the carriage's own first, in the order of the registration list.
const std::vector<std::string>& effect_names();

/// True for straightness, vertical_straightness and squareness: what the carriage model holds.
bool is_carriage_effect(const std::string& name);

/// Makes an effect of the catalogue.
/// @throws UsageError  a name that is not in it (with the nearest one that is), an option the
/// effect
///                     does not take or needs and lacks, a body that is not there or moves along
///                     another axis
std::unique_ptr<Effect> make_effect(const std::string& name, const EffectOptions& options,
                                    const Machine& machine, const TravelRange& range);

/// The coefficients b_first ... b_degree of a straightness alone: what one of degree first - 1
/// lacks. @throws UsageError as make_effect()
std::unique_ptr<Effect> make_straightness_terms(int first, const EffectOptions& options,
                                                const Machine& machine, const TravelRange& range);

}  // namespace slideway
