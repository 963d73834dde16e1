#pragma once

#include <memory>
#include <string>
#include <vector>

#include "slideway/effects/effect.hpp"

namespace slideway {

/// Names of all effects, the carriage's own first, in the order of the registration list.
const std::vector<std::string>& effect_names();

/// Makes an effect of the catalogue, or the user's own that the options make.
/// @throws UsageError  a name that is not in it (with the nearest one that is), an option the
/// effect
///                     does not take or needs and lacks, a body that is not there or moves along
///                     another axis
std::unique_ptr<Effect> make_effect(const std::string& name, const EffectOptions& options,
                                    const Machine& machine, const TravelRange& range);

/// An effect of the catalogue to ask about itself: on the paper's lathe, with options it cannot do
/// without. REQUIRES a name of effect_names().
const Effect& specimen(const std::string& name);

/// Whether an effect is a part of E_ZX (ISO 230-1) under a name of its own.
bool is_part_of_straightness(const Description& effect);

/// Whether an effect is a drift of what measures, over the time of its readings.
bool is_drift_of_instrument(const Description& effect);

/// The options an effect of the catalogue cannot do without. REQUIRES a name of effect_names().
const EffectOptions& needed_options(const std::string& name);

/// Which error of the carriages a term ("straightness[upper]") or its parameter
/// ("squareness.dbeta_xz") is of; none for a name that is not in the catalogue.
MotionError motion_error_of(const std::string& name);

/// A term ("tool_wear", "step[feed2]") for people, with the profiles it is confined to. A name that
/// is not in the catalogue is the user's own: its words.
std::string plain_name(const std::string& term);

/// Whether a parameter ("straightness.b0") is fixed by a convention; see Parameter::by_convention.
bool fixed_by_convention(const std::string& parameter);

/// The effect a report gives parameters of: made with the least degree that has all of them.
/// @param parameters  "b2", "b3": without the name of the effect
/// @throws UsageError  no degree has them
std::unique_ptr<Effect> make_effect_with(const std::string& name,
                                         const std::vector<std::string>& parameters,
                                         const Machine& machine, const TravelRange& range);

}  // namespace slideway
