#include "detection.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "response.hpp"
#include "search_round.hpp"
#include "slideway/base/distribution.hpp"
#include "slideway/base/parallel.hpp"
#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/identify/curve_prior.hpp"
#include "slideway/identify/linear_algebra.hpp"
#include "slideway/identify/straightness.hpp"
#include "undescribed.hpp"

namespace slideway {
namespace {

constexpr double kNormal = 1e9;  // degrees of freedom: Student's t is normal
constexpr int kSpreadShapes = 5;
constexpr double kNearZero = 1e-9;  // of a range, about zero
constexpr int kMostRounds = 8;      // of a limit that depends on itself

/// Values of the first shape from one end of what the search looks at to the other, in the
/// logarithm unless they are positions, at the nodes of Chebyshev: what lies between them can be
/// interpolated, near the ends too. The other shapes stand in the middle of theirs. One empty shape
/// for a candidate without.
std::vector<std::vector<double>> spread_shapes(const Candidate& candidate) {
  if (candidate.grid.axes().empty()) return {{}};
  const std::vector<double>& axis = candidate.grid.axes().front();
  const double first = axis.front(), last = axis.back();
  const bool linear = candidate.term.effect->shapes()[0].stepwise || !(first > 0.0);
  std::vector<std::vector<double>> out(kSpreadShapes, candidate.grid.middle());
  for (int i = 0; i < kSpreadShapes; ++i) {
    const double share = 0.5 - 0.5 * std::cos(kPi * (i + 0.5) / kSpreadShapes);
    const double value =
        linear ? first + share * (last - first) : first * std::pow(last / first, share);
    out[static_cast<std::size_t>(i)][0] =
        std::abs(value) > kNearZero * (last - first) ? value : 0.0;
  }
  return out;
}

/// The parameters of the model that make a candidate's column; none: levelling does.
std::vector<std::string> made_by(const Model& model, const Solution& fit,
                                 const Eigen::VectorXd& column) {
  const Linearisation& linear = fit.linear;
  const Eigen::MatrixXd columns =
      stack(linear, linear.prior_rows.cols(), [&](std::size_t i) { return linear.columns[i]; });
  const Eigen::VectorXd amplitudes = beside_levelling(linear, columns, column);
  const Eigen::VectorXd parameters = fit.parameters.jacobian * amplitudes;
  const Eigen::MatrixXd back =
      Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(fit.parameters.jacobian)
          .pseudoInverse();
  const std::vector<std::string> names = model.parameter_names();
  std::vector<std::string> out;
  for (Eigen::Index p = 0; p < parameters.size(); ++p) {
    if (fit.null.identifiable.size() > static_cast<std::size_t>(p) &&
        !fit.null.identifiable[static_cast<std::size_t>(p)])
      continue;
    const double share =
        (columns * back.col(p) * parameters[p]).norm() / std::max(column.norm(), 1e-300);
    if (share > model.gates.absorbed_share) out.push_back(names[static_cast<std::size_t>(p)]);
  }
  return out;
}

/// One effect at one shape.
struct Case {
  const Model& model;
  const Candidate& candidate;
  std::span<const double> shape;
  Eigen::MatrixXd columns;

  /// Amplitudes where the first parameter has this value.
  [[nodiscard]] Eigen::VectorXd amplitudes(double size) const {
    const Effect& effect = *candidate.term.effect;
    Eigen::VectorXd values =
        Eigen::VectorXd::Zero(static_cast<Eigen::Index>(effect.parameters().size()));
    values[0] = size;
    for (std::size_t s = 0; s < shape.size(); ++s) values[effect.shapes()[s].parameter] = shape[s];
    return effect.from_parameters(values).head(candidate.amplitudes());
  }
};

/// What an effect that is just not seen may move, as sums of (amplitudes, shapes): the squareness
/// and the deviations of the straightness, as far as the data determine them.
struct Targets {
  Eigen::MatrixXd rows;  // the squareness first
  bool squareness = false;
  Eigen::VectorXd form;  // the deviations, mm
};

/// What an effect has to show itself in, and the least gain that counts.
struct Design {
  const FittedModel& fitted;
  const Whitened& data;
  const Whitened fit_data;  // under the noise that the report's uncertainties rest on
  double least_gain;
  double deviate;  // normal deviate of the detection power
  Targets targets;
  RowResponse moved;  // of them, no further values left out

