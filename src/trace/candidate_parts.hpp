#pragma once

#include <vector>

#include "dictionary.hpp"
#include "slideway/identify/model.hpp"

namespace slideway {

/// The same effect in a part of the profiles, where several such parts show it: a step in one cut,
/// a warm-up that has faded in the next, the form that a disc was clamped to.
std::vector<Candidate> in_parts(const Model& model, const Candidate& whole);

/// Whether each part has a form of its own, so that the whole has none: it takes several traces of
/// a surface to show it, and the parts are together all profiles that the whole acts on.
bool has_forms_of_its_own(const Model& model, const Candidate& whole,
                          const std::vector<Candidate>& parts);

}  // namespace slideway
