#include "slideway/identify/straightness.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "curve_likelihood.hpp"
#include "form_columns.hpp"
#include "reported.hpp"
#include "residual.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/identify/reference_line.hpp"

namespace slideway {
namespace {

constexpr Eigen::Index kPoints = 201;
constexpr Eigen::Index kPointsOfWaves = 2001;  // of a wave of a fiftieth of the travel, 40 a cycle
constexpr std::size_t kMostExtremes = 6;
constexpr Eigen::Index kMostStations = 50;
constexpr double kRounding = 1e-9;  // relative

/// The form of a slide: of its straightness, and of what is part of it under another name.
using Parts = std::vector<const ModelTerm*>;

/// Where the straightness is evaluated: what one reading would see of it, and of it alone.
class Locus {
 public:
  /// @param parts  the straightness itself is the first
  Locus(const Model& model, const Parts& parts, const Solution& fit, const Reported& reported,
        const Setup& setup)
      : model_(model), parts_(parts), fit_(fit), reported_(reported), setup_(setup) {}

  /// At slide coordinates x: how the form changes with (amplitudes, shapes), and in the last column
  /// the form itself, mm.
  [[nodiscard]] Eigen::MatrixXd form(const Eigen::VectorXd& x) const {
    const Eigen::VectorXd& amplitudes = fit_.estimate.amplitudes;
    Eigen::MatrixXd out =
        Eigen::MatrixXd::Zero(x.size(), amplitudes.size() + fit_.estimate.shapes.size() + 1);
    for (const ModelTerm* part : parts_) {
      const Eigen::VectorXd own =
          amplitudes.segment(part->first_amplitude, part->effect->amplitudes());
      const auto shapes = shapes_of(*part, fit_.estimate.shapes);
      const Eigen::MatrixXd columns = form_columns(model_, *part, shapes, setup_, x);
      out.middleCols(part->first_amplitude, own.size()) = columns;
      out.rightCols<1>() += columns * own;
      const Eigen::MatrixXd slopes = form_derivatives(model_, *part, shapes, setup_, x);
      for (Eigen::Index s = 0; s < std::ssize(shapes); ++s)
        out.col(amplitudes.size() + part->first_shape + s) =
            slopes.middleCols(s * own.size(), own.size()) * own;
    }
    return out;
  }

  /// What the nearest polynomials leave of a curve beside them (OtherForm), per knot; no columns
  /// where there is none.
  [[nodiscard]] Eigen::MatrixXd left_of_curve(const Eigen::VectorXd& x) const {
    const OtherForm* const form = other_form();
    if (!form) return Eigen::MatrixXd::Zero(x.size(), 0);
    return form_columns(model_, form->curve, {}, setup_, x)
               .middleCols(form->curve.effect->knots()->first, form->nearest.cols()) -
           form_columns(model_, *parts_.front(), {}, setup_, x) * form->nearest;
  }

  /// Of a weighted sum of rows of form(), and the same of left_of_curve().
  [[nodiscard]] Spread spread(const Eigen::RowVectorXd& weighted,
                              const Eigen::RowVectorXd& left) const {
    const Eigen::RowVectorXd row = weighted.head(weighted.size() - 1);
    Spread out = reported_.spread(row);
    if (left.size() == 0) return out;
    const OtherForm& form = *other_form();
    const double more = (left * form.moments * (left + 2.0 * row * form.moved).transpose()).value();
    out.standard_uncertainty =
        std::sqrt(std::max(out.standard_uncertainty * out.standard_uncertainty + more, 0.0));
    return out;
  }

  /// Whether a weighted sum of rows of form() is the same along every direction that the data leave
  /// open.
  [[nodiscard]] bool is_determined(const Eigen::RowVectorXd& weighted) const {
    const Eigen::MatrixXd& along = fit_.null.amplitudes;
    const Eigen::RowVectorXd row = weighted.head(along.rows());
    for (Eigen::Index j = 0; j < along.cols(); ++j)
      if (std::abs(row.dot(along.col(j))) > kRounding * row.norm() * along.col(j).norm())
        return false;
    return true;
  }

