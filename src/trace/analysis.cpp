#include "slideway/trace/analysis.hpp"

#include <string>

#include "fit_numbers.hpp"
#include "next_cut.hpp"
#include "outcome.hpp"
#include "slideway/base/error.hpp"
#include "slideway/identify/agreement.hpp"
#include "slideway/trace/unseen.hpp"

namespace slideway {
namespace {

constexpr std::size_t kMostBesideOneMore = 32;  // profiles: U falls by 1.5 %

template <typename Error>
[[noreturn]] void rethrow(const Problem& problem, const Error& error) {
  if (problem.path.empty()) throw error;
  throw Error(problem.path.string() + ": " + error.what());
}

/// Where the model is worth a plan: no profile is wrong, nothing is left unexplained, and there are
/// not so many profiles that one more changes little.
void add_next_cut(const Problem& problem, const std::vector<Profile>& profiles,
                  const FittedModel& fitted, Searched searched, TimeLimit& limit, Analysis& out) {
  TraceResult& trace = *out.trace;
  const ModelResult& model = *out.result.final;
  if (fitted.fit.linear.observations.size() > kMostBesideOneMore || trace.unfinished ||
      !trace.blunders.empty() || trace.verdict == TraceVerdict::unnamed || !model.converged ||
      !wants_another_cut(model, trace))
    return;
  const auto say = [&](const std::exception& error) {
    trace.notes.push_back("no further cut was tried on paper: " + std::string(error.what()));
  };
  try {
    if (!limit.allows([&] {
          trace.next_cut = next_cut(problem, profiles, fitted, model, std::move(searched));
        }))
      trace.not_looked_at.emplace_back("the cut to make next");
  } catch (const UsageError& error) {  // a planned cut lacks metadata
    say(error);
  } catch (const DataError& error) {  // or samples
    say(error);
  }
}

Analysis analysed(const Problem& problem, const std::vector<Profile>& profiles,
                  const AnalysisOptions& options, const Progress& progress) {
  const FittedModel declared = fit_declared(problem, profiles);
  Analysis out;
  out.result = identify_declared(problem, profiles, declared, options.scope, options.with_details);
  if (options.with_evidence) out.evidence = evidence(declared.model, declared.fit);
  const FittedModel* last = &declared;
  ClosedLoop loop;
  TimeLimit limit(problem.trace.time_limit_s);
  if (options.closes_loop) {
    loop = close_loop(problem, profiles, declared, limit, progress);
    last = &loop.last(declared);
  }
  if (options.scope != Scope::rank)
    set_final(problem, *last, loop.more_variance(), options.scope, options.with_details,
              out.result);
  if (!options.closes_loop) out.result.declared = out.result.final;
  if (options.closes_loop) {
    out.trace = std::move(loop.trace);
    for (TraceRound& round : out.trace->rounds)
      round.parameters =
          parameters_of(*out.result.final, term_name(round.accepted, round.profiles));
    const auto conflict =
        last == &declared ? std::nullopt : conflict_of_priors(declared.model, declared.fit);
    if (conflict)
      out.result.final->notes.push_back("of the declared model " + *conflict +
                                        ". An effect that was added may stand for a wrong prior");
    doubt_what_is_uncertain(*last, *out.result.final, *out.trace);
    say_unknown_causes(last->model, *out.trace);
    add_conditions(*last, *out.trace, out.result);
    add_next_cut(problem, profiles, *last, std::move(loop.searched), limit, out);
  }
  if (options.with_details)
    out.details =
        make_details(problem, declared, last == &declared ? nullptr : last, options.with_curves);
  leave_out_non_finite(out);
  round_drawn(out);
  return out;
}

}  // namespace

Analysis analyse(const Problem& problem, const std::vector<Profile>& profiles,
                 const AnalysisOptions& options, const Progress& progress) {
  try {
    return analysed(problem, profiles, options, progress);
  } catch (const UsageError& error) {
    rethrow(problem, error);
  } catch (const DataError& error) {
    rethrow(problem, error);
  }
}

TraceResult close_loop(const Problem& problem, const std::vector<Profile>& profiles,
                       const Progress& progress) {
  return *analyse(problem, profiles, {}, progress).trace;
}

bool is_negative(const Analysis& analysis) {
  return is_negative(analysis.result) || (analysis.trace && is_negative(*analysis.trace));
}

}  // namespace slideway
