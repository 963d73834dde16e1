#pragma once

#include <functional>
#include <utility>

#include "dictionary.hpp"
#include "whitened.hpp"

namespace slideway {

/// What one candidate would bring: the whitened residual's square falls by `gain` at the best of
/// its atoms.
struct Finding {
  const Candidate* candidate = nullptr;
  Eigen::Index atom = 0;
  double gain = 0.0;
  double delta_bic = 0.0;  // unknowns ln n - gain
  Eigen::Index rank = 0;   // amplitudes the model does not span; 0: the candidate is one of it
};

/// What so many unknowns cost in BIC: unknowns ln n.
double penalty(const Whitened& data, Eigen::Index unknowns);
/// Of a candidate of which the model leaves `rank` amplitudes, with the choice of its profile.
double penalty(const Whitened& data, const Candidate& candidate, Eigen::Index rank);

/// What candidates are ordered by, the best first: their BIC, in steps that rounding does not
/// cross, and what the fit keeps where it cannot tell one from the other (Parameter::gauge).
using Priority = std::pair<double, int>;
Priority priority_of(const Candidate& candidate, double delta_bic);
/// By that; what ties stays in the order of the dictionary.
void sort_by_priority(std::vector<Finding>& findings);

/// Best atom of every candidate, in the order of the dictionary.
std::vector<Finding> search(const Whitened& data, const Candidates& candidates);

/// How strong the noise is beside a line: what the atoms near it, but for the nearest, take of the
/// residual without the line, over what they take of the noise of the data. 1 where that is no more
/// than chance (Gates::significance), and where the lattice has too few of them or is none of one
/// rate.
/// @param rest  the white residual without the line
double noise_beside_line(const Whitened& data, const Finding& line, const Eigen::VectorXd& rest,
                         const Gates& gates);

/// Columns (not whitened) of one effect, held against the data: the residual's square it takes away
/// with its amplitudes free, and the normal equations of those.
struct Projection {
  Eigen::MatrixXd gram;        // of the whitened columns outside the model's span
  Eigen::VectorXd products;    // with the residual
  Eigen::VectorXd amplitudes;  // best
  double gain = 0.0;
  Eigen::Index rank = 0;
};
Projection project(const Whitened& data, const Eigen::MatrixXd& columns);
/// The same of columns in one profile alone, given in its rows.
Projection project_in(const Whitened& data, std::size_t profile, const Eigen::MatrixXd& columns);

/// What an effect leaves of white columns outside the model's span, at each of its atoms: squares,
/// #columns by #atoms.
Eigen::MatrixXd left_beside(const Whitened& data, const Candidate& candidate,
                            const Eigen::MatrixXd& outside);

/// Largest penalised gain (gain - unknowns ln n) of any atom, for every column of `residuals`
/// (white, in the layout of the data, outside the model's span). Of noise that was drawn single
/// precision is enough: products err by 1e-7 of both lengths. `told` hears, in the thread of the
/// caller, which part of the work is done.
Eigen::VectorXd largest_gains(const Whitened& data, const Candidates& candidates,
                              const Eigen::MatrixXf& residuals,
                              const std::function<void(double)>& told = {});

}  // namespace slideway
