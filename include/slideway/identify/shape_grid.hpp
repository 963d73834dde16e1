#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "slideway/identify/model.hpp"

namespace slideway {

/// Values of a shape parameter at which a search looks, increasing: over what the fitted profiles
/// can show in their low band, in steps of Effect::resolution(); for a stepwise shape every place
/// between two low-band values. The middle of the parameter's range where no profile shows it.
std::vector<double> shape_grid(const Model& model, const ModelTerm& term, int shape);

/// Bounds of a shape parameter in a fit: those of the parameter. A wave that is searched for and
/// has no prior has two low-band values a cycle or more: of fewer they see an alias, and any wave
/// fits.
std::pair<double, double> shape_bounds(const Model& model, const ModelTerm& term, int shape);

/// Per shape of all terms: whether it is at one of those bounds or beyond.
std::vector<bool> bounds_met(const Model& model, const Eigen::VectorXd& shapes);

/// Every so many-th value of an axis, the first and the last among them. REQUIRES step > 0, a
/// value.
std::vector<double> every(std::size_t step, const std::vector<double>& axis);

/// The grids of all shapes of a term. Where their product has more points than a search can look at
/// (8192), the longest is made coarser by half, its ends kept, until it has not; a single one stays
/// as it is.
std::vector<std::vector<double>> shape_axes(const Model& model, const ModelTerm& term);

}  // namespace slideway
