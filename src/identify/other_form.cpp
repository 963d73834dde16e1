#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "curve_likelihood.hpp"
#include "form_columns.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/identify/fit.hpp"
#include "slideway/identify/linear_algebra.hpp"

namespace slideway {
namespace {

/// The declared polynomial forms of the slide that the model has: one, or one for each profile.
std::vector<const DeclaredEffect*> declared_polynomials(const Problem& problem) {
  std::vector<const DeclaredEffect*> out;
  for (const DeclaredEffect& each : problem.effects)
    if (motion_error_of(each.name) == MotionError::straightness &&
        std::ranges::none_of(out, [&](const DeclaredEffect* other) {
          return other->options.profiles == each.options.profiles;
        }))
      out.push_back(&each);
  return out;
}

/// With pieces short enough to tell slow structure, and no shorter than from station to station.
DeclaredEffect as_curve(const DeclaredEffect& polynomial, const ModelTerm& term,
                        const Model& model) {
  constexpr double kPieces = 24.0, kFewest = 4.0;
  double pieces = kPieces;
  if (is_of_slides(model, term))
    pieces = std::clamp(static_cast<double>(station_positions(model, term).size() - 1), kFewest,
                        kPieces);
  DeclaredEffect out{polynomial.name, polynomial.options, {}};
  out.options.degree.reset();
  out.options.form = Form::curve;
  out.options.resolution_mm =
      std::max(model.range.slide_max - model.range.slide_min, 1e-9) / pieces;
  return out;
}

/// Amplitudes of the polynomial of least squares, equal at both ends, for each knot of a curve.
Eigen::MatrixXd nearest_polynomials(const Model& model, const ModelTerm& polynomial,
                                    const Eigen::VectorXd& shapes, const ModelTerm& curve) {
  constexpr Eigen::Index kPoints = 201;
  constexpr double kWeightOfEnds = 1e4;
  const SlideRange travel = measured_travel(model);
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(kPoints, travel.least, travel.greatest);
  const auto weighted = [&](Eigen::MatrixXd columns) {
    columns.row(0) *= kWeightOfEnds;
    columns.row(kPoints - 1) *= kWeightOfEnds;
    return columns;
  };
  Eigen::MatrixXd powers =
      weighted(form_columns(model, polynomial, shapes_of(polynomial, shapes), on_slide(), x));
  const Eigen::VectorXd unit = powers.colwise().norm().cwiseMax(1e-300).cwiseInverse();
  powers *= unit.asDiagonal();
  const Knots knots = *curve.effect->knots();
  const Eigen::MatrixXd forms = weighted(form_columns(model, curve, {}, on_slide(), x)
                                             .middleCols(knots.first, knots.positions_mm.size()));
  return unit.asDiagonal() * least_squares(powers, forms).values;
}

void allow_for_other(const DeclaredEffect& declared, const ModelTerm& polynomial,
                     FittedModel& fitted) {
  Solution& fit = fitted.fit;
  const Model& model = fitted.model;
  Model with = model;
  append_term(with, as_curve(declared, polynomial, model), model.range);
  const ModelTerm& curve = with.terms.back();
  const Knots knots = *curve.effect->knots();
  Estimate estimate = fit.estimate;
  estimate.amplitudes.conservativeResizeLike(Eigen::VectorXd::Zero(with.amplitudes()));
  estimate.curve = CurvePrior{};  // neither bow nor kink: the polynomial has the one
  Linearisation linear = linearise(with, estimate);
  linear.residuals = fit.linear.residuals;
  for (Eigen::MatrixXd& columns : linear.columns)  // the polynomial has offset and slope
    columns.middleCols(curve.first_amplitude, knots.first).setZero();
  const CurveData data(curve, linear, fit.noise, estimate);
  // Beside a polynomial that takes nearly all there is, nothing else bounds it; a long curve is
  // part of one that is larger.
  constexpr double kOfReadings = 10.0;
  const double most = kOfReadings * first_curve_prior(model, knots).amplitude_mm;
  std::vector<Hypothesis> likely = likely_priors(data);
  std::erase_if(likely, [&](const Hypothesis& each) { return each.prior.amplitude_mm > most; });
  const Hypothesis* const best = likeliest(likely);
  if (!best || best->log_likelihood < -std::log(model.gates.lack_of_fit_p)) return;
  OtherForm& form = fit.other_forms.emplace_back();
  form.of = polynomial.name;
  form.log_likelihood_ratio = best->log_likelihood;
  form.curve = curve;
  form.moments = second_moments(data, likely, Eigen::VectorXd::Zero(knots.positions_mm.size()));
  form.nearest = nearest_polynomials(model, polynomial, fit.estimate.shapes, curve);
  form.moved.resize(fit.uncertainty.basis.rows(), data.carried().cols());
  form.moved << data.carried().topRows(model.amplitudes()),
      data.carried().bottomRows(model.shapes());
  form.moved.middleRows(polynomial.first_amplitude, form.nearest.rows()) += form.nearest;
  fit.uncertainty.add(form.moved * form.moments * form.moved.transpose(),
                      compress(fit.linear, fit.noise));
}

}  // namespace

void allow_for_other_form(const Problem& problem, FittedModel& fitted) {
  if (curve_term(fitted.model)) return;
  for (const DeclaredEffect* const each : declared_polynomials(problem)) {
    const auto term = std::ranges::find(
        fitted.model.terms, term_name(each->name, each->options.profiles), &ModelTerm::name);
    if (term != fitted.model.terms.end()) allow_for_other(*each, *term, fitted);
  }
}

}  // namespace slideway
