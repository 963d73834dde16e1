#pragma once

#include <ceres/cost_function.h>

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "slideway/identify/solve.hpp"

namespace slideway {

/// Orthonormal basis of an observation's nuisances, and columns with that basis taken out of them.
Eigen::MatrixXd nuisance_basis(const Observation& observation);
void project_out(const Eigen::MatrixXd& basis, Eigen::Ref<Eigen::MatrixXd> columns);

/// Index of a parameter within its effect. @throws UsageError if there is none of that name
Eigen::Index parameter_index(const ModelTerm& term, const std::string& name);

/// The least-squares problem Ceres sees. Unknowns x = [w, v, u]: w orthonormal coordinates of the
/// columns that do not move (nuisances already out), v amplitudes of the terms with shapes, u the
/// shapes themselves. Residuals: [w + Q'(M v - y)], then the part of M v - y orthogonal to the
/// fixed columns, then priors of the moving terms.
class Residual final : public ceres::CostFunction {
 public:
  /// @param linear  at zero amplitudes and nuisances
  Residual(const Model& model, const Linearisation& linear, const std::vector<double>& weights,
           const Estimate& start);

  [[nodiscard]] Eigen::Index rank() const { return fixed_basis_.cols(); }
  [[nodiscard]] Eigen::Index size() const {
    return rank() + static_cast<Eigen::Index>(amplitudes_.size() + shapes_.size());
  }
  /// The terms with shapes and which of their shapes, in the order of u.
  [[nodiscard]] const std::vector<std::pair<const ModelTerm*, int>>& shapes() const {
    return shapes_;
  }

  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override;

  /// Amplitudes and shapes of all terms out of x.
  [[nodiscard]] Estimate estimate(const Eigen::VectorXd& x) const;

  /// x whose linear part is optimal for given shapes; `cost` is then half the residual's square.
  [[nodiscard]] Eigen::VectorXd linear_optimum(const Eigen::VectorXd& shapes, double* cost) const;

 private:
  template <typename ColumnsOf>
  [[nodiscard]] Eigen::MatrixXd stacked(Eigen::Index cols, ColumnsOf&& columns_of) const;
  void set_up_rows(const Linearisation& linear);
  void set_up_fixed(const Linearisation& linear);
  [[nodiscard]] Eigen::Index prior_count() const;
  void evaluate(const Eigen::VectorXd& x, Eigen::Ref<Eigen::VectorXd> out,
                Eigen::MatrixXd& jacobian) const;
  [[nodiscard]] Eigen::MatrixXd moving_columns(const Observation& observation, const Estimate& now,
                                               bool derivatives) const;
  void evaluate_priors(const Estimate& now, Eigen::Ref<Eigen::VectorXd> out,
                       Eigen::MatrixXd& jacobian) const;

  const Model& model_;
  std::vector<double> weights_;
  std::vector<const Observation*> observations_;
  std::vector<Eigen::MatrixXd> bases_;
  std::vector<Eigen::Index> first_row_;
  Eigen::Index rows_ = 0;
  std::vector<Eigen::Index> fixed_, amplitudes_;
  std::vector<const ModelTerm*> moving_;
  std::vector<std::pair<const ModelTerm*, int>> shapes_;
  Eigen::VectorXd shape_values_;
  Eigen::MatrixXd fixed_basis_;  // #fixed by r
  Eigen::MatrixXd span_;         // rows by r, orthonormal
  Eigen::VectorXd target_;       // span' * values
  Eigen::VectorXd rest_;         // values outside the span
};

}  // namespace slideway
