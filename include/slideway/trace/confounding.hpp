#pragma once

#include <string>
#include <vector>

#include "slideway/identify/problem.hpp"

namespace slideway {

inline constexpr double kAlike = 0.9;  // share of the square from which on an effect is a lookalike

/// How much of an effect another one makes in the low bands of the fitted profiles, at its best
/// shape, after what is free in each trace has been taken out of both.
struct Lookalike {
  std::string effect;
  double share = 0.0;          // of the square, 0 to 1: in all profiles with one size
  double largest_alone = 0.0;  // and in that profile alone where it is largest
  std::string profile;
};

/// What the design of a problem, no value of a profile, says of one effect.
struct Confounding {
  std::string effect;
  std::string needs;                  // what it cannot be looked for without; "": nothing
  std::vector<Lookalike> lookalikes;  // those of 0.9 and more, in all profiles or in one
};

/// Of the effects of the catalogue and the problem's own, in that order, each at the middle of its
/// shapes.
/// @throws UsageError, DataError  as identify()
std::vector<Confounding> confounding_of_all(const Problem& problem,
                                            const std::vector<Profile>& profiles);

/// Of all own_effects of a problem, in order.
/// @throws UsageError, DataError  as identify()
std::vector<Confounding> confounding_of(const Problem& problem,
                                        const std::vector<Profile>& profiles);

}  // namespace slideway
