#pragma once

#include "slideway/identify/fit.hpp"
#include "slideway/identify/problem.hpp"
#include "slideway/identify/result.hpp"

namespace slideway {

enum class Scope { rank, fit, identify };

/// The main job on a problem and its profiles: low band, fit, ranking, cross-check. Scope::rank
/// leaves the fit and cross-check out of the result, Scope::fit the ranking and cross-check.
/// The final model is the declared one: the closed loop is not run.
/// @param declared     fit_declared() of the same
/// @param with_budget  as summarise() has it
/// @throws UsageError, DataError
Result identify(const Problem& problem, const std::vector<Profile>& profiles,
                const FittedModel& declared, Scope scope = Scope::identify,
                bool with_budget = false);
Result identify(const Problem& problem, const std::vector<Profile>& profiles,
                Scope scope = Scope::identify);

/// The same without a final model, its ranking and its cross-check. Scope::rank: with the ranking.
Result identify_declared(const Problem& problem, const std::vector<Profile>& profiles,
                         const FittedModel& declared, Scope scope, bool with_budget);

/// Puts what the data say of a model into such a result as the final one, and cross-checks it.
/// Where profiles disagree in an effect, uncertainties are widened by what the estimates without
/// one profile each differ by (delete-one jackknife; Efron 1982, Eq. 3.12).
/// @param more  what else widens uncertainties
void set_final(const Problem& problem, const FittedModel& fitted, const MoreVariance& more,
               Scope scope, bool with_budget, Result& result);

/// What the profiles are and whether their lines close, no more.
Result summarise_data(const Problem& problem, const std::vector<Profile>& profiles);

}  // namespace slideway
