#pragma once

#include <string>
#include <vector>

#include "slideway/effects/effect.hpp"

namespace slideway {

/// What an effect does not keep of what every effect of the catalogue keeps, tried on a face cut
/// inward and outward, a diameter, and height, slope and slope over a base along a slide: it is
/// described; parameters have units and bounds; columns and derivatives are finite, the
/// derivatives those of central differences; zero amplitude gives zero; parameters and amplitudes
/// are inverse, linear as declared; searches stay inside the bounds. Empty: it keeps all.
std::vector<std::string> contract_faults(const Effect& effect);

}  // namespace slideway
