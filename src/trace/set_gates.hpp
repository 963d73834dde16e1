#pragma once

#include <string>

#include "set_statistics.hpp"
#include "widening.hpp"

/// Gates that an effect has to pass beside the others of a set: each gives the reason against it,
/// "" if there is none.
namespace slideway {

/// The residuals, in the units of the report, must fall. Where there are heights and slopes, the
/// mean of their relative squares counts.
std::string worsens(const ModelResult& without, const ModelResult& with);

/// An effect must help in the low band of the search. A carriage's polynomial comes near everything
/// smooth: it must outdo a process without a name, too.
std::string reason_against(SetStatistics& statistics, const Gates& gates,
                           const std::vector<AcceptedEffect>& effects, std::size_t which);

/// Gates::size, by the uncertainty that the report prints.
/// @param unnamed  what structure without a name adds to it; null: nothing
std::string too_small(ModelExtender& extender, const Gates& gates,
                      const std::vector<AcceptedEffect>& effects, std::size_t which,
                      const Widening* unnamed);

/// The candidate of a search that is this effect and passes, or null.
const TestedCandidate* find_tested(const SearchRound& round, const AcceptedEffect& effect,
                                   const Gates& gates);

/// Whether a candidate is of all profiles and an effect of the set is the same in some: together
/// they say what it is in those and in the rest.
bool has_part_in(const std::vector<AcceptedEffect>& effects, const TestedCandidate& candidate);

/// Whether a candidate finds so much that something is missing, whatever it is refused for: feed
/// marks apart, which every cut has.
bool finds_too_much(const TestedCandidate& each, const Gates& gates);

/// The best wave of a search that finds too much, though its line may be the image of another one;
/// null: none.
const TestedCandidate* folded_wave(const SearchRound& round, const Gates& gates);

}  // namespace slideway
