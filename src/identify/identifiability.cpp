#include "slideway/identify/identifiability.hpp"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "slideway/base/text.hpp"
#include "slideway/identify/solve.hpp"

namespace slideway {
namespace {

constexpr double kAbsent = 1e-6;         // a coefficient this small in a null direction is rounding
constexpr double kNullRounding = 100.0;  // last digits of one, for a condition of 1
constexpr double kExactlyNull = 1e-12;   // of a scaled column: what changes by less is rounding
constexpr double kUnseen = 0.1;          // of an uncertainty: adds 0.5 % to it

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

/// What to measure, from the first effect in the direction that has an advice of its own.
/// @param in_direction  P
std::string advice(const Model& model, const std::vector<bool>& in_direction) {
  std::vector<UndeterminedPart> parts(model.terms.size());
  for (std::size_t t = 0; t < model.terms.size(); ++t) {
    const std::vector<Parameter>& parameters = model.terms[t].effect->parameters();
    for (std::size_t p = 0; p < parameters.size(); ++p)
      if (in_direction[static_cast<std::size_t>(model.terms[t].first_parameter) + p])
        parts[t].own.push_back(parameters[p].name);
  }
  for (std::size_t t = 0; t < parts.size(); ++t) {
    if (parts[t].own.empty()) continue;
    std::vector<const Setup*> setups;
    for (const Observation* observation : fitted_observations(model))
      if (model.terms[t].acts_on(*observation->profile))
        setups.push_back(&observation->profile->setup);
    const std::vector<std::string> lacking = model.terms[t].effect->lacking_together(setups);
    if (!lacking.empty()) return model.terms[t].name + " takes " + joined(lacking);
  }
  for (std::size_t t = 0; t < parts.size(); ++t) {
    if (parts[t].own.empty()) continue;
    for (std::size_t other = 0; other < parts.size(); ++other)
      if (other != t && !parts[other].own.empty())
        parts[t].others.push_back(model.terms[other].effect.get());
    parts[t].model_has_others = parts.size() > 1;
    if (std::string text = model.terms[t].effect->advice(parts[t]); !text.empty()) return text;
  }
  return "measure more of the travel, or more profiles that differ in feed, direction, overhang or "
         "Z";
}

/// Singular values, falling, and all right singular vectors.
std::pair<Eigen::VectorXd, Eigen::MatrixXd> singular_directions(const Eigen::MatrixXd& matrix) {
  constexpr Eigen::Index kFew = 64;  // columns; of more the exact small ones cost too much
  if (matrix.cols() > kFew) {
    const Eigen::BDCSVD<Eigen::MatrixXd> svd(matrix, Eigen::ComputeFullV);
    return {svd.singularValues(), svd.matrixV()};
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(matrix, Eigen::ComputeFullV);
  return {svd.singularValues(), svd.matrixV()};
}

}  // namespace

Rank analyse_rank(const Eigen::MatrixXd& triangle, const Eigen::VectorXd& scale, double tolerance) {
  Rank rank;
  rank.basis = rank.null_space = rank.nearly_null = Eigen::MatrixXd(triangle.cols(), 0);
  if (triangle.cols() == 0) return rank;
  const Eigen::VectorXd unit = scale.unaryExpr([](double s) { return s > 0.0 ? s : 1.0; });
  if (triangle.size() == 0) {  // nothing is asked, or nothing was measured
    rank.basis.resize(triangle.cols(), 0);
    rank.null_space = unit.cwiseInverse().asDiagonal();
    return rank;
  }
  const auto [singular, directions] =
      singular_directions(triangle * unit.cwiseInverse().asDiagonal());
  Eigen::Index r = 0;
  while (r < singular.size() && singular[r] > tolerance) ++r;
  rank.basis = unit.cwiseInverse().asDiagonal() * directions.leftCols(r) *
               singular.head(r).cwiseInverse().asDiagonal();
  if (r > 0) rank.condition = singular[0] / singular[r - 1];
  Eigen::Index nearly = 0;
  while (r + nearly < singular.size() && singular[r + nearly] > kExactlyNull) ++nearly;
  rank.nearly_null = unit.cwiseInverse().asDiagonal() * directions.middleCols(r, nearly) *
                     singular.segment(r, nearly).cwiseInverse().asDiagonal();
  const double rounding =
      std::min(kNullRounding * std::numeric_limits<double>::epsilon() * rank.condition, kAbsent);
  rank.null_space = unit.cwiseInverse().asDiagonal() *
                    directions.rightCols(triangle.cols() - r).unaryExpr([&](double share) {
                      return std::abs(share) > rounding ? share : 0.0;
                    });
  return rank;
}

Eigen::VectorXd parameter_scale(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& scale) {
  const auto or_one = [](double s) { return s > 0.0 ? s : 1.0; };
  if (jacobian.size() == 0) return Eigen::VectorXd::Ones(jacobian.rows());
  const Eigen::MatrixXd rows = jacobian * scale.unaryExpr(or_one).cwiseInverse().asDiagonal();
  const Eigen::MatrixXd inverse = rows.completeOrthogonalDecomposition().pseudoInverse();
  // Of rows that depend on one another, as a height and the distance that follows from it, each has
  // a part of its size there: it has all of it alone.
  const Eigen::VectorXd alone = rows.rowwise().norm().unaryExpr(
      [](double length) { return length > 0.0 ? 1.0 / length : 0.0; });
  return inverse.colwise().norm().transpose().cwiseMax(alone).unaryExpr(or_one);
}

NullDirections null_directions(const Model& model, const Rank& rank,
                               const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& scale) {
  NullDirections null;
  std::vector<int> order;
  for (const ModelTerm& term : model.terms)
    for (const Parameter& parameter : term.effect->parameters()) order.push_back(parameter.gauge);
  null.amplitudes = rank.null_space;
  Eigen::MatrixXd scaled = scale.asDiagonal() * (jacobian * rank.null_space);
  null.own = reduce(scaled, null.amplitudes, order);
  null.identifiable.resize(order.size());
  for (std::size_t p = 0; p < order.size(); ++p)  // what moves with nothing is not known
    null.identifiable[p] = !jacobian.row(static_cast<Eigen::Index>(p)).isZero(0.0);
  if (rank.nearly_null.cols() > 0) {
    const Eigen::VectorXd unseen = (jacobian * rank.nearly_null).rowwise().norm(),
                          seen = (jacobian * rank.basis).rowwise().norm();
    for (std::size_t p = 0; p < order.size(); ++p)
      if (const auto i = static_cast<Eigen::Index>(p); unseen[i] > kUnseen * seen[i])
        null.identifiable[p] = false;
  }
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
  for (Eigen::Index d = 0; d < std::ssize(null.own); ++d) {  // beyond these no parameter moves
    UndeterminedDirection direction;
    std::vector<bool> involved(names.size(), false);
    const double length = null.parameters.col(d).norm();
    for (std::size_t p = 0; p < names.size(); ++p) {
      if (null.parameters(p, d) == 0.0) continue;
      direction.combination.emplace_back(names[p], null.parameters(p, d) / length);
      involved[p] = true;
    }
    direction.advice = advice(model, involved);
    out.push_back(std::move(direction));
  }
  return out;
}

Eigen::MatrixXd determined_rows(const NullDirections& null) {
  const std::set<Eigen::Index> own(null.own.begin(), null.own.end());
  std::vector<Eigen::RowVectorXd> rows;
  for (Eigen::Index p = 0; p < null.parameters.rows(); ++p) {
    const bool is_known = null.identifiable[p] || !null.parameters.row(p).any();  // or nothing is
    if (is_known || own.contains(p)) continue;
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
