#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "slideway/identify/curve_prior.hpp"

namespace slideway {

/// Lower triangular root of the correlation of the knots.
Eigen::MatrixXd correlation_root(const Knots& knots, double length_mm, double roughness);

/// A kink of height 1 at each knot but the ends, 0 at both ends of the travel: the coefficients of
/// the spline through it at the knots, side by side.
Eigen::MatrixXd kink_forms(const Knots& knots);

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
  /// kink_forms().
  [[nodiscard]] const Eigen::MatrixXd& kinks() const { return kinks_; }
  /// A times these.
  [[nodiscard]] const Eigen::MatrixXd& informed_kinks() const { return informed_kinks_; }
  /// (A + S) by #knots: how everything moves with the knots.
  [[nodiscard]] const Eigen::MatrixXd& carried() const { return carried_; }

 private:
  Knots knots_;
  Eigen::MatrixXd information_, carried_, kinks_, informed_kinks_;
  Eigen::VectorXd products_;
};

/// A prior with the log of its likelihood over that of no curve.
struct Hypothesis {
  CurvePrior prior;
  double log_likelihood = 0.0;
};

/// Those of the grid that the data do not rule out, by roughness, length and amplitude.
/// @param kink_mm  standard deviation of the height of a kink; 0: there is none
std::vector<Hypothesis> likely_priors(const CurveData& data, double kink_mm);

/// The likeliest, or null.
const Hypothesis* likeliest(const std::vector<Hypothesis>& hypotheses);

/// The curve under one length and roughness, any amplitude and any kink.
class CurvePosterior {
 public:
  CurvePosterior(const CurveData& data, double length_mm, double roughness);

  [[nodiscard]] Eigen::VectorXd mean(const CurvePrior& prior) const;
  [[nodiscard]] Eigen::MatrixXd covariance(const CurvePrior& prior) const;
  /// Directions that the data know better than the prior.
  [[nodiscard]] Eigen::MatrixXd determined(const CurvePrior& prior) const;

  /// Log of the likelihood of a curve with a kink over that of the same curve without: a row for a
  /// kink at each knot but the ends, a column for each amplitude.
  [[nodiscard]] Eigen::MatrixXd log_evidence_of_kinks(const Eigen::RowVectorXd& amplitudes_mm,
                                                      double kink_mm) const;

  /// Adds the second moments about `centre` of hypotheses that differ in amplitude and kink.
  void add_moments(std::span<const Hypothesis> hypotheses, std::span<const double> weights,
                   const Eigen::VectorXd& centre, Eigen::MatrixXd& out) const;

 private:
  /// A kink beside the curve: its height has the mean h and the variance v, and a height of 1 moves
  /// the knots by d.
  struct Kink {
    double height = 0.0, variance = 0.0, determined = 0.0;
    Eigen::VectorXd moves;
  };
  [[nodiscard]] Kink kink_of(const CurvePrior& prior) const;
  [[nodiscard]] Eigen::VectorXd variances(double amplitude) const;

  Eigen::MatrixXd axes_;
  Eigen::VectorXd information_, products_;
  Eigen::MatrixXd kinks_, kinks_on_axes_;             // CurveData::kinks(); axesᵀ A of them
  Eigen::VectorXd kink_information_, kink_products_;  // of a kink alone
};

/// Second moments of the knots about `centre` under all hypotheses, each by its likelihood.
Eigen::MatrixXd second_moments(const CurveData& data, const std::vector<Hypothesis>& hypotheses,
                               const Eigen::VectorXd& centre);

}  // namespace slideway
