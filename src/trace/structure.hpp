#pragma once

#include "slideway/trace/trace.hpp"
#include "whitened.hpp"

namespace slideway {

/// Lack of fit: chance that noise alone leaves as much in the slow band of the profiles, outside
/// the model, as is there (parametric bootstrap, gamma distribution through its moments).
double lack_of_fit(const Whitened& data, const Linearisation& linear);

/// Describes what is left: a Gaussian process (Matérn 3/2, in cosines of the clock) outside the
/// model's span, on the clock with the largest evidence, or one of its own in every profile.
Unnamed describe_structure(const Model& model, const Whitened& data, const Linearisation& linear);

}  // namespace slideway
