#include "slideway/trace/analysis.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "loop.hpp"
#include "slideway/base/error.hpp"

namespace slideway {
namespace {

template <typename Error>
[[noreturn]] void rethrow(const Problem& problem, const Error& error) {
  if (problem.path.empty()) throw error;
  throw Error(problem.path.string() + ": " + error.what());
}

/// What the structure without a name adds to the uncertainty of the parameters (widening.hpp).
void add_widening(const TraceResult& trace, std::vector<Budget>& budgets) {
  for (Budget& budget : budgets) {
    double rest = 0.0;
    for (const FittedParameter& parameter : trace.after)
      if (parameter.name == budget.parameter && parameter.standard_uncertainty)
        rest = std::pow(*parameter.standard_uncertainty, 2);
    for (const BudgetLine& line : budget.lines) rest -= std::pow(line.standard_uncertainty, 2);
    budget.lines.push_back({"structure without a name", 'A', std::sqrt(std::max(rest, 0.0))});
  }
}

}  // namespace

Analysis analyse(const Problem& problem, const std::vector<Profile>& profiles,
                 const AnalysisOptions& options, const Progress& progress) {
  try {
    const FittedModel declared = fit_declared(problem, profiles);
    Analysis analysis{identify(problem, profiles, declared, options.scope), {}, {}, {}};
    if (options.with_evidence) analysis.evidence = evidence(declared.model, declared.fit);
    ClosedLoop loop;
    if (options.closes_loop) {
      loop = close_loop(problem, profiles, declared, progress);
      analysis.trace = std::move(loop.trace);
    }
    if (options.with_details) {
      MoreVariance unnamed;
      if (loop.widening)
        unnamed = [&](const Eigen::RowVectorXd& row) { return loop.widening->variance(row); };
      analysis.details =
          make_details(problem, declared, loop.extended ? &*loop.extended : nullptr, unnamed);
      if (analysis.trace && analysis.trace->unnamed)
        add_widening(*analysis.trace, analysis.details->budget);
    }
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
