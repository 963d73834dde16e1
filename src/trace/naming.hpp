#pragma once

#include <limits>
#include <string>
#include <vector>

#include "extended_model.hpp"

namespace slideway {

/// How a set of named effects S stands against what has no name, in nats of log evidence under one
/// noise, N low-band values, k unknowns of a name:
///   E(S) = fall of the white residual's square / 2 - sum of k / 2 ln N.
/// Its rivals, for subsets A of S that lack a name or more:
///   E(A) + ln E of the best process on top of A (process.hpp), on every variable,
///   E(A) + ln E of local forms on top of A (local_forms.hpp).
struct Standing {
  double margin = std::numeric_limits<double>::infinity();  // beyond what the gates ask for
  std::string rival;                     // the nearest: "a process in t"; "": none
  std::vector<std::size_t> in_place_of;  // the effects it replaces
};

/// REQUIRES a set that is not empty.
Standing standing(ModelExtender& extender, const std::vector<AcceptedEffect>& effects,
                  const Gates& gates);

}  // namespace slideway
