#pragma once

#include <vector>

#include "slideway/identify/fit.hpp"

namespace slideway {

/// A profile that is not measured yet, as a fit will see it.
struct ProfileToCome {
  const Observation* observation;  // its values are not looked at
  Noise noise;
};

/// A fit as it will be once these profiles are measured, too: the estimate as it is, rank and
/// uncertainties of all. What allow_for_others() has added stays.
/// @param model  with the terms of the fit
Solution with_profiles(const Model& model, const Solution& fit,
                       const std::vector<ProfileToCome>& more);

}  // namespace slideway
