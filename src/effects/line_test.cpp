#include "line_test.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "slideway/base/units.hpp"

namespace slideway {
namespace {

constexpr int kNearest = 4, kFarthest = 9;  // of the lines beside one, to either side, cycles
constexpr int kBeside = 2 * (kFarthest - kNearest + 1);
constexpr double kFarthestBeside = 12.0;  // with the width of a line
constexpr double kIndependent = 8.0;      // of them under a Hann window: its noise is 1.5 bins wide
constexpr double kMostReached = 0.01;  // of the square of a line beside, by the line itself folded
constexpr Eigen::Index kTerms = 4;     // of a cubic
constexpr double kOnePhase = 1e-9;     // of a square: half a cycle a sample has cosines alone

/// @param others  orthonormal columns
bool are_apart(const Eigen::MatrixX2d& own, const Eigen::MatrixXd& others, double share) {
  const Eigen::MatrixXd inside = others.transpose() * own;
  for (Eigen::Index j = 0; j < 2; ++j)
    if (!(inside.col(j).squaredNorm() < share * own.col(j).squaredNorm())) return false;
  return true;
}

/// Columns that span what these do. REQUIRES more rows than columns.
Eigen::MatrixXd spanning(const Eigen::MatrixXd& columns) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns);
  return qr.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), columns.cols());
}

/// Phase of one cycle over places.
Eigen::VectorXd turn_over(const Eigen::VectorXd& places) {
  const double first = places.minCoeff(), extent = places.maxCoeff() - first;
  return 2.0 * kPi * (places.array() - first) / extent;
}

/// Of a phase from value to value, in cycles.
Eigen::ArrayXd steps_of(const Eigen::VectorXd& phase) {
  const Eigen::Index steps = phase.size() - 1;
  return (phase.tail(steps) - phase.head(steps)).array() / (2.0 * kPi);
}

Eigen::MatrixX2d wave_of(const Eigen::VectorXd& phase) {
  Eigen::MatrixX2d out(phase.size(), 2);
  out << phase.array().cos(), phase.array().sin();
  return out;
}

/// Of an F distribution of 2 and 2 m degrees of freedom.
double tail_of_ratio(double ratio, double m) { return std::pow(1.0 + ratio / m, -m); }

}  // namespace

LineTest::LineTest(std::span<const double> values, const Eigen::VectorXd& places,
                   const Eigen::VectorXd& radii, const Eigen::VectorXd& weights)
    : turned_(places.size(), kBeside), turn_of_form_(steps_of(turn_over(radii)).abs().mean()) {
  const auto count = static_cast<Eigen::Index>(values.size());
  const Eigen::ArrayXd turn = turn_over(places);
  for (int k = 0; k < kBeside / 2; ++k) {
    turned_.col(2 * k) = ((kNearest + k) * turn).cos();
    turned_.col(2 * k + 1) = ((kNearest + k) * turn).sin();
  }
  const Eigen::ArrayXd at =
      Eigen::ArrayXd::LinSpaced(count, 0.5, static_cast<double>(count) - 0.5) /
      static_cast<double>(count);
  window_ = weights.array() * (0.5 - 0.5 * (2.0 * kPi * at).cos());
  Eigen::MatrixXd powers(count, kTerms);
  powers.col(0) = window_;
  for (Eigen::Index k = 1; k < kTerms; ++k)
    powers.col(k) = powers.col(k - 1).array() * (2.0 * at - 1.0);
  form_ = spanning(powers);
  values_ = weighted(Eigen::Map<const Eigen::VectorXd>(values.data(), count));
}

Eigen::MatrixXd LineTest::weighted(const Eigen::MatrixXd& columns) const {
  Eigen::MatrixXd out = window_.asDiagonal() * columns;
  out.noalias() -= form_ * (form_.transpose() * out).eval();
  return out;
}

Eigen::MatrixX2d LineTest::columns(const Eigen::VectorXd& phase) const {
  return weighted(wave_of(phase));
}

