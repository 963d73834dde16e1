#pragma once

#include <utility>
#include <vector>

#include "search.hpp"

namespace slideway {

/// The data made white for a model that lacks what the candidates can bring, and their findings:
/// the noise is that of the hypothesis which adds the best of them, and every log whose error is
/// more than noise.
std::pair<Whitened, std::vector<Finding>> whiten_beside(const Model& model, const Solution& fit,
                                                        const FreeValues& undescribed,
                                                        const Candidates& candidates);

}  // namespace slideway
