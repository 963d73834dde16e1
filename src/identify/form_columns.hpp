#pragma once

#include <Eigen/Core>
#include <span>

#include "slideway/identify/model.hpp"

namespace slideway {

/// A reading of the slide itself.
Setup on_slide();

/// Columns f_j of a carriage error at slide coordinates x as a reading would see them, and it
/// alone; on a face x is turned into the radius.
Eigen::MatrixXd form_columns(const Model& model, const ModelTerm& term,
                             std::span<const double> shapes, Setup setup, const Eigen::VectorXd& x);

/// Their derivatives by each shape, side by side: #x by #shapes #amplitudes.
Eigen::MatrixXd form_derivatives(const Model& model, const ModelTerm& term,
                                 std::span<const double> shapes, Setup setup,
                                 const Eigen::VectorXd& x);

/// Slide coordinates of the fitted readings of the slide that show a term, of a bridge those of its
/// feet; rising.
Eigen::VectorXd station_positions(const Model& model, const ModelTerm& term);

/// Whether a term acts in readings of the slide alone.
bool is_of_slides(const Model& model, const ModelTerm& term);

/// Whether a polynomial is read along the slide alone, at so few stations that they do not show
/// what it does between them: fewer than Gates::values_per_cycle for two degrees.
bool has_few_stations(const Model& model, const ModelTerm& term);

}  // namespace slideway
