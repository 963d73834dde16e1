#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "slideway/identify/curve_prior.hpp"

namespace slideway {

/// Lower triangular root of the correlation of the knots.
Eigen::MatrixXd correlation_root(const Knots& knots, double length_mm, double roughness);

/// A kink of height 1 at each knot but the ends, 0 at both ends of the travel: the coefficients of
/// the spline through it at the knots, side by side.
Eigen::MatrixXd kink_forms(const Knots& knots);

/// A parabola of height 1 at the middle of the travel and 0 at its ends, likewise.
Eigen::VectorXd bow_form(const Knots& knots);

/// Forms F of a curve with a height of their own, its bow and kinks, given the rest c of its knots:
/// F (mean - movedᵀ c), with a covariance.
struct CurveForms {
  Eigen::MatrixXd forms, moved, covariance;
  Eigen::VectorXd mean;
  std::vector<Eigen::Index> determined;  // those that the data know better than their prior

  /// Forms of the rest, side by side, with those that go with each.
  [[nodiscard]] Eigen::MatrixXd beside(const Eigen::MatrixXd& rest) const {
    return rest - forms * (moved.transpose() * rest);
  }
};

/// The data's information A on the knots of a curve and its product b with the values, when the
/// curve is 0 and everything else, its bow and some kinks as well, is free.
class CurveData {
 public:
  /// @param linear  at the estimate; the prior of the curve is left aside
  /// @param kinks   that the curve has in any case
  CurveData(const ModelTerm& term, const Linearisation& linear, const std::vector<Noise>& noise,
            const Estimate& estimate, std::vector<CurveKink> kinks = {});

  [[nodiscard]] const Knots& knots() const { return knots_; }
  [[nodiscard]] double bow_mm() const { return bow_mm_; }  // standard deviation of its height
  [[nodiscard]] const std::vector<CurveKink>& kinks() const { return kinks_; }
  [[nodiscard]] const CurveForms& forms() const { return forms_; }
  [[nodiscard]] const Eigen::MatrixXd& information() const { return information_; }
  [[nodiscard]] const Eigen::VectorXd& products() const { return products_; }
  /// kink_forms(), and A times these.
  [[nodiscard]] const Eigen::MatrixXd& kink_forms() const { return kink_forms_; }
  [[nodiscard]] const Eigen::MatrixXd& informed_kinks() const { return informed_kinks_; }
  /// (A + S) by #knots: how everything moves with the knots.
  [[nodiscard]] const Eigen::MatrixXd& carried() const { return carried_; }
  /// Values, beside what is free.
  [[nodiscard]] Eigen::Index freedom() const { return freedom_; }
  /// Log of the likelihood of no curve but its bow and kinks, in units of the noise; each kink
  /// might as well be at any other knot.
  [[nodiscard]] double log_likelihood() const { return log_likelihood_; }

 private:
  Knots knots_;
  double bow_mm_ = 0.0;
  Eigen::Index freedom_ = 0;
  double log_likelihood_ = 0.0;
  /// Takes bow and kinks out of what the data say of the rest.
  void free_forms();

  std::vector<CurveKink> kinks_;
  CurveForms forms_;
  Eigen::MatrixXd information_, carried_, kink_forms_, informed_kinks_;
  Eigen::VectorXd products_;
};

/// A prior with the log of its likelihood over that of no curve.
struct Hypothesis {
  CurvePrior prior;
  double log_likelihood = 0.0;
};

/// Whether a curve may have one more kink, about as high as its bow, if that has a height.
enum class Kinks { allowed, none };

/// Those of the grid that the data do not rule out, by roughness, length and amplitude.
std::vector<Hypothesis> likely_priors(const CurveData& data, Kinks kinks = Kinks::allowed);

/// The likeliest, or null.
const Hypothesis* likeliest(const std::vector<Hypothesis>& hypotheses);

/// The curve under one length and roughness, any amplitude and any kink beside those that it has.
class CurvePosterior {
 public:
  CurvePosterior(const CurveData& data, double length_mm, double roughness);

  [[nodiscard]] Eigen::VectorXd mean(const CurvePrior& prior) const;
  [[nodiscard]] Eigen::MatrixXd covariance(const CurvePrior& prior) const;
  /// Directions that the data know better than the prior, so many at most: those that they know
  /// best.
  [[nodiscard]] Eigen::MatrixXd determined(const CurvePrior& prior, Eigen::Index most) const;

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
  [[nodiscard]] bool has_one_more(const CurvePrior& prior) const;
  [[nodiscard]] Kink kink_of(const CurvePrior& prior) const;  // the last
  [[nodiscard]] Eigen::VectorXd variances(double amplitude) const;

  std::size_t known_kinks_;
  CurveForms forms_;
  Eigen::MatrixXd axes_;  // each with the forms that go with it; as kinks_
  Eigen::VectorXd information_, products_;
  Eigen::MatrixXd kinks_, kinks_on_axes_;             // axesᵀ A of CurveData::kinks()
  Eigen::VectorXd kink_information_, kink_products_;  // of a kink alone
};

/// The knots under the smallest noise that noise_beside_curve() does not rule out, where it looks
/// for one.
std::optional<Eigen::VectorXd> curve_beside_least_noise(const Model& model,
                                                        const Linearisation& linear,
                                                        const std::vector<Noise>& noise,
                                                        const Estimate& estimate);

/// Second moments of the knots about `centre` under these hypotheses, each by its likelihood.
Eigen::MatrixXd second_moments(const CurveData& data, const std::vector<Hypothesis>& hypotheses,
                               const Eigen::VectorXd& centre);

/// Under one noise: curves without a kink, and with those of the estimate, the last of which may be
/// at any knot.
struct CurveHypotheses {
  struct Kind {
    CurveData data;
    std::vector<Hypothesis> likely;

    /// In units of the noise: of the likeliest, and of all together.
    [[nodiscard]] double log_likelihood() const;
    [[nodiscard]] double log_sum() const;
  };
  Kind smooth;
  std::optional<Kind> kinked;

  CurveHypotheses(const Model& model, const Linearisation& linear, const std::vector<Noise>& noise,
                  const Estimate& estimate, Kinks kinks);

  [[nodiscard]] double log_likelihood() const;
  /// About `centre`. By likelihood; but curves without a kink keep half of all at least: that kinks
  /// explain more does not make them the only form that is there.
  [[nodiscard]] Eigen::MatrixXd second_moments(const Eigen::VectorXd& centre) const;
};

}  // namespace slideway
