#include "slideway/identify/identifiability.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <set>

namespace slideway {
namespace {

constexpr double kRankTolerance = 1e-9;  // of a unit column; columns carry rounding of about 1e-15
constexpr double kAbsent = 1e-6;         // a coefficient this small in a null direction is rounding

/// Which parameter of a null direction gives way: the higher the sooner. Offset and slope of a
/// straightness are fixed by convention, c_1 is a squareness.
int gauge_order(const std::string& parameter) {
  if (parameter.ends_with(".b0")) return 5;
  if (parameter.ends_with(".b1")) return 4;
  if (parameter.starts_with("vertical_straightness")) return 3;
  if (parameter.starts_with("straightness")) return 1;
  if (parameter.starts_with("squareness")) return 0;
  return 2;
}

/// Column-reduces `parameters` (scaled, P by d) so that each column has an own row: a 1 where all
/// other columns have 0. The same operations go to `amplitudes`.
std::vector<Eigen::Index> reduce(Eigen::MatrixXd& parameters, Eigen::MatrixXd& amplitudes,
                                 const std::vector<int>& order) {
  std::vector<Eigen::Index> own;
  std::vector<bool> taken(parameters.rows(), false);
  for (Eigen::Index step = 0; step < parameters.cols(); ++step) {
    const double largest = parameters.rightCols(parameters.cols() - step).cwiseAbs().maxCoeff();
    Eigen::Index row = -1, column = -1;
    double best = -1.0;
    for (Eigen::Index i = 0; i < parameters.rows(); ++i)
      for (Eigen::Index j = step; j < parameters.cols(); ++j) {
        const double size = std::abs(parameters(i, j));
        if (taken[i] || size < 0.05 * largest) continue;
        const double merit = order[i] + size / largest / 2.0;
        if (merit > best) best = merit, row = i, column = j;
      }
    if (row < 0) break;
    taken[row] = true;
    own.push_back(row);
    parameters.col(step).swap(parameters.col(column));
    amplitudes.col(step).swap(amplitudes.col(column));
    const double pivot = parameters(row, step);
    parameters.col(step) /= pivot;
    amplitudes.col(step) /= pivot;
    for (Eigen::Index j = 0; j < parameters.cols(); ++j) {
      if (j == step) continue;
      const double factor = parameters(row, j);
      parameters.col(j) -= factor * parameters.col(step);
      amplitudes.col(j) -= factor * amplitudes.col(step);
    }
  }
  return own;
}

std::string advice(const std::vector<std::string>& names, const Model& model) {
  const auto any = [&](auto&& test) { return std::any_of(names.begin(), names.end(), test); };
  const auto has = [&](const std::string& name) {
    return any([&](const std::string& n) { return n == name; });
  };
  const auto of = [&](const std::string& effect) {
    return any([&](const std::string& n) { return n.starts_with(effect + "."); });
  };
  if (std::all_of(names.begin(), names.end(), fixed_by_convention))
    return "offset and slope of a straightness are fixed by its reference line (ISO 230-1), not by "
           "these data; no measurement is needed";
  if (has("squareness.dbeta_xz") && has("vertical_straightness.c1"))
    return "no face can tell c_1 from the squareness: both tilt the Z carriage by a constant; read "
           "the "
           "straightness of the Z carriage along Z, or measure the squareness itself (run-out, Eq. "
           "21)";
  if (of("vertical_straightness") && of("squareness"))
    return "cut faces at more Z levels (z_mm): each further level determines one more c_k";
  if (of("vertical_straightness"))
    return "cut faces at more Z levels (z_mm), with an offset that levelling has not removed or "
           "with "
           "lever = \"paper\"; read the straightness of the Z carriage along Z";
  if (of("squareness") && names.size() == 1)
    return "levelling has removed it: trace a full diameter (the squareness comes back as a cone), "
           "or keep "
           "the tilt against the spindle axis (free = [\"offset\"])";
  if (of("squareness") && of("straightness"))
    return "the squareness is the slope of the face: give the slope of the straightness by a prior "
           "(an "
           "autocollimator against the spindle axis), or measure the squareness itself (run-out, "
           "Eq. 21)";
  if (of("straightness") && model.terms.size() > 1)
    return "one profile cannot tell them apart: read the straightness along the slide (kind = "
           "\"slide\"), give a prior, or cut with another feed or direction";
  return "measure more of the travel, or more profiles that differ in feed, direction, overhang or "
         "Z";
}

}  // namespace

bool fixed_by_convention(const std::string& parameter) {
  return parameter.ends_with(".b0") || parameter.ends_with(".b1");
}

Rank analyse_rank(const Eigen::MatrixXd& triangle, const Eigen::VectorXd& scale) {
  const Eigen::Index n = triangle.cols();
  Rank rank{Eigen::MatrixXd(n, 0), Eigen::MatrixXd::Identity(n, n)};
  if (triangle.size() == 0) return rank;
  const Eigen::VectorXd unit = scale.unaryExpr([](double s) { return s > 0.0 ? s : 1.0; });
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(triangle * unit.cwiseInverse().asDiagonal(),
                                              Eigen::ComputeFullV);
  const Eigen::VectorXd& singular = svd.singularValues();
  Eigen::Index r = 0;
  while (r < singular.size() && singular[r] > kRankTolerance) ++r;
  rank.basis = unit.cwiseInverse().asDiagonal() * svd.matrixV().leftCols(r) *
               singular.head(r).cwiseInverse().asDiagonal();
  rank.null_space = unit.cwiseInverse().asDiagonal() * svd.matrixV().rightCols(triangle.cols() - r);
  if (r > 0) rank.condition = singular[0] / singular[r - 1];
  return rank;
}

NullDirections null_directions(const Model& model, const Eigen::MatrixXd& null_space,
                               const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& scale) {
  NullDirections null;
  const std::vector<std::string> names = model.parameter_names();
  std::vector<int> order;
  for (const std::string& name : names) order.push_back(gauge_order(name));
  null.amplitudes = null_space;
  Eigen::MatrixXd scaled = scale.asDiagonal() * (jacobian * null_space);
  null.own = reduce(scaled, null.amplitudes, order);
  null.identifiable.assign(names.size(), true);
  for (Eigen::Index j = 0; j < scaled.cols(); ++j) {
    const double largest = scaled.col(j).cwiseAbs().maxCoeff();
    for (Eigen::Index i = 0; i < scaled.rows(); ++i) {
      if (std::abs(scaled(i, j)) <= kAbsent * largest)
        scaled(i, j) = 0.0;
      else
        null.identifiable[i] = false;
    }
  }
  null.parameters = scale.cwiseInverse().asDiagonal() * scaled;
  for (std::size_t d = 0; d < null.own.size(); ++d) {
    const double unit = null.parameters(null.own[d], d);
    null.parameters.col(d) /= unit;
    null.amplitudes.col(d) /= unit;
  }
  return null;
}

std::vector<UndeterminedDirection> undetermined(const Model& model, const NullDirections& null) {
  const std::vector<std::string> names = model.parameter_names();
  std::vector<UndeterminedDirection> out;
  for (Eigen::Index d = 0; d < null.parameters.cols(); ++d) {
    UndeterminedDirection direction;
    std::vector<std::string> involved;
    const double length = null.parameters.col(d).norm();
    for (std::size_t p = 0; p < names.size(); ++p) {
      if (null.parameters(p, d) == 0.0) continue;
      direction.combination.emplace_back(names[p], null.parameters(p, d) / length);
      involved.push_back(names[p]);
    }
    direction.advice = advice(involved, model);
    out.push_back(std::move(direction));
  }
  return out;
}

Eigen::MatrixXd determined_rows(const NullDirections& null) {
  const std::set<Eigen::Index> own(null.own.begin(), null.own.end());
  std::vector<Eigen::RowVectorXd> rows;
  for (Eigen::Index p = 0; p < null.parameters.rows(); ++p) {
    if (null.identifiable[p] || own.contains(p)) continue;
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(null.parameters.rows());
    row[p] = 1.0;
    for (std::size_t d = 0; d < null.own.size(); ++d) row[null.own[d]] = -null.parameters(p, d);
    rows.push_back(row);
  }
  Eigen::MatrixXd out(rows.size(), null.parameters.rows());
  for (std::size_t i = 0; i < rows.size(); ++i) out.row(i) = rows[i];
  return out;
}

}  // namespace slideway
