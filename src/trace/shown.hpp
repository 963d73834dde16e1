#pragma once

#include <string>
#include <vector>

#include "slideway/identify/fit.hpp"
#include "slideway/trace/trace.hpp"

namespace slideway {

/// An effect of one profile that its samples show for certain (Effect::shown_by()), and its low
/// band, too.
struct ShownEffect {
  DeclaredEffect effect;  // as the low band has it; harmonics with the values of the samples
  double p_value = 1.0;   // of the samples
  double depth = 0.0;     // sum of its amplitudes, mm
  /// Whether it is in the model before the search. Where the effect without options explains as
  /// much in each profile that shows it, one of all profiles is a matter of the search.
  bool is_settled = false;
};

/// Those of the candidates. Feed marks that samples resolve and the low band folds would else be a
/// noise or lines that nothing makes.
///
/// Its parameters have the values of the samples as priors: the low band, which folds and damps
/// them, knows them less. Those whose image neither stands out of its noise nor is a tenth of that
/// of all are left out. None is taken where all together are below half the noise of a value, or
/// where what the low band has faster than slow cosines holds less than half of them.
std::vector<ShownEffect> shown_by_samples(const Problem& problem, const FittedModel& declared);

/// Without those that a fit says are not there: their samples give nothing but bounds, the fit
/// knows them twice as well, and the sizes it finds are those of noise.
/// @param fitted  with them
std::vector<ShownEffect> without_absent(std::vector<ShownEffect> shown, const FittedModel& fitted);

/// The same, where one profile is meant in another way, its sign turned or its direction: of the
/// effects of its own only the size is known then, not the phase.
std::vector<ShownEffect> of_any_phase_in(std::vector<ShownEffect> shown,
                                         const std::string& profile);

/// Adds those that are settled, with their priors.
void append_settled(Model& model, const std::vector<ShownEffect>& shown);

/// The model with those of these effects that are settled, fitted, and a round for each of them as
/// if they had been added one after the other. The ends of the cuts, of those that are not as well,
/// are left out. REQUIRES one of them.
struct ShownModel {
  FittedModel fitted;
  std::vector<TraceRound> rounds;
};
ShownModel with_shown(const FittedModel& declared, const std::vector<ShownEffect>& shown);

}  // namespace slideway
