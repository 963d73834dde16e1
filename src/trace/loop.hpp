#pragma once

#include "slideway/identify/fit.hpp"
#include "slideway/trace/trace.hpp"

namespace slideway {

struct ClosedLoop {
  TraceResult trace;
  std::optional<Fitted> extended;  // with the effects that were added; none: none was
};

/// @param declared  fit_declared() of the problem
ClosedLoop close_loop(const Problem& problem, const std::vector<Profile>& profiles,
                      const Fitted& declared, const Progress& progress);

}  // namespace slideway
