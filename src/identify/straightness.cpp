#include "slideway/identify/straightness.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

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

ReferenceLine through(const std::string& name, const Eigen::VectorXd& x, const Eigen::VectorXd& z,
                      Eigen::Index a, Eigen::Index b) {
  ReferenceLine line{name};
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
      ReferenceLine line = through("minimum zone", x, z, corners[i], corners[i + 1]);
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

}  // namespace

ReferenceLine least_squares_line(const Eigen::VectorXd& x, const Eigen::VectorXd& z) {
  ReferenceLine line{"least squares"};
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
  return {through("end-point", positions, heights, 0, positions.size() - 1),
          least_squares_line(positions, heights), minimum_zone(positions, heights)};
}

std::optional<IdentifiedStraightness> identified_straightness(const Model& model,
                                                              const Solution& fit,
                                                              const MoreVariance& more) {
  const ModelTerm* term = model.find_term(MotionError::straightness);
  if (!term || !(model.range.slide_max > model.range.slide_min)) return std::nullopt;
  const Eigen::VectorXd x =
      Eigen::VectorXd::LinSpaced(kPoints, model.range.slide_min, model.range.slide_max);
  const Eigen::MatrixXd columns = along_slide(*term->effect, model.machine, x, Quantity::height,
                                              shapes_of(*term, fit.estimate.shapes));
  const Eigen::Index first = term->first_amplitude, count = columns.cols();
  const Eigen::MatrixXd deviations = least_squares_deviations(x);
  IdentifiedStraightness out;
  if (!is_determined(*term, fit)) {
    out.reason = "these data do not tell the straightness from another effect";
    return out;
  }
  const auto spread = [&](const Eigen::RowVectorXd& weights) {
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(fit.uncertainty.basis.rows());
    row.segment(first, count) = weights * columns;
    Spread widened = fit.uncertainty.of(row);
    if (more)
      widened.standard_uncertainty = std::hypot(widened.standard_uncertainty, std::sqrt(more(row)));
    return widened;
  };
  const Eigen::VectorXd heights = columns * fit.estimate.amplitudes.segment(first, count);
  const Eigen::VectorXd from_line = deviations * heights;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const Spread own = spread(deviations.row(i));
    out.position_mm.push_back(x[i]);
    out.deviation_um.push_back(from_line[i] / kMicrometre);
    out.expanded_uncertainty_um.push_back(coverage_factor(own.degrees_of_freedom) *
                                          own.standard_uncertainty / kMicrometre);
  }
  for (const ReferenceLine& line : reference_lines(x, from_line)) {
    const Spread own = spread(line.sensitivity);
    const double k = coverage_factor(own.degrees_of_freedom);
    const double u = own.standard_uncertainty / kMicrometre;
    out.errors.push_back({line.name, line.error / kMicrometre, line.highest / kMicrometre,
                          x[static_cast<Eigen::Index>(line.highest_at)], line.lowest / kMicrometre,
                          x[static_cast<Eigen::Index>(line.lowest_at)], u, k * u, k});
  }
  return out;
}

}  // namespace slideway
