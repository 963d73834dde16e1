#pragma once

#include <optional>
#include <vector>

#include "problem_profile.hpp"
#include "problem_section.hpp"
#include "slideway/effects/channel.hpp"
#include "slideway/identify/problem.hpp"

/// What of a problem file is about effects. Each function needs what those before it have read.
namespace slideway {

/// The files `effects` names: their effects can be declared, looked for and simulated by name.
void read_effect_files(const Section& root, const ProblemRules& rules, Problem& problem);

/// [[effect]]
void read_effects(const Section& root, const std::vector<Channel>& channels, Problem& problem);

/// `candidates` and [[trace.candidate]]; without [trace] those of the default.
void read_candidates(const std::optional<Section>& trace, const std::vector<Channel>& channels,
                     Problem& problem, TraceOptions& options);

/// [truth]
std::optional<Truth> read_truth(const Section& root, const std::vector<Channel>& channels,
                                const Problem& problem);

}  // namespace slideway
