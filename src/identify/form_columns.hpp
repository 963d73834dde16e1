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

}  // namespace slideway
