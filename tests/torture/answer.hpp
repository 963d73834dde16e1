#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drawn_problem.hpp"
#include "slideway/trace/analysis.hpp"

/// What must hold of every answer, whatever was asked.
namespace slideway {

/// What came of a problem: an analysis, or why there is none, in one line.
struct Answer {
  std::optional<Analysis> analysis;
  std::string refusal;
};
Answer answer_to(const ProblemFiles& files, const AnalysisOptions& options = {});

/// What is wrong with an analysis and with all that is written of it, one line each: a number that
/// is not finite, an expanded uncertainty that is not above 0, a line of text that is too long, a
/// report that does not read back as it was written.
std::vector<std::string> faults_of(const Analysis& analysis);

/// Writes everything that can be made of a report in JSON; throws nothing but the library's errors.
std::vector<std::string> faults_of_outputs(const Analysis& analysis);

}  // namespace slideway
