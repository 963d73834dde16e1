#pragma once

#include <string>
#include <vector>

#include "slideway/identify/fit.hpp"

namespace slideway {

/// Whether the fitted profiles are of one machine, by check_profiles() and odd_repeats().
struct Disagreement {
  /// Probability that noise makes any pair differ as much as that which differs most: Bonferroni's
  /// bound, of the χ² of each pair over all effects; or any repeat from the others, if less.
  double p_value = 1.0;
  std::string odd_one;  // the one profile that every pair which differs has, or the one odd
                        // repeat; "": none
};

/// A pair differs where noise explains it with a probability below Gates::disagreement_p.
/// @param of_each  noise of each profile, none of it what they disagree by
Disagreement disagreement(const FittedModel& fitted, const std::vector<Noise>& of_each);

/// What to do about it.
std::string disagreement_advice(const Disagreement& found);

}  // namespace slideway
