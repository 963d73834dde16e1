#pragma once

#include <memory>

#include "set_gates.hpp"
#include "slideway/identify/lack_of_fit.hpp"

namespace slideway {

/// Which effects the gates let into the model.
struct Selection {
  std::vector<AcceptedEffect> effects;                    // with their rivals
  std::vector<std::vector<AcceptedEffect>> instead;       // sets that explain as much
  std::vector<std::pair<std::string, std::string>> left;  // accepted, then taken back; why
  std::vector<std::string> notes, advice;
  LackOfFit lack_of_fit;            // of what these effects leave
  bool withheld = false;            // effects left because what has no name fits better
  std::vector<std::size_t> unsure;  // effects that what has no name may stand in place of
  /// Models that explain as much, one profile corrected in each; without observations.
  std::vector<std::shared_ptr<const FittedModel>> otherwise;
};

/// Adds effects one by one, each the best of a search; exchanges them for better ones; takes back
/// those that do not pass every gate beside the others as they are in the end; holds a carriage's
/// polynomial of a higher degree against the effects found without it or beside a lower one, and
/// the rest against what has no name (naming.hpp).
///
/// A round adds an effect or rules one out, and what has left stays out: with c names the search
/// ends after 2 c rounds at most. Every later step looks at subsets of what was found once. No set
/// of effects is searched twice (ModelExtender::search()).
Selection select_effects(const Problem& problem, SetStatistics& statistics, const Gates& gates,
                         const Progress& progress);

/// The declared model as it is: what is left of it, and no effect.
Selection nothing_selected(ModelExtender& extender, const Gates& gates);

}  // namespace slideway
