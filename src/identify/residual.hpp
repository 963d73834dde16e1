#pragma once

#include <ceres/cost_function.h>
#include <ceres/loss_function.h>

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "slideway/identify/profile_bases.hpp"
#include "slideway/identify/solve.hpp"

namespace slideway {

/// The unknowns of a model as Ceres holds them: a block of levelling for each fitted profile; for
/// each term a block of amplitudes and, where it has shapes, a block of those as the optimiser sees
/// them (Shape::inner()).
class Unknowns {
 public:
  Unknowns(const Model& model, const Estimate& start);

  struct Term {
    const ModelTerm* term = nullptr;
    Eigen::VectorXd amplitudes, shapes;

    [[nodiscard]] bool moves() const { return shapes.size() > 0; }
  };

  std::vector<Eigen::VectorXd> levelling;
  std::vector<Term> terms;

  [[nodiscard]] Estimate estimate(const Model& model) const;
};

/// Huber's or Cauchy's loss of a white residual (Huber 1964; tuned for 95 % efficiency on normal
/// noise: Holland and Welsch 1977); null: none.
std::unique_ptr<ceres::LossFunction> make_loss(Loss loss);

/// Shapes out of the optimiser's view, and d(shape)/d(view) of one.
std::vector<double> outer_shapes(const ModelTerm& term, const double* inner);
double slope_of_outer(const Shape& kind, double outer);

/// A residual block of Eq. (16): one profile, white,
///   f = W (N ν + Σ_e C_e(u_e) a_e - y).
/// Parameter blocks: ν if the profile has levelling, then of each term a_e and, if it has shapes,
/// u_e. With a loss ρ each f_t becomes sign(f_t) sqrt(ρ(f_t²)): half the block's square is then the
/// loss of its values.
class ProfileResidual final : public ceres::CostFunction {
 public:
  /// @param columns  low-band columns of amplitudes as linearise() has them; those of terms with
  ///                 shapes are not read
  ProfileResidual(const Model& model, const Observation& observation, const Noise& noise,
                  const Eigen::MatrixXd& columns);

  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  [[nodiscard]] Eigen::MatrixXd white(Eigen::MatrixXd columns) const;

  const Model& model_;
  const Observation& observation_;
  const Noise& noise_;
  std::unique_ptr<ceres::LossFunction> loss_;  // null: none
  Eigen::MatrixXd left_out_;                   // orthonormal, white
  Eigen::MatrixXd levelling_, columns_;        // white
  Eigen::VectorXd values_;                     // white
};

/// The same of a profile without loss whose terms all stay, compressed: R a - Qᵀ W y with the
/// levelling eliminated. Parameter blocks: amplitudes of every term.
class CompressedResidual final : public ceres::CostFunction {
 public:
  CompressedResidual(const Model& model, const ProfileTriangle& of_values);

  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  Eigen::MatrixXd upper_;
};

/// (parameter - prior) / u. Parameter blocks: amplitudes and, if it has some, shapes of the term.
class PriorResidual final : public ceres::CostFunction {
 public:
  PriorResidual(const ModelTerm& term, const Prior& prior);

  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  const ModelTerm& term_;
  const Prior& prior_;
  Eigen::Index parameter_;
};

/// R c of a curve's amplitudes c. Parameter blocks: amplitudes of its term.
class CurveResidual final : public ceres::CostFunction {
 public:
  /// @param rows  of the prior, curve_prior_rows()
  CurveResidual(const Effect& effect, const Eigen::MatrixXd& rows);

  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  Eigen::MatrixXd rows_;
};

/// All profiles with the amplitudes and levelling eliminated: the residual of the best linear fit
/// as a function of the shapes of all terms (variable projection, Kaufman's Jacobian), priors left
/// aside. One parameter block of all shapes as the optimiser sees them; the optimiser sees residual
/// and Jacobian as their triangle, which has one row more than there are shapes.
class EliminatedResidual final : public ceres::CostFunction {
 public:
  /// @param linear  columns of the terms without shapes are read
  EliminatedResidual(const Model& model, const Linearisation& linear,
                     const std::vector<Noise>& noise);

  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override;

  /// Half the square of the residual.
  [[nodiscard]] double cost(const Eigen::VectorXd& shapes) const;

 private:
  struct Moving {  // stacked white columns of the terms with shapes, outside all others
    Eigen::MatrixXd columns;
    Eigen::VectorXd amplitudes, residual;
  };
  template <typename Of>
  [[nodiscard]] Eigen::MatrixXd outside(Eigen::Index columns, Of&& of_observation) const;
  [[nodiscard]] Moving project(const Eigen::VectorXd& shapes) const;

  const Model& model_;
  std::vector<const Observation*> observations_;
  const std::vector<Noise>& noise_;
  std::vector<const ModelTerm*> moving_;
  Eigen::Index rows_ = 0;
  ProfileBases nuisances_;    // white
  Eigen::MatrixXd fixed_;     // orthonormal: what the terms without shapes span beside them
  Eigen::VectorXd residual_;  // white values outside both
};

}  // namespace slideway
