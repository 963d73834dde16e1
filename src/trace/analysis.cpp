#include "slideway/trace/analysis.hpp"

#include <string>

#include "slideway/base/error.hpp"

namespace slideway {
namespace {

template <typename Error>
[[noreturn]] void rethrow(const Problem& problem, const Error& error) {
  if (problem.path.empty()) throw error;
  throw Error(problem.path.string() + ": " + error.what());
}

}  // namespace

Analysis analyse(const Problem& problem, const std::vector<Profile>& profiles,
                 const AnalysisOptions& options, const Progress& progress) {
  try {
    Analysis analysis{identify(problem, profiles, options.scope, options.evidence), std::nullopt};
    if (options.closes_loop) analysis.trace = close_loop(problem, profiles, progress);
    return analysis;
  } catch (const UsageError& error) {
    rethrow(problem, error);
  } catch (const DataError& error) {
    rethrow(problem, error);
  }
}

bool is_negative(const Analysis& analysis) {
  return is_negative(analysis.result) || (analysis.trace && is_negative(*analysis.trace));
}

}  // namespace slideway
