#pragma once

#include <string>
#include <vector>

#include "slideway/identify/fit.hpp"

namespace slideway {

/// What the profiles alone say of the declared parameters, priors left out, each profile's offset
/// and tilt allowed for: rows * parameters = values, with errors of unit variance and no
/// correlation. Stacked, the rows of several problems are a joint fit of all their profiles.
struct Evidence {
  std::vector<std::string> parameters, units;  // "squareness.dbeta_xz", "rad"
  std::vector<std::vector<double>> rows;       // as many as are determined, each a coefficient per
                                               // parameter
  std::vector<double> values;
};

/// The evidence in a fit; linearised at the estimate where an effect has shapes. No rows where a
/// term is a curve: its amplitudes are no parameters.
Evidence evidence(const Model& model, const Solution& fit);

}  // namespace slideway
