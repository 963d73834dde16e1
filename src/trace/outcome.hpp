#pragma once

#include "disagreement.hpp"
#include "extended_model.hpp"
#include "loop.hpp"
#include "search_round.hpp"

namespace slideway {

/// The candidates of a search for the report, without `except` (what was accepted; null: nothing).
/// @param before_rms_um  residual of the declared model
std::vector<TriedEffect> tried(const SearchRound& round, const Gates& gates,
                               const TestedCandidate* except, std::optional<double> before_rms_um);

/// The effect a candidate becomes, with the statistics of the search that found it.
AcceptedEffect as_accepted(const SearchRound& round, const TestedCandidate& choice,
                           const Gates& gates, std::optional<double> before_rms_um);

/// By how much what `chosen` outranks explains less, or more, than it: a note of each.
std::vector<std::string> outranked_by(const SearchRound& round, const TestedCandidate& chosen,
                                      const Gates& gates);

/// Why the form that the fit puts into the carriages cannot be theirs, or "": the run-out or a
/// good slide speak against it, and other effects make the same columns.
std::string form_of_another_cause(const TraceResult& out, const SquarenessCheck& check,
                                  const ModelResult& fit);

/// An effect in some profiles only is not said alone where profiles that it is in disagree with the
/// rest all the same: what is wrong with them may have made it.
/// @param among  of the profiles, with the effects; no odd one: any of them may be wrong
void doubt_what_some_have(const Disagreement& among, std::vector<AcceptedEffect>& effects);

/// An effect that is no longer so many times larger than its uncertainty as it must be, once that
/// holds its rivals, those of the others and what has no name, is not said alone.
void doubt_what_is_uncertain(const FittedModel& fitted, const ModelResult& final, TraceResult& out);

/// Of effects that were made from a form of what was left.
void say_unknown_causes(const Model& model, TraceResult& out);

/// With each candidate that passes every gate of its own: why it left again, or `otherwise`.
void say_why_refused(const std::string& otherwise, TraceResult& out);

/// What the data cannot show; of the problem's own effects with a note. A wave along the slide may
/// be the marks of a tool whose feed is not known.
void report_untestable(const Dictionary& dictionary, const Problem& problem, TraceResult& out);

/// Says what is left without a name, and widens the uncertainties by what it may be.
/// @param p_value  of the test that found it
/// @param wave     folded_wave(): null: none is left
void report_unnamed(const FittedModel& fitted, const Whitened& data, double p_value,
                    const std::vector<TestedCandidate>& tested, const TestedCandidate* wave,
                    ClosedLoop& closed);

TraceVerdict verdict(const TraceResult& out, bool other_cause);

}  // namespace slideway