Eigen::MatrixXd LineTest::columns(const std::vector<Eigen::VectorXd>& phases) const {
  Eigen::MatrixXd out(window_.size(), 2 * std::ssize(phases));
  for (Eigen::Index k = 0; k < std::ssize(phases); ++k)
    out.middleCols(2 * k, 2) = columns(phases[static_cast<std::size_t>(k)]);
  return out;
}

double LineTest::gain(const Eigen::MatrixX2d& own) const {
  const Eigen::Matrix2d gram = own.transpose() * own;
  const Eigen::Vector2d products = own.transpose() * values_;
  Eigen::CompleteOrthogonalDecomposition<Eigen::Matrix2d> inverse;
  inverse.setThreshold(kOnePhase);
  return products.dot(inverse.compute(gram).solve(products));
}

LineTest::Beside LineTest::gain_beside(const Eigen::MatrixX2d& wave,
                                       const Eigen::MatrixX2d& own) const {
  const Eigen::MatrixXd line = spanning(own);
  const auto cosine = wave.col(0).array(), sine = wave.col(1).array();
  Beside out;
  for (int k = 0; k < kBeside / 2; ++k)
    for (const double sign : {-1.0, 1.0}) {
      const auto far_cosine = turned_.col(2 * k), far_sine = turned_.col(2 * k + 1);
      Eigen::MatrixX2d other(wave.rows(), 2);
      other << cosine * far_cosine - sign * sine * far_sine,
          sine * far_cosine + sign * cosine * far_sine;
      other = weighted(other);
      if (!are_apart(other, line, kMostReached)) continue;
      out.mean += gain(other);
      out.count += 1.0;
    }
  out.mean /= std::max(out.count, 1.0);
  return out;
}

double LineTest::p_value(const Eigen::VectorXd& phase) const {
  const Eigen::MatrixX2d wave = wave_of(phase), line = weighted(wave);
  const double own = gain(line);
  const Beside beside = gain_beside(wave, line);
  if (beside.count == 0.0) return 1.0;
  if (!(beside.mean > 0.0)) return own > 0.0 ? 0.0 : 1.0;
  return tail_of_ratio(own / beside.mean, kIndependent * beside.count / kBeside);
}

bool LineTest::is_fast(const Eigen::VectorXd& phase) const {
  const Eigen::ArrayXd own = steps_of(phase);
  const double cycles = (own - own.round()).abs().mean();  // a sample, as sampling folds it
  return cycles > kFarthestBeside * turn_of_form_ && 0.5 - cycles > turn_of_form_;
}

bool LineTest::stands_apart(const Eigen::VectorXd& phase,
                            const std::vector<Eigen::VectorXd>& others, double share) const {
  const Eigen::MatrixX2d own = columns(phase);
  if (others.empty()) return own.squaredNorm() > 0.0;
  return are_apart(own, spanning(columns(others)), share);
}

LineTest::Amplitudes LineTest::amplitudes(const std::vector<Eigen::VectorXd>& phases) const {
  const Eigen::MatrixXd all = columns(phases);
  const Eigen::LDLT<Eigen::MatrixXd> gram(all.transpose() * all);
  Amplitudes out{gram.solve(all.transpose() * values_), {}};
  out.uncertainties =
      gram.solve(Eigen::MatrixXd::Identity(all.cols(), all.cols())).diagonal().cwiseSqrt();
  for (Eigen::Index k = 0; k < std::ssize(phases); ++k)  // a gain has two degrees of freedom
    out.uncertainties.segment(2 * k, 2) *= std::sqrt(
        0.5 *
        gain_beside(wave_of(phases[static_cast<std::size_t>(k)]), all.middleCols(2 * k, 2)).mean);
  return out;
}

double p_of_equal_lines(const Eigen::Vector2d& one, const Eigen::Vector2d& of_one,
                        const Eigen::Vector2d& other, const Eigen::Vector2d& of_other) {
  const Eigen::Array2d variances = of_one.array().square() + of_other.array().square();
  return tail_of_ratio(0.5 * ((one - other).array().square() / variances).sum(), kIndependent);
}

}  // namespace slideway
