#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "slideway/identify/model.hpp"
#include "slideway/identify/result.hpp"

namespace slideway {

/// What a linear (or linearised) least-squares problem determines.
struct Rank {
  Eigen::MatrixXd basis;       // A by r: amplitudes = basis * w; w has unit covariance
  Eigen::MatrixXd null_space;  // A by (A - r): directions that change no prediction
  /// A by q: those of them that change it by more than rounding, each as far as the data let it go,
  /// one standard uncertainty.
  Eigen::MatrixXd nearly_null;
  double condition = 1.0;  // of the scaled columns within the rank
};

/// Rank by SVD on scaled columns.
///
/// @param triangle  k by A, from an orthogonal factorisation of the whitened columns with the
///                  nuisances projected out
/// @param scale     norm of each column before that projection: a column the nuisances swallow
/// counts as
///                  gone, not as small
Rank analyse_rank(const Eigen::MatrixXd& triangle, const Eigen::VectorXd& scale, double tolerance);

/// Size of one unit of each parameter in the data, for telling a coefficient from rounding.
/// @param jacobian  P by A, d(parameters)/d(amplitudes, shapes)
/// @param scale     A, norm of each column
Eigen::VectorXd parameter_scale(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& scale);

/// Null directions in terms of parameters a person can read: each has one parameter of its own that
/// appears in no other: the one with the highest Parameter::gauge, which may be set to 0.
struct NullDirections {
  Eigen::MatrixXd parameters;      // P by d; 1 at the own parameter
  Eigen::MatrixXd amplitudes;      // A by d, the same directions
  std::vector<Eigen::Index> own;   // d
  std::vector<bool> identifiable;  // P
};

/// A parameter that is in none of them, but that nearly null directions could move by what counts
/// beside its uncertainty, is not identifiable either.
/// @param jacobian  P by A, d(parameters)/d(amplitudes, shapes)
/// @param scale     P, size of one unit of each parameter in the data
NullDirections null_directions(const Model& model, const Rank& rank,
                               const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& scale);

/// The directions in words, with what to measure.
std::vector<UndeterminedDirection> undetermined(const Model& model, const NullDirections& null);

/// For every parameter tied up in a null direction but not the own one of any: the combination the
/// data do determine, parameter - Σ_d null(parameter, d) * own_d. Rows of a D by P matrix.
Eigen::MatrixXd determined_rows(const NullDirections& null);

}  // namespace slideway
