#include "form_notes.hpp"

#include <algorithm>
#include <cmath>

#include "curve_likelihood.hpp"
#include "form_columns.hpp"
#include "slideway/base/text.hpp"

namespace slideway {
namespace {

void explain_other_form(const Model& model, const Solution& fit, ModelResult& out) {
  for (const OtherForm& each : fit.other_forms) {
    const ModelTerm& form = *std::ranges::find(model.terms, each.of, &ModelTerm::name);
    const std::string degree = form.effect->parameters().back().name.substr(1);
    out.notes.push_back("the data refute degree " + degree + " of the " + form.name +
                        ": a curve beside it is likelier by a factor of e^" +
                        significant(each.log_likelihood_ratio, 2) +
                        "; every uncertainty is widened by that curve, and the coefficients are "
                        "those of the nearest polynomial, not the slide's. Declare form = "
                        "\"curve\", or a higher degree");
  }
}

void explain_few_stations(const Model& model, ModelResult& out) {
  for (const ModelTerm& term : model.terms)
    if (term.effect->description().motion == MotionError::straightness &&
        has_few_stations(model, term))
      out.notes.push_back("the " + term.name + " is read at " +
                          std::to_string(station_positions(model, term).size()) +
                          " stations, too few to show what its polynomial does between them: U of "
                          "E_ZX reaches to that of the stations alone");
}

void explain_parts(ModelResult& out) {
  if (out.straightness && !out.straightness->parts.empty())
    out.notes.push_back("E_ZX is that of the straightness and " +
                        joined(out.straightness->parts, " and ") +
                        " together: every reading of the slide shows them");
}

/// Nothing but a second reading tells a slow noise of the first from a curve that may have any
/// form.
void explain_lone_curve(const Model& model, const Solution& fit, ModelResult& out) {
  if (curve_term(model) && fit.linear.observations.size() == 1)
    out.notes.emplace_back(
        "the curve rests on one trace: a drift while it was read would look the same, and U does "
        "not hold it; a second reading, back, shows it");
  if (curve_term(model) && curve_beside_least_noise(model, fit.linear, fit.noise, fit.estimate))
    out.notes.emplace_back(
        "so few readings do not tell the form of the slide from noise; standard_uncertainty, or "
        "the slide read once more, does");
}

/// A kink between two knots, h apart, is rounded by up to h/4 of the change of the slope there.
void explain_rounded_kinks(const Model& model, ModelResult& out) {
  constexpr Eigen::Index kCloser = 2;  // stations a knot: fewer show no more than the knots
  const ModelTerm* const term = curve_term(model);
  if (!term || !out.straightness) return;
  const Eigen::VectorXd knots = term->effect->knots()->positions_mm;
  const StraightnessCurve& curve = out.straightness->curve;
  const std::size_t count = curve.position_mm.size();
  if (station_positions(model, *term).size() < kCloser * knots.size() || count < 3) return;
  const double piece = knots[1] - knots[0];
  const auto reach =
      std::max<std::size_t>(1, std::lround(piece * static_cast<double>(count - 1) /
                                           (curve.position_mm.back() - curve.position_mm.front())));
  double largest = 1.0, rounded_um = 0.0, at_mm = 0.0;  // largest: over U
  for (std::size_t i = reach; i + reach < count; ++i) {
    const std::vector<double>& height = curve.deviation_um;
    const double rounded = 0.25 * std::abs(height[i - reach] - 2.0 * height[i] + height[i + reach]);
    const double over = rounded / curve.expanded_uncertainty_um[i];
    if (!(over > largest)) continue;
    largest = over;
    rounded_um = rounded;
    at_mm = curve.position_mm[i];
  }
  if (rounded_um > 0.0)
    out.notes.push_back("the slope of the slide turns within " + significant(piece, 3) +
                        " mm at x = " + significant(at_mm, 3) + " mm: of a kink there up to " +
                        significant(rounded_um, 2) +
                        " µm are rounded off, which U does not hold; a smaller resolution_mm shows "
                        "them");
}

}  // namespace

void explain_form(const Model& model, const Solution& fit, ModelResult& out) {
  explain_other_form(model, fit, out);
  explain_few_stations(model, out);
  explain_parts(out);
  explain_lone_curve(model, fit, out);
  explain_rounded_kinks(model, out);
}

}  // namespace slideway
