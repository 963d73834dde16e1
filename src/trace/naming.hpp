#pragma once

#include <string>
#include <vector>

#include "extended_model.hpp"

namespace slideway {

/// What has no name, in the place of some effects of a set.
struct UnnamedRival {
  std::string name;                      // "a process in t", "a local form"
  std::vector<std::size_t> in_place_of;  // the effects it replaces
  bool is_process = false;
  double behind = 0.0;  // log evidence of the set over that of the rival, nats
};

/// Rivals of a set S of named effects, log evidence in nats under one noise, N low-band values, k
/// unknowns of a name:
///   E(S) = fall of the white residual's square / 2 - sum of k / 2 ln N.
/// Its rivals, for subsets A of S that lack a name or more:
///   E(A) + ln E of the best process on top of A (process.hpp), on every variable,
///   E(A) + ln E of local forms on top of A (local_forms.hpp).
/// REQUIRES a set that is not empty.
std::vector<UnnamedRival> unnamed_rivals(ModelExtender& extender,
                                         const std::vector<AcceptedEffect>& effects);

/// By how much a carriage's polynomial, member `which` of a set, outdoes a process without a name
/// in its place, nats.
double gain_over_process(ModelExtender& extender, const std::vector<AcceptedEffect>& effects,
                         std::size_t which);

}  // namespace slideway
