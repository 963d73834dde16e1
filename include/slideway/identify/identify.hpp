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

/// Puts what the data say of a model into a result as the final one, and cross-checks it.
void set_final(const Problem& problem, const FittedModel& fitted, ModelResult summary, Scope scope,
               Result& result);

/// What the profiles are and whether their lines close, no more.
Result summarise_data(const Problem& problem, const std::vector<Profile>& profiles);

}  // namespace slideway
