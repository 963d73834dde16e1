#pragma once

#include <memory>
#include <string>

#include "slideway/effects/effect.hpp"

namespace slideway {

// b_0 + b_1 x and a curve about that line: cubic B-splines on even knots over the travel, as many
// as the resolution asks for and no more than 120; without a resolution 80 pieces.
std::unique_ptr<Effect> make_curved_straightness(int body, Description description,
                                                 const EffectOptions& options,
                                                 const TravelRange& range);

// What to measure where offset, slope or coefficients of a straightness are not determined.
std::string straightness_advice(const Effect& straightness, const UndeterminedPart& part);

// b_0 ... of Eq. (10): b_0 and b_1 are fixed by the reference line of ISO 230-1.
Parameter straightness_parameter(int degree, const TravelRange& range);

}  // namespace slideway
