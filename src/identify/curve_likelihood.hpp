#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "slideway/identify/curve_prior.hpp"

namespace slideway {

/// Lower triangular root of the correlation of the knots.
Eigen::MatrixXd correlation_root(const Knots& knots, double length_mm, double roughness);

/// The data's information A on the knots of a curve and its product b with the values, when the
/// curve is 0 and everything else is free.
class CurveData {
 public:
  /// @param linear  at the estimate; the prior of the curve is left aside
  CurveData(const ModelTerm& term, const Linearisation& linear, const std::vector<Noise>& noise,
            const Estimate& estimate);

  [[nodiscard]] const Knots& knots() const { return knots_; }
  [[nodiscard]] const Eigen::MatrixXd& information() const { return information_; }
  [[nodiscard]] const Eigen::VectorXd& products() const { return products_; }
  /// (A + S) by #knots: how everything moves with the knots.
  [[nodiscard]] const Eigen::MatrixXd& carried() const { return carried_; }

 private:
  Knots knots_;
  Eigen::MatrixXd information_, carried_;
  Eigen::VectorXd products_;
};

/// A prior with the log of its likelihood over that of no curve.
struct Hypothesis {
  CurvePrior prior;
  double log_likelihood = 0.0;
};

/// Those of the grid that the data do not rule out, by roughness, length and amplitude.
std::vector<Hypothesis> likely_priors(const CurveData& data);

/// The likeliest, or null.
const Hypothesis* likeliest(const std::vector<Hypothesis>& hypotheses);

/// The curve under one length and roughness and any amplitude.
class CurvePosterior {
 public:
  CurvePosterior(const CurveData& data, const CurvePrior& prior);

  [[nodiscard]] Eigen::VectorXd mean(double amplitude) const {
    return axes_ * variances(amplitude).cwiseProduct(products_);
  }
  [[nodiscard]] Eigen::MatrixXd covariance(double amplitude) const {
    return axes_ * variances(amplitude).asDiagonal() * axes_.transpose();
  }
  /// Directions that the data know better than the prior.
  [[nodiscard]] Eigen::MatrixXd determined(double amplitude) const;

  /// Adds the second moments about `centre` of hypotheses that differ in amplitude.
  void add_moments(std::span<const Hypothesis> hypotheses, std::span<const double> weights,
                   const Eigen::VectorXd& centre, Eigen::MatrixXd& out) const;

 private:
  [[nodiscard]] Eigen::VectorXd variances(double amplitude) const;

  Eigen::MatrixXd axes_;
  Eigen::VectorXd information_, products_;
};

/// Second moments of the knots about `centre` under all hypotheses, each by its likelihood.
Eigen::MatrixXd second_moments(const CurveData& data, const std::vector<Hypothesis>& hypotheses,
                               const Eigen::VectorXd& centre);

}  // namespace slideway
