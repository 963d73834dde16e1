#pragma once

#include <optional>
#include <vector>

#include "slideway/identify/evidence.hpp"
#include "slideway/identify/identify.hpp"
#include "slideway/trace/details.hpp"
#include "slideway/trace/trace.hpp"

namespace slideway {

struct AnalysisOptions {
  Scope scope = Scope::identify;
  bool closes_loop = true;
  bool with_details = false;
  bool with_evidence = false;
};

/// All that is found in one problem.
struct Analysis {
  Result result;
  std::optional<TraceResult> trace;  // none where the loop was not asked for
  std::optional<Details> details;    // the same
  std::optional<Evidence> evidence;  // the same; of the declared model
};

/// Identifies the declared model and closes the loop: the whole way from profiles to verdict.
/// @throws UsageError, DataError  with the problem's path in front, where it has one
Analysis analyse(const Problem& problem, const std::vector<Profile>& profiles,
                 const AnalysisOptions& options = {}, const Progress& progress = {});

/// True if either part is negative for `--strict`.
bool is_negative(const Analysis& analysis);

}  // namespace slideway
