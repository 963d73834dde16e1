#pragma once

#include "slideway/identify/fit.hpp"
#include "slideway/identify/problem.hpp"
#include "slideway/identify/result.hpp"

namespace slideway {

enum class Scope { rank, fit, identify };

/// The main job on a problem and its profiles: low band, fit, ranking, cross-check. Scope::rank
/// leaves the fit and cross-check out of the result, Scope::fit the ranking and cross-check.
/// @param declared  fit_declared() of the same
/// @throws UsageError, DataError
Result identify(const Problem& problem, const std::vector<Profile>& profiles,
                const FittedModel& declared, Scope scope = Scope::identify);
Result identify(const Problem& problem, const std::vector<Profile>& profiles,
                Scope scope = Scope::identify);

/// What the profiles are and whether their lines close, no more.
Result summarise_data(const Problem& problem, const std::vector<Profile>& profiles);

}  // namespace slideway
