#pragma once

#include <Eigen/Core>
#include <optional>

#include "slideway/identify/fit.hpp"
#include "slideway/identify/model.hpp"

/// Straightness as ISO 230-1:2012 evaluates it: deviations from a stated reference line.
namespace slideway {

/// None where the model has no straightness.
std::optional<Straightness> identified_straightness(const Model& model, const Solution& fit,
                                                    const MoreVariance& more = {});

/// Whether the data determine all of a form but offset and slope, which the reference line takes.
bool is_determined(const ModelTerm& form, const Solution& fit);

/// Stations of the slide beyond the unknowns of what the model has along it. None where faces show
/// its form, too, and where no straightness is in the model.
std::optional<Eigen::Index> spare_stations(const Model& model);

/// Columns of a form of the slide as deviations from the line through the ends of `travel`, mm per
/// unit of amplitude, at places that lie evenly between them: #places by #amplitudes; empty where
/// the travel is.
Eigen::MatrixXd deviations_from_ends(const Model& model, const ModelTerm& form, const Solution& fit,
                                     const SlideRange& travel, Eigen::Index places = 19);

}  // namespace slideway
