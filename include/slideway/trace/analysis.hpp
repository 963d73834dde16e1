#pragma once

#include <optional>
#include <string>
#include <string_view>
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
  bool with_curves = false;  // of the details
  bool with_evidence = false;
};

inline constexpr std::string_view kReportSchema = "slideway.report/2";

/// All that is found in one problem: what a report holds.
struct Analysis {
  Result result;
  std::optional<TraceResult> trace;  // none where the loop was not asked for
  Details details;                   // empty where they were not asked for
  std::optional<Evidence> evidence;  // the same; of the declared model; no part of the report
  std::string schema{kReportSchema};
};

/// Identifies the declared model and closes the loop: the whole way from profiles to verdict.
/// @throws UsageError, DataError  with the problem's path in front, where it has one
Analysis analyse(const Problem& problem, const std::vector<Profile>& profiles,
                 const AnalysisOptions& options = {}, const Progress& progress = {});

/// Takes the numbers that are not finite out of an analysis: a value that may be absent becomes
/// absent, any other NaN, and the notes of the part it belongs to name it.
void leave_out_non_finite(Analysis& analysis);

/// Rounds what is there to be drawn to the digits that are written of it, so that a picture is the
/// same before and after the report has been written and read.
void round_drawn(Analysis& analysis);

/// True if either part is negative for `--strict`.
bool is_negative(const Analysis& analysis);

}  // namespace slideway
