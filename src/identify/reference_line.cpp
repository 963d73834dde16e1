#include "slideway/identify/reference_line.hpp"

#include <Eigen/Dense>
#include <optional>
#include <utility>

namespace slideway {
namespace {

/// What each point stands for of the length: of a form that is known between its points, too, half
/// of that at the ends (trapezoidal rule).
Eigen::VectorXd lengths_of(const Eigen::VectorXd& x) {
  const Eigen::Index last = x.size() - 1;
  Eigen::VectorXd out = Eigen::VectorXd::Zero(x.size());
  for (Eigen::Index i = 0; i < last; ++i) {
    out[i] += 0.5 * (x[i + 1] - x[i]);
    out[i + 1] += 0.5 * (x[i + 1] - x[i]);
  }
  return out;
}

void evaluate(const Eigen::VectorXd& x, const Eigen::VectorXd& z, ReferenceLine& line) {
  const Eigen::VectorXd deviation = line.deviations(x, z);
  Eigen::Index high = 0, low = 0;
  line.highest = deviation.maxCoeff(&high);
  line.lowest = deviation.minCoeff(&low);
  line.highest_at = static_cast<std::size_t>(high);
  line.lowest_at = static_cast<std::size_t>(low);
  line.error = line.highest - line.lowest;
}

ReferenceLine through(ReferenceLineKind kind, const Eigen::VectorXd& x, const Eigen::VectorXd& z,
                      Eigen::Index a, Eigen::Index b) {
  ReferenceLine line{kind, Eigen::Matrix2Xd::Zero(2, x.size())};
  line.of_heights(1, a) = -1.0 / (x[b] - x[a]);
  line.of_heights(1, b) = -line.of_heights(1, a);
  line.of_heights.row(0) = -x[a] * line.of_heights.row(1);
  line.of_heights(0, a) += 1.0;
  evaluate(x, z, line);
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
  const double middle = 0.5 * (best->highest + best->lowest);  // the line is there in the strip
  best->highest -= middle;
  best->lowest -= middle;
  return *best;
}

}  // namespace

Eigen::MatrixXd ReferenceLine::deviations(const Eigen::VectorXd& positions,
                                          const Eigen::MatrixXd& heights) const {
  const Eigen::MatrixXd line = of_heights * heights;
  return heights.rowwise() - line.row(0) - positions * line.row(1);
}

ReferenceLine least_squares_line(const Eigen::VectorXd& x, const Eigen::VectorXd& z) {
  ReferenceLine line{ReferenceLineKind::least_squares, Eigen::Matrix2Xd(2, x.size())};
  const Eigen::VectorXd lengths = lengths_of(x);
  const double whole = lengths.sum(), middle = lengths.dot(x) / whole;
  const Eigen::VectorXd centred = lengths.array() * (x.array() - middle);
  line.of_heights.row(1) = centred / centred.dot(x);
  line.of_heights.row(0) = lengths / whole - middle * line.of_heights.row(1).transpose();
  evaluate(x, z, line);
  return line;
}

ReferenceLine end_point_line(const Eigen::VectorXd& positions, const Eigen::VectorXd& heights) {
  return through(ReferenceLineKind::end_point, positions, heights, 0, positions.size() - 1);
}

std::vector<ReferenceLine> reference_lines(const Eigen::VectorXd& positions,
                                           const Eigen::VectorXd& heights) {
  return {end_point_line(positions, heights), least_squares_line(positions, heights),
          minimum_zone(positions, heights)};
}

}  // namespace slideway