  /// Deviation at each x from the line through those at the ends of `travel`, µm.
  [[nodiscard]] std::vector<QuantityValue> deviations(const Eigen::VectorXd& x,
                                                      const SlideRange& travel) const {
    if (x.size() == 0) return {};
    const Eigen::VectorXd share = (x.array() - travel.least) / (travel.greatest - travel.least);
    const auto from_line = [&](const Eigen::MatrixXd& at, const Eigen::MatrixXd& at_ends) {
      return Eigen::MatrixXd(at - (1.0 - share.array()).matrix() * at_ends.row(0) -
                             share * at_ends.row(1));
    };
    const Eigen::Vector2d ends(travel.least, travel.greatest);
    Eigen::MatrixXd rows = from_line(form(x), form(ends)),
                    left = from_line(left_of_curve(x), left_of_curve(ends));
    for (Eigen::Index i = 0; i < x.size(); ++i)
      if (share[i] == 0.0 || share[i] == 1.0) rows.row(i).setZero(), left.row(i).setZero();
    std::vector<QuantityValue> out(static_cast<std::size_t>(x.size()));
    for (Eigen::Index i = 0; i < x.size(); ++i)
      Reported::set(rows(i, rows.cols() - 1), spread(rows.row(i), left.row(i)), kMicrometre,
                    out[static_cast<std::size_t>(i)]);
    return out;
  }

 private:
  [[nodiscard]] const OtherForm* other_form() const {
    const auto own = std::ranges::find(fit_.other_forms, parts_.front()->name, &OtherForm::of);
    return own == fit_.other_forms.end() ? nullptr : &*own;
  }

