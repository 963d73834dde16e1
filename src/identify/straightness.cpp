#include "slideway/identify/straightness.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "form_columns.hpp"
#include "reported.hpp"
#include "residual.hpp"
#include "slideway/identify/reference_line.hpp"

namespace slideway {
namespace {

constexpr Eigen::Index kPoints = 201;
constexpr std::size_t kMostExtremes = 6;
constexpr std::size_t kMostStations = 50;
constexpr double kRounding = 1e-9;  // relative

/// Where the straightness is evaluated: what one reading would see of it, and of it alone.
class Locus {
 public:
  Locus(const Model& model, const ModelTerm& term, const Solution& fit, const Reported& reported,
        const Setup& setup)
      : model_(model), term_(term), fit_(fit), reported_(reported), setup_(setup) {}

  /// f_j at slide coordinates x.
  [[nodiscard]] Eigen::MatrixXd columns(const Eigen::VectorXd& x) const {
    return form_columns(model_, term_, shapes_of(term_, fit_.estimate.shapes), setup_, x);
  }

  /// What the nearest polynomials leave of a curve beside them (OtherForm), per knot; no columns
  /// where there is none.
  [[nodiscard]] Eigen::MatrixXd left_of_curve(const Eigen::VectorXd& x) const {
    const auto& form = fit_.other_form;
    if (!form) return Eigen::MatrixXd::Zero(x.size(), 0);
    return form_columns(model_, form->curve, {}, setup_, x)
               .middleCols(form->curve.effect->knots()->first, form->nearest.cols()) -
           columns(x) * form->nearest;
  }

  [[nodiscard]] double value(const Eigen::RowVectorXd& weighted) const {
    return weighted.dot(fit_.estimate.amplitudes.segment(term_.first_amplitude, weighted.size()));
  }

  /// Of a weighted sum of the amplitudes, and the same of left_of_curve().
  [[nodiscard]] Spread spread(const Eigen::RowVectorXd& weighted,
                              const Eigen::RowVectorXd& left) const {
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(fit_.uncertainty.basis.rows());
    row.segment(term_.first_amplitude, weighted.size()) = weighted;
    Spread out = reported_.spread(row);
    if (left.size() == 0) return out;
    const OtherForm& form = *fit_.other_form;
    const double more = (left * form.moments * (left + 2.0 * row * form.moved).transpose()).value();
    out.standard_uncertainty =
        std::sqrt(std::max(out.standard_uncertainty * out.standard_uncertainty + more, 0.0));
    return out;
  }

  /// Whether a weighted sum is the same along every direction that the data leave open.
  [[nodiscard]] bool is_determined(const Eigen::RowVectorXd& weighted) const {
    const Eigen::MatrixXd along =
        fit_.null.amplitudes.middleRows(term_.first_amplitude, weighted.size());
    for (Eigen::Index j = 0; j < along.cols(); ++j)
      if (std::abs(weighted.dot(along.col(j))) > kRounding * weighted.norm() * along.col(j).norm())
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
    const Eigen::MatrixXd rows = from_line(columns(x), columns(ends)),
                          left = from_line(left_of_curve(x), left_of_curve(ends));
    std::vector<QuantityValue> out(static_cast<std::size_t>(x.size()));
    for (Eigen::Index i = 0; i < x.size(); ++i)
      Reported::set(value(rows.row(i)), spread(rows.row(i), left.row(i)), kMicrometre,
                    out[static_cast<std::size_t>(i)]);
    return out;
  }