  [[nodiscard]] const Gates& gates() const { return fitted.model.gates; }
};

/// Size whose gain is seen with the detection power in these data.
std::optional<double> seen_in(const Design& design, const Whitened& data, const Case& one) {
  const Gates& gates = design.gates();
  const Projection own = project(data, one.columns);
  if (own.rank == 0) return std::nullopt;
  const double enough = std::max(
      penalty(data, one.candidate.unknowns(own.rank)) + design.least_gain, gates.size * gates.size);
  const double noncentrality =
      chi_squared_noncentrality(static_cast<double>(own.rank), enough, 1.0 - gates.detection_power);
  const Eigen::Index a = one.candidate.amplitudes();
  // Gain of one unit of the first parameter; the mean over its phase, where it has one.
  const double gain = own.gram.diagonal().head(std::min<Eigen::Index>(a, 2)).mean() *
                      one.amplitudes(1.0).squaredNorm();
  if (!(gain > 0.0) || !std::isfinite(noncentrality)) return std::nullopt;
  return std::sqrt(noncentrality / gain);
}

/// Size found in them: seen, and known to the size in uncertainties that is asked for.
std::optional<double> found_in(const Design& design, const Whitened& data, const Case& one) {
  const std::optional<double> seen = seen_in(design, data, one);
  if (!seen || one.shape.empty()) return seen;
  const Eigen::Index a = one.candidate.amplitudes();
  const Eigen::VectorXd inner = one.amplitudes(*seen);
  Eigen::MatrixXd joint(data.rows(), a + std::ssize(one.shape));
  joint.leftCols(a) = one.columns;
  joint.rightCols(std::ssize(one.shape)) =
      stacked_slopes(one.model, one.candidate.term, one.shape, inner, data.rows() - data.values());
  const Eigen::MatrixXd covariance = amplitude_covariance(data.outside(std::move(joint)));
  const double relative =
      relative_uncertainty(*one.candidate.term.effect, inner, one.shape, covariance);
  if (!std::isfinite(relative)) return std::nullopt;
  return *seen * std::max(1.0, (design.gates().size + design.deviate) * relative);
}

struct Limit {
  double size = 0.0;
  FreeValues undescribed;  // that an effect of this size takes out of the search
};

/// Of one of the two sizes; an effect that is steep at the centre takes the values there out of the
/// search, the more of them the larger it is.
template <typename SizeIn>
std::optional<Limit> limit_of(const Design& design, const Case& one, const SizeIn& size_in) {
  const auto& [model, fit] = design.fitted;
  std::optional<double> size = size_in(design, design.data, one);
  FreeValues lost;
  const int rounds = one.candidate.term.effect->description().steep_at_centre ? kMostRounds : 0;
  for (int round = 0; size && round < rounds; ++round) {
    FreeValues undescribed =
        undescribed_beside(model, fit, design.data.noise(), one.columns * one.amplitudes(*size));
    if (count_of(undescribed) <= count_of(lost)) break;
    lost = std::move(undescribed);
    size = size_in(design, {fit.linear, design.data.noise(), lost}, one);
  }
  if (!size) return std::nullopt;
  return Limit{*size, std::move(lost)};
}

std::optional<double> found_from(const Design& design, const Case& one) {
  std::optional<Limit> limit = limit_of(design, one, found_in);
  if (!limit) return std::nullopt;
  if (one.candidate.term.effect->description().steep_at_centre) return limit->size;
  const double uncertainty =
      1.0 / design.fit_data.outside(one.columns * one.amplitudes(1.0)).norm();
  return std::max(limit->size, (design.gates().size + design.deviate) * uncertainty);
}

/// Sizes of what an effect that is just not seen does.
struct Moved {
  std::optional<double> squareness_rad, straightness_um;
};

/// From the highest to the lowest of deviations from the line through the ends.
double error_of(const Eigen::VectorXd& deviations) {
  return std::max(deviations.maxCoeff(), 0.0) - std::min(deviations.minCoeff(), 0.0);
}

Moved moved_unseen(const Design& design, const Case& one) {
  const Targets& targets = design.targets;
  const std::optional<Limit> limit = limit_of(design, one, seen_in);
  Eigen::VectorXd by = Eigen::VectorXd::Zero(targets.rows.rows());
  if (limit) {  // else the model makes its columns: not separable
    Eigen::VectorXd signal = one.columns * one.amplitudes(limit->size);
    by = count_of(limit->undescribed) == 0
             ? design.moved.to(std::move(signal))
             : RowResponse(design.fitted.fit, targets.rows, limit->undescribed)
                   .to(std::move(signal));
  }
  constexpr double kNothing = 1e-15;  // rad, 1 nm in 1000 km; mm
  const auto size = [](double value) { return std::abs(value) < kNothing ? 0.0 : std::abs(value); };
  Moved out;
  if (targets.squareness) out.squareness_rad = size(by[0]);
  if (targets.form.size() == 0) return out;
  const Eigen::VectorXd& form = targets.form;
  const Eigen::VectorXd of_form = by.tail(form.size());
  const double now = error_of(form);
  out.straightness_um = size(std::max(std::abs(error_of(form + of_form) - now),
                                      std::abs(error_of(form - of_form) - now))) /
                        kMicrometre;
  return out;
}

void raise(std::optional<double>& most, const std::optional<double>& value) {
  if (value) most = std::max(most.value_or(0.0), *value);
}

/// Whether no profile would hold more of this signal than so many times its own range.
bool is_flatness(const Linearisation& linear, const Eigen::VectorXd& signal, double most_of_range) {
  Eigen::Index first = 0;
  for (const Observation* observation : linear.observations) {
    const Eigen::VectorXd& values = observation->values;
    const double most = most_of_range * (values.maxCoeff() - values.minCoeff());
    if (!(signal.segment(first, values.size()).cwiseAbs().maxCoeff() <= most)) return false;
    first += values.size();
  }
  return true;
}

Targets targets_of(const FittedModel& fitted) {
  const auto& [model, fit] = fitted;
  Targets out;
  const ModelTerm* const squareness = model.find_term(MotionError::squareness);
  out.squareness =
      squareness && fit.null.identifiable[static_cast<std::size_t>(squareness->first_parameter)];
  const ModelTerm* const form = model.find_term(MotionError::straightness);
  Eigen::MatrixXd deviations;
  if (form && is_determined(*form, fit))
    deviations = deviations_from_ends(model, *form, fit, measured_travel(model, form));
  const Eigen::Index first = out.squareness ? 1 : 0;
  out.rows = Eigen::MatrixXd::Zero(first + deviations.rows(), fit.parameters.jacobian.cols());
  if (out.squareness) out.rows.row(0) = fit.parameters.jacobian.row(squareness->first_parameter);
  if (deviations.rows() == 0) return out;
  out.rows.block(first, form->first_amplitude, deviations.rows(), deviations.cols()) = deviations;
  out.form = deviations * fit.estimate.amplitudes.segment(form->first_amplitude, deviations.cols());
  return out;
}

/// Over all shapes, stated for the one nearest to the middle that has a limit.
std::optional<DetectionLimit> detection_limit(const Design& design, const Candidate& candidate) {
  if (!candidate.term.effect->has_one_size()) return std::nullopt;
  const Parameter& first = candidate.term.effect->parameters()[0];
  DetectionLimit out;
  out.effect = candidate.name();
  out.parameter = first.name;
  out.unit = first.unit;
  // A curve takes every form of the slide as its own: there is nothing that it would not show.
  const bool is_in_curve = curve_term(design.fitted.model) &&
                           is_part_of_straightness(candidate.term.effect->description());
  const std::vector<std::vector<double>> shapes = spread_shapes(candidate);
  const auto middle = std::ssize(shapes) / 2;
  std::ptrdiff_t nearest = std::ssize(shapes);  // places from the middle
  for (std::ptrdiff_t s = 0; s < std::ssize(shapes); ++s) {
    const std::vector<double>& shape = shapes[static_cast<std::size_t>(s)];
    const Model& model = design.fitted.model;
    const Case one{
        model, candidate, shape,
        stacked_columns(model, candidate.term, shape, design.data.rows() - design.data.values())};
    if (design.targets.rows.rows() > 0) {
      const Moved moved = moved_unseen(design, one);
      raise(out.squareness_rad, moved.squareness_rad);
      if (!is_in_curve) raise(out.straightness_um, moved.straightness_um);
    }
    const Parameter& size = candidate.term.effect->parameters().front();
    const std::optional<double> limit = found_from(design, one);
    if (!limit || !(*limit > 0.0) || !(*limit <= size.upper) || !std::isfinite(*limit) ||
        !is_flatness(design.fitted.fit.linear, one.columns * one.amplitudes(*limit),
                     design.gates().most_of_range))
      continue;
    if (!shape.empty()) out.by_shape.push_back({shape[0], *limit});
    if (std::abs(s - middle) >= nearest) continue;
    nearest = std::abs(s - middle);
    out.value = *limit;
    out.at = shape_text(candidate, shape);
  }
  if (!out.value) return std::nullopt;
  return out;
}

}  // namespace

double relative_uncertainty(const Effect& effect, const Eigen::VectorXd& amplitudes,
                            std::span<const double> shape, const Eigen::MatrixXd& covariance) {
  const ParameterValues at = effect.parameter_values(amplitudes, shape);
  const Eigen::RowVectorXd row = at.jacobian.row(effect.decisive_parameter());
  return std::sqrt((row * covariance * row.transpose()).value()) /
         std::abs(at.values[effect.decisive_parameter()]);
}

std::string shape_text(const Candidate& candidate, std::span<const double> shape) {
  const Effect& effect = *candidate.term.effect;
  std::vector<std::string> out;
  for (std::size_t s = 0; s < shape.size(); ++s) {
    const auto p = static_cast<std::size_t>(effect.shapes()[s].parameter);
    out.push_back(effect.parameters()[p].name + " = " + significant(shape[s], 3));
  }
  return joined(out);
}

std::vector<DetectionLimit> detection_limits(const FittedModel& fitted, const Whitened& data,
                                             const std::vector<Noise>& fit_noise,
                                             const Candidates& candidates,
                                             const Calibration& calibration) {
  const Gates& gates = fitted.model.gates;
  Targets targets = targets_of(fitted);
  RowResponse moved(fitted.fit, targets.rows);
  const Design design{fitted,
                      data,
                      Whitened(fitted.fit.linear, fit_noise),
                      std::max(gates.delta_bic, calibration.threshold(gates.significance)),
                      student_limit(kNormal, 1.0 - gates.detection_power),
                      std::move(targets),
                      std::move(moved)};
  std::vector<std::optional<DetectionLimit>> limits(candidates.size());
  parallel_for(candidates.size(),
               [&](std::size_t c) { limits[c] = detection_limit(design, *candidates[c]); });
  std::vector<DetectionLimit> out;
  for (std::optional<DetectionLimit>& limit : limits)
    if (limit) out.push_back(std::move(*limit));
  return out;
}

std::vector<NotSeparable> inseparable(const Model& model, const Solution& fit, const Whitened& data,
                                      const Candidates& candidates) {
  std::vector<std::optional<NotSeparable>> found(candidates.size());
  parallel_for(candidates.size(), [&](std::size_t i) {
    const Candidate& candidate = *candidates[i];
    const Eigen::MatrixXd columns = stacked_columns(model, candidate.term, candidate.grid.middle(),
                                                    data.rows() - data.values());
    const bool is_whole = project(data, columns).rank == 0;
    if (!is_whole && !candidate.term.effect->shapes().empty()) return;
    for (Eigen::Index j = 0; j < columns.cols() && !found[i]; ++j) {
      const Eigen::VectorXd column = columns.col(j);
      if (column.isZero(0.0) || !(is_whole || project(data, column).rank == 0)) continue;
      const std::vector<std::string> by = made_by(model, fit, column);
      if (!by.empty())
        found[i] = {candidate.name(), joined(by)};
      else if (is_whole)
        found[i] = {candidate.name(), "offset and tilt of the traces"};
    }
  });
  std::vector<NotSeparable> out;
  for (std::optional<NotSeparable>& each : found)
    if (each) out.push_back(*std::move(each));
  return out;
}

}  // namespace slideway