  const Model& model_;
  Parts parts_;
  const Solution& fit_;
  const Reported& reported_;
  Setup setup_;
};

/// As evenly as they lie, with both ends.
Eigen::VectorXd at_most(Eigen::Index count, const Eigen::VectorXd& x) {
  if (x.size() <= count) return x;
  Eigen::VectorXd out(count);
  for (Eigen::Index i = 0; i < count; ++i) out[i] = x[i * (x.size() - 1) / (count - 1)];
  return out;
}

/// The straightness with what is part of it under another name and is the slide's: all profiles
/// show it, a reading of the slide among them. On faces alone it may be the workpiece's, in a
/// reading alone the instrument's.
Parts parts_of_form(const Model& model, const ModelTerm& straightness, const Solution& fit) {
  const auto shows = [&](const ModelTerm& part) {
    bool in_reading = false;
    for (const Observation* each : fitted_observations(model)) {
      if (!straightness.acts_on(*each->profile)) continue;
      if (!part.acts_on(*each->profile)) return false;
      in_reading = in_reading || each->profile->setup.kind == Kind::slide;
    }
    return in_reading;
  };
  Parts out{&straightness};
  for (const ModelTerm& term : model.terms)
    if (is_part_of_straightness(term.effect->description()) && shows(term) &&
        is_determined(term, fit))
      out.push_back(&term);
  return out;
}

/// The setup of the fitted faces, where the pitch acts on all of them alike.
const Setup* one_face(const Model& model) {
  const Setup* out = nullptr;
  for (const Observation* observation : fitted_observations(model)) {
    const Setup& setup = observation->profile->setup;
    if (setup.kind != Kind::face) continue;
    const bool differs = out != nullptr && (setup.overhang_mm != out->overhang_mm ||
                                            setup.spindle_position_mm != out->spindle_position_mm);
    if (differs) return nullptr;
    out = &setup;
  }
  return out;
}

void append(const std::vector<QuantityValue>& values, std::vector<double>& deviation,
            std::vector<double>& U) {
  for (const QuantityValue& each : values) {
    deviation.push_back(*each.value);
    U.push_back(*each.expanded_uncertainty);
  }
}

void add_tip(const Locus& tip, const Eigen::VectorXd& x, const SlideRange& travel,
             StraightnessCurve& out) {
  append(tip.deviations(x, travel), out.tip_um, out.tip_expanded_uncertainty_um);
  const Eigen::MatrixXd ends = tip.form(Eigen::Vector2d(travel.least, travel.greatest));
  const Eigen::RowVectorXd rise = ends.row(1) - ends.row(0);
  if (tip.is_determined(rise))
    out.tip_slope_rad = rise[rise.size() - 1] / (travel.greatest - travel.least);
}

void add_error(const ReferenceLine& line, const Eigen::VectorXd& x, const Spread& spread,
               Straightness& out) {
  StraightnessError error;
  error.line = line.kind;
  error.unit = "um";
  Reported::set(line.error, spread, kMicrometre, error);
  error.highest_um = line.highest / kMicrometre;
  error.highest_at_mm = x[static_cast<Eigen::Index>(line.highest_at)];
  error.lowest_um = line.lowest / kMicrometre;
  error.lowest_at_mm = x[static_cast<Eigen::Index>(line.lowest_at)];
  switch (line.kind) {
    case ReferenceLineKind::end_point:
      out.end_point_um = error.value;
      out.expanded_uncertainty_um = error.expanded_uncertainty;
      break;
    case ReferenceLineKind::least_squares:
      out.least_squares_um = error.value;
      break;
    case ReferenceLineKind::minimum_zone:
      out.minimum_zone_um = error.value;
      break;
  }
  out.errors.push_back(std::move(error));
}

/// The error is no smaller than the size of any deviation, so with its U it reaches as far as each
/// of them with its own, mm. Where the form is small against its U, the points that happen to be
/// the highest and the lowest say little of that.
double least_uncertainty(const StraightnessCurve& curve) {
  double highest = 0.0, lowest = 0.0, reach = 0.0;
  for (std::size_t i = 0; i < curve.deviation_um.size(); ++i) {
    highest = std::max(highest, curve.deviation_um[i]);
    lowest = std::min(lowest, curve.deviation_um[i]);
    reach = std::max(reach, std::abs(curve.deviation_um[i]) + curve.expanded_uncertainty_um[i]);
  }
  return std::max(0.0, reach - (highest - lowest)) * kMicrometre;
}

/// Points that lie further out than those beside them, the furthest ones first.
std::vector<Eigen::Index> extremes(const Eigen::VectorXd& deviation) {
  std::vector<Eigen::Index> out;
  for (Eigen::Index i = 0; i < deviation.size(); ++i)
    if ((i == 0 || deviation[i] >= deviation[i - 1]) &&
        (i + 1 == deviation.size() || deviation[i] >= deviation[i + 1]))
      out.push_back(i);
  std::ranges::stable_sort(out, std::greater(), [&](Eigen::Index i) { return deviation[i]; });
  out.resize(std::min(out.size(), kMostExtremes));
  return out;
}

/// The error is no smaller than any point lies above any other: it reaches as far as each pair with
/// its own U, mm. Of pairs that are nearly as far apart, noise chooses the one it rests on.
template <typename SpreadBetween>
double reach_of_pairs(const Eigen::VectorXd& deviation, const SpreadBetween& spread_between) {
  double out = 0.0;
  const std::vector<Eigen::Index> lowest = extremes(-deviation);
  for (const Eigen::Index high : extremes(deviation))
    for (const Eigen::Index low : lowest) {
      const Spread spread = spread_between(high, low);
      const double U = coverage_factor(spread.degrees_of_freedom) * spread.standard_uncertainty;
      out = std::max(out, deviation[high] - deviation[low] + U);
    }
  return out;
}

/// @param columns      slide.form(x)
/// @param form         the form itself, from its least-squares line
/// @param others       lines that the error may also be from, mm: of the stations alone where they
///                     do not show what lies between them, of another form
void add_errors(const Locus& slide, const Eigen::VectorXd& x, const Eigen::MatrixXd& columns,
                const Eigen::VectorXd& form, const std::vector<ReferenceLine>& others,
                Straightness& out) {
  const Eigen::MatrixXd left = slide.left_of_curve(x);
  const double least_U = least_uncertainty(out.curve);
  for (const ReferenceLine& line : reference_lines(x, form)) {
    const Eigen::VectorXd deviation = line.deviations(x, form);
    const Eigen::MatrixXd rows = line.deviations(x, columns), rest = line.deviations(x, left);
    const auto spread_between = [&](Eigen::Index high, Eigen::Index low) {
      return slide.spread(rows.row(high) - rows.row(low), rest.row(high) - rest.row(low));
    };
    Spread spread = spread_between(static_cast<Eigen::Index>(line.highest_at),
                                   static_cast<Eigen::Index>(line.lowest_at));
    double U = std::max(least_U, reach_of_pairs(deviation, spread_between) - line.error);
    // What a form does between its stations rests on its prior or its degree alone.
    const double k = coverage_factor(spread.degrees_of_freedom);
    for (const ReferenceLine& other : others)
      if (other.kind == line.kind)
        U = std::max(U, std::abs(line.error - other.error) + k * spread.standard_uncertainty);
    spread.standard_uncertainty = std::max(spread.standard_uncertainty, U / k);
    add_error(line, x, spread, out);
  }
}

std::optional<Straightness> straightness_of(const Model& model, const ModelTerm& term,
                                            const Solution& fit, const MoreVariance& more) {
  const SlideRange travel = measured_travel(model, &term);
  if (!(travel.greatest > travel.least)) return std::nullopt;
  Straightness out;
  if (!is_determined(term, fit)) {
    out.reason = "these data do not tell the straightness from another effect";
    return out;
  }
  const Reported reported(fit, more);
  const Parts parts = parts_of_form(model, term, fit);
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(parts.size() > 1 ? kPointsOfWaves : kPoints,
                                                       travel.least, travel.greatest);
  const Locus slide(model, parts, fit, reported, on_slide());
  const Eigen::MatrixXd columns = slide.form(x),
                        forms = least_squares_line(x, x).deviations(x, columns);
  const Eigen::Index amplitudes = fit.estimate.amplitudes.size();
  if (forms.leftCols(amplitudes).norm() <= kRounding * columns.leftCols(amplitudes).norm()) {
    out.reason = "a straightness of degree 1 is a line, which deviates from no line";
    return out;
  }
  for (std::size_t i = 1; i < parts.size(); ++i) out.parts.push_back(parts[i]->name);
  const bool is_curve = &term == curve_term(model);
  if (const auto& prior = fit.estimate.curve; prior && is_curve)
    out.form = CurveForm{prior->length_mm, prior->amplitude_mm / kMicrometre, prior->roughness};
  out.curve.position_mm.assign(x.begin(), x.end());
  append(slide.deviations(x, travel), out.curve.deviation_um, out.curve.expanded_uncertainty_um);
  if (const Setup* const face = one_face(model))
    add_tip(Locus(model, parts, fit, reported, *face), x, travel, out.curve);
  const Eigen::VectorXd stations = station_positions(model, term),
                        told = at_most(kMostStations, stations);
  const std::vector<QuantityValue> heights = slide.deviations(told, travel);
  for (std::size_t i = 0; i < heights.size(); ++i)
    out.stations.push_back(
        {told[static_cast<Eigen::Index>(i)], *heights[i].value, heights[i].expanded_uncertainty});
  std::vector<ReferenceLine> others;
  if ((is_curve && is_of_slides(model, term)) || has_few_stations(model, term))
    others = reference_lines(stations, slide.form(stations).rightCols<1>());
  if (is_curve)
    if (const auto knots = curve_beside_least_noise(model, fit.linear, fit.noise, fit.estimate)) {
      const Eigen::Index first = term.first_amplitude + term.effect->knots()->first;
      std::ranges::move(reference_lines(x, columns.middleCols(first, knots->size()) * *knots),
                        std::back_inserter(others));
    }
  add_errors(slide, x, columns, forms.rightCols<1>(), others, out);
  return out;
}

/// |E_ZX| and its U; infinite where it is not determined.
double reach(const Straightness& form) {
  return form.end_point_um && form.expanded_uncertainty_um
             ? *form.end_point_um + *form.expanded_uncertainty_um
             : INFINITY;
}

}  // namespace

bool is_determined(const ModelTerm& term, const Solution& fit) {
  const std::vector<Parameter>& parameters = term.effect->parameters();
  for (std::size_t p = 0; p < parameters.size(); ++p)
    if (!fit.null.identifiable[term.first_parameter + static_cast<Eigen::Index>(p)] &&
        !parameters[p].by_convention)
      return false;
  return true;
}

std::optional<Eigen::Index> spare_stations(const Model& model) {
  const ModelTerm* const form = model.find_term(MotionError::straightness);
  if (!form || curve_term(model) || !is_of_slides(model, *form)) return std::nullopt;
  Eigen::Index out = station_positions(model, *form).size();
  for (const ModelTerm& term : model.terms)
    if (term.effect->description().variable == IndependentVariable::slide)
      out -= term.effect->amplitudes() + std::ssize(term.effect->shapes());
  return out;
}

Eigen::MatrixXd deviations_from_ends(const Model& model, const ModelTerm& form, const Solution& fit,
                                     const SlideRange& travel, Eigen::Index places) {
  if (!(travel.greatest > travel.least)) return {};
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(places + 2, travel.least, travel.greatest);
  const Eigen::MatrixXd columns =
      form_columns(model, form, shapes_of(form, fit.estimate.shapes), on_slide(), x);
  return end_point_line(x, x).deviations(x, columns).middleRows(1, places);
}

std::optional<Straightness> identified_straightness(const Model& model, const Solution& fit,
                                                    const MoreVariance& more) {
  std::optional<Straightness> worst;
  std::vector<StraightnessOfPart> each;
  for (const ModelTerm& term : model.terms) {
    if (term.effect->description().motion != MotionError::straightness) continue;
    std::optional<Straightness> form = straightness_of(model, term, fit, more);
    if (!form) continue;
    each.push_back({term.profiles, form->end_point_um, form->expanded_uncertainty_um});
    if (worst && !(reach(*form) > reach(*worst))) continue;
    worst = std::move(form);
    worst->profiles = term.profiles;
  }
  if (!worst) return worst;
  if (each.size() > 1)
    worst->each = std::move(each);
  else
    worst->profiles.clear();
  return worst;
}

}  // namespace slideway