 private:
  const Model& model_;
  const ModelTerm& term_;
  const Solution& fit_;
  const Reported& reported_;
  Setup setup_;
};

/// Slide coordinates of the readings, of a bridge those of its feet; at most kMostStations.
Eigen::VectorXd station_positions(const Model& model, const ModelTerm& term) {
  std::vector<double> x;
  for (const Observation* observation : fitted_observations(model)) {
    const Profile& profile = *observation->profile;
    if (profile.setup.kind != Kind::slide || !term.acts_on(profile)) continue;
    const Stations stations = profile.stations(model.machine);
    const double foot = profile.setup.base_mm.value_or(0.0) / 2.0;
    for (Eigen::Index i = 0; i < stations.size(); ++i)
      for (const double at : {stations.slide(i) - foot, stations.slide(i) + foot}) x.push_back(at);
  }
  if (x.empty()) return {};
  std::ranges::sort(x);
  const double same = 1e-3 * (x.back() - x.front()) / static_cast<double>(x.size());
  x.erase(std::unique(x.begin(), x.end(), [&](double a, double b) { return b - a <= same; }),
          x.end());
  const std::size_t count = std::min(kMostStations, x.size());
  Eigen::VectorXd out(static_cast<Eigen::Index>(count));
  for (std::size_t i = 0; i < count; ++i)
    out[static_cast<Eigen::Index>(i)] = x[count == 1 ? 0 : i * (x.size() - 1) / (count - 1)];
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

/// All but offset and slope, which the reference line takes.
bool is_determined(const ModelTerm& term, const Solution& fit) {
  const std::vector<Parameter>& parameters = term.effect->parameters();
  for (std::size_t p = 0; p < parameters.size(); ++p)
    if (!fit.null.identifiable[term.first_parameter + static_cast<Eigen::Index>(p)] &&
        !parameters[p].by_convention)
      return false;
  return true;
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
  const Eigen::MatrixXd ends = tip.columns(Eigen::Vector2d(travel.least, travel.greatest));
  const Eigen::RowVectorXd rise = ends.row(1) - ends.row(0);
  if (tip.is_determined(rise))
    out.tip_slope_rad = tip.value(rise) / (travel.greatest - travel.least);
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

std::optional<Straightness> straightness_of(const Model& model, const ModelTerm& term,
                                            const Solution& fit, const MoreVariance& more) {
  const SlideRange travel = measured_travel(model, &term);
  if (!(travel.greatest > travel.least)) return std::nullopt;
  Straightness out;
  if (!is_determined(term, fit)) {
    out.reason = "these data do not tell the straightness from another effect";
    return out;
  }
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(kPoints, travel.least, travel.greatest);
  const Reported reported(fit, more);
  const Locus slide(model, term, fit, reported, on_slide());
  const Eigen::MatrixXd columns = slide.columns(x),
                        forms = least_squares_line(x, x).deviations(x, columns);
  if (forms.norm() <= kRounding * columns.norm()) {
    out.reason = "a straightness of degree 1 is a line, which deviates from no line";
    return out;
  }
  if (const auto& prior = fit.estimate.curve; prior && &term == curve_term(model))
    out.form = CurveForm{prior->length_mm, prior->amplitude_mm / kMicrometre, prior->roughness};
  out.curve.position_mm.assign(x.begin(), x.end());
  append(slide.deviations(x, travel), out.curve.deviation_um, out.curve.expanded_uncertainty_um);
  if (const Setup* const face = one_face(model))
    add_tip(Locus(model, term, fit, reported, *face), x, travel, out.curve);
  const Eigen::VectorXd stations = station_positions(model, term);
  const std::vector<QuantityValue> heights = slide.deviations(stations, travel);
  for (std::size_t i = 0; i < heights.size(); ++i)
    out.stations.push_back({stations[static_cast<Eigen::Index>(i)], *heights[i].value,
                            heights[i].expanded_uncertainty});
  const Eigen::VectorXd form =
      forms * fit.estimate.amplitudes.segment(term.first_amplitude, columns.cols());
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
    const double U = std::max(least_U, reach_of_pairs(deviation, spread_between) - line.error);
    spread.standard_uncertainty =
        std::max(spread.standard_uncertainty, U / coverage_factor(spread.degrees_of_freedom));
    add_error(line, x, spread, out);
  }
  return out;
}

/// |E_ZX| and its U; infinite where it is not determined.
double reach(const Straightness& form) {
  return form.end_point_um && form.expanded_uncertainty_um
             ? *form.end_point_um + *form.expanded_uncertainty_um
             : INFINITY;
}

}  // namespace

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
