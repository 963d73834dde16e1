#pragma once

#include "extended_model.hpp"
#include "slideway/identify/fit.hpp"
#include "slideway/trace/trace.hpp"
#include "time_limit.hpp"
#include "widening.hpp"

namespace slideway {

struct ClosedLoop {
  TraceResult trace;
  std::optional<Widening> widening;     // of the final fit; none: by nothing
  std::optional<FittedModel> extended;  // with the effects that were added; none: none was
  Searched searched;

  [[nodiscard]] const FittedModel& last(const FittedModel& declared) const {
    return extended ? *extended : declared;
  }
  /// By what a process without a name adds to uncertainties; while this lives.
  [[nodiscard]] MoreVariance more_variance() const {
    if (!widening) return {};
    return [this](const Eigen::RowVectorXd& row) { return widening->variance(row); };
  }
};

/// @param declared  fit_declared() of the problem
ClosedLoop close_loop(const Problem& problem, const std::vector<Profile>& profiles,
                      const FittedModel& declared, TimeLimit& limit, const Progress& progress);

}  // namespace slideway
