#include "slideway/identify/straightness.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "reported.hpp"
#include "residual.hpp"

namespace slideway {
namespace {

constexpr Eigen::Index kPoints = 201;

/// Deviation of each point from the least-squares line: deviations = matrix * heights.
Eigen::MatrixXd least_squares_deviations(const Eigen::VectorXd& x) {
  Eigen::MatrixXd line(x.size(), 2);
  line.col(0).setOnes();
  line.col(1) = x.array() - x.mean();
  const Eigen::MatrixXd q =
      line.householderQr().householderQ() * Eigen::MatrixXd::Identity(x.size(), 2);
  return Eigen::MatrixXd::Identity(x.size(), x.size()) - q * q.transpose();
}

void evaluate(const Eigen::VectorXd& x, const Eigen::VectorXd& z, ReferenceLine& line) {
  const Eigen::VectorXd deviation = z.array() - line.at_zero - line.slope * x.array();
  Eigen::Index high = 0, low = 0;
  line.highest = deviation.maxCoeff(&high);
  line.lowest = deviation.minCoeff(&low);
  line.highest_at = static_cast<std::size_t>(high);
  line.lowest_at = static_cast<std::size_t>(low);
  line.error = line.highest - line.lowest;
}

ReferenceLine through(ReferenceLineKind kind, const Eigen::VectorXd& x, const Eigen::VectorXd& z,
                      Eigen::Index a, Eigen::Index b) {
  ReferenceLine line{kind};
  line.slope = (z[b] - z[a]) / (x[b] - x[a]);
  line.at_zero = z[a] - line.slope * x[a];
  evaluate(x, z, line);
  line.sensitivity = Eigen::RowVectorXd::Zero(x.size());
  const auto high = static_cast<Eigen::Index>(line.highest_at),
             low = static_cast<Eigen::Index>(line.lowest_at);
  line.sensitivity[high] += 1.0;
  line.sensitivity[low] -= 1.0;
  const double tilt = (x[high] - x[low]) / (x[b] - x[a]);
  line.sensitivity[b] -= tilt;
  line.sensitivity[a] += tilt;
  return line;
}

/// Indices of the upper (sign 1) or lower (-1) convex hull.
std::vector<Eigen::Index> hull(const Eigen::VectorXd& x, const Eigen::VectorXd& z, double sign) {
  std::vector<Eigen::Index> out;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    while (out.size() > 1) {
      const Eigen::Index a = out[out.size() - 2], b = out.back();
      const double turn = (x[b] - x[a]) * (z[i] - z[a]) - (z[b] - z[a]) * (x[i] - x[a]);
      if (sign * turn < 0.0) break;
      out.pop_back();
    }
    out.push_back(i);
  }
  return out;
}

/// The narrowest strip touches an edge of the convex hull.
ReferenceLine minimum_zone(const Eigen::VectorXd& x, const Eigen::VectorXd& z) {
  std::optional<ReferenceLine> best;
  for (const double sign : {1.0, -1.0}) {
    const std::vector<Eigen::Index> corners = hull(x, z, sign);
    for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
      ReferenceLine line =
          through(ReferenceLineKind::minimum_zone, x, z, corners[i], corners[i + 1]);
      if (!best || line.error < best->error) best = std::move(line);
    }
  }
  best->at_zero += 0.5 * (best->highest + best->lowest);  // the line in the middle of the strip
  evaluate(x, z, *best);
  return *best;
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

}  // namespace

ReferenceLine least_squares_line(const Eigen::VectorXd& x, const Eigen::VectorXd& z) {
  ReferenceLine line{ReferenceLineKind::least_squares};
  const Eigen::VectorXd centred = x.array() - x.mean();
  line.slope = centred.dot(z) / centred.squaredNorm();
  line.at_zero = z.mean() - line.slope * x.mean();
  evaluate(x, z, line);
  const Eigen::MatrixXd deviations = least_squares_deviations(x);
  line.sensitivity = deviations.row(static_cast<Eigen::Index>(line.highest_at)) -
                     deviations.row(static_cast<Eigen::Index>(line.lowest_at));
  return line;
}

std::vector<ReferenceLine> reference_lines(const Eigen::VectorXd& positions,
                                           const Eigen::VectorXd& heights) {
  return {through(ReferenceLineKind::end_point, positions, heights, 0, positions.size() - 1),
          least_squares_line(positions, heights), minimum_zone(positions, heights)};
}

std::optional<Straightness> identified_straightness(const Model& model, const Solution& fit,
                                                    const MoreVariance& more) {
  const ModelTerm* term = model.find_term(MotionError::straightness);
  if (!term || !(model.range.slide_max > model.range.slide_min)) return std::nullopt;
  Straightness out;
  if (!is_determined(*term, fit)) {
    out.reason = "these data do not tell the straightness from another effect";
    return out;
  }
  const Eigen::VectorXd x =
      Eigen::VectorXd::LinSpaced(kPoints, model.range.slide_min, model.range.slide_max);
  const Eigen::MatrixXd columns = along_slide(*term->effect, model.machine, x, Quantity::height,
                                              shapes_of(*term, fit.estimate.shapes));
  const Eigen::Index first = term->first_amplitude, count = columns.cols();
  const Reported reported(fit, more);
  const auto spread = [&](const Eigen::RowVectorXd& weights) {
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(fit.uncertainty.basis.rows());
    row.segment(first, count) = weights * columns;
    return reported.spread(row);
  };
  const Eigen::MatrixXd deviations = least_squares_deviations(x);
  const Eigen::VectorXd from_line =
      deviations * columns * fit.estimate.amplitudes.segment(first, count);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    QuantityValue own;
    Reported::set(from_line[i], spread(deviations.row(i)), kMicrometre, own);
    out.curve.position_mm.push_back(x[i]);
    out.curve.deviation_um.push_back(*own.value);
    out.curve.expanded_uncertainty_um.push_back(*own.expanded_uncertainty);
  }
  for (const ReferenceLine& line : reference_lines(x, from_line))
    add_error(line, x, spread(line.sensitivity), out);
  return out;
}

}  // namespace slideway
