#include "curve_likelihood.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "slideway/base/parallel.hpp"
#include "slideway/identify/isotropic_prior.hpp"
#include "slideway/identify/linear_algebra.hpp"
#include "slideway/identify/solve.hpp"

namespace slideway {
namespace {

constexpr double kRoughness[] = {1.5, 2.5};
constexpr double kLengthStep = 1.6;      // between lengths of the grid: no estimate moves visibly
constexpr double kAmplitudeStep = 1.12;  // and between amplitudes
constexpr double kLeastInformation = 1e-2, kMostInformation = 1e14;  // of the data over the prior's
constexpr double kLikely = 1e-4;    // of the best hypothesis: less is not looked at
constexpr double kLevelled = 1e-9;  // of a column: what levelling leaves of an offset
constexpr double kJitter = 1e-10;   // of the variance, for a covariance of rounded numbers

double matern(double roughness, double u) {
  const double v = std::sqrt(2.0 * roughness) * u;
  const double falling = std::exp(-v);
  return roughness < 2.0 ? (1.0 + v) * falling : (1.0 + v + v * v / 3.0) * falling;
}

/// Every amplitude of one length and roughness: with the correlation's root L and the coefficients
/// L⁻¹ of the knots, a prior a² I.
std::vector<Hypothesis> along_amplitudes(const CurveData& data, double length, double roughness) {
  const Eigen::MatrixXd root = correlation_root(data.knots(), length, roughness);
  const Eigen::MatrixXd inner = root.transpose() * data.information() * root;
  const double most = inner.trace();
  std::vector<Hypothesis> out;
  if (!(most > 0.0)) return out;
  const IsotropicPrior prior(inner, root.transpose() * data.products());
  const double last = std::sqrt(kMostInformation / most);
  for (double a = std::sqrt(kLeastInformation / most); a < last; a *= kAmplitudeStep)
    out.push_back({{a, length, roughness}, prior.log_evidence(a * a)});
  return out;
}

}  // namespace

Eigen::MatrixXd correlation_root(const Knots& knots, double length, double roughness) {
  const Eigen::Index count = knots.positions_mm.size();
  Eigen::MatrixXd correlation(count, count);
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < count; ++j)
      correlation(i, j) =
          matern(roughness, std::abs(knots.positions_mm[i] - knots.positions_mm[j]) / length);
  correlation.diagonal().array() += kJitter;
  return correlation.llt().matrixL();
}

CurveData::CurveData(const ModelTerm& term, const Linearisation& linear,
                     const std::vector<Noise>& noise, const Estimate& estimate)
    : knots_(*term.effect->knots()) {
  Linearisation data = linear;
  const Eigen::Index declared = linear.prior_rows.rows() - linear.curve_rows;
  data.prior_rows = linear.prior_rows.topRows(declared);
  data.prior_residuals = linear.prior_residuals.head(declared);
  const Compressed compressed = compress(data, noise);
  const Eigen::Index first = term.first_amplitude + knots_.first, own = knots_.positions_mm.size();
  std::vector<Eigen::Index> which;
  for (Eigen::Index j = 0; j < compressed.triangle.cols(); ++j)
    if ((j < first || j >= first + own) &&
        compressed.triangle.col(j).norm() > kLevelled * compressed.scale[j])
      which.push_back(j);
  const Eigen::MatrixXd others = compressed.triangle(Eigen::all, which);
  Eigen::MatrixXd curve = compressed.triangle.middleCols(first, own);
  Eigen::VectorXd target = compressed.target + curve * estimate.amplitudes.segment(first, own);
  carried_ = Eigen::MatrixXd::Zero(compressed.triangle.cols(), own);
  carried_(which, Eigen::all) = -least_squares(others, curve).values;
  carried_.middleRows(first, own).setIdentity();
  const Eigen::MatrixXd basis = orthonormal(others);
  curve -= basis * (basis.transpose() * curve).eval();
  target -= basis * (basis.transpose() * target).eval();
  information_ = curve.transpose() * curve;
  products_ = curve.transpose() * target;
}

std::vector<Hypothesis> likely_priors(const CurveData& data) {
  const Eigen::VectorXd& x = data.knots().positions_mm;
  const double travel = x[x.size() - 1] - x[0];
  std::vector<CurvePrior> shapes;
  for (const double roughness : kRoughness)
    for (double length = 2.0 * (x[1] - x[0]); length < 2.0 * travel * kLengthStep;
         length *= kLengthStep)
      shapes.push_back({0.0, std::min(length, 2.0 * travel), roughness});
  std::vector<std::vector<Hypothesis>> found(shapes.size());
  parallel_for(shapes.size(), [&](std::size_t i) {
    found[i] = along_amplitudes(data, shapes[i].length_mm, shapes[i].roughness);
  });
  std::vector<Hypothesis> out;
  double best = -INFINITY;
  for (const std::vector<Hypothesis>& each : found)
    for (const Hypothesis& one : each) best = std::max(best, one.log_likelihood);
  for (const std::vector<Hypothesis>& each : found)
    for (const Hypothesis& one : each)
      if (one.log_likelihood > best + std::log(kLikely)) out.push_back(one);
  return out;
}

const Hypothesis* likeliest(const std::vector<Hypothesis>& hypotheses) {
  const auto found = std::ranges::max_element(hypotheses, {}, &Hypothesis::log_likelihood);
  return found == hypotheses.end() ? nullptr : &*found;
}

CurvePosterior::CurvePosterior(const CurveData& data, const CurvePrior& prior) {
  const Eigen::MatrixXd root = correlation_root(data.knots(), prior.length_mm, prior.roughness);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(root.transpose() * data.information() *
                                                             root);
  information_ = eigen.eigenvalues().cwiseMax(0.0);
  axes_ = root * eigen.eigenvectors();
  products_ = axes_.transpose() * data.products();
}

Eigen::VectorXd CurvePosterior::variances(double amplitude) const {
  const double variance = amplitude * amplitude;
  return variance / (1.0 + variance * information_.array());
}

Eigen::MatrixXd CurvePosterior::determined(double amplitude) const {
  std::vector<Eigen::Index> which;
  for (Eigen::Index i = 0; i < information_.size(); ++i)
    if (amplitude * amplitude * information_[i] > 1.0) which.push_back(i);
  return axes_(Eigen::all, which);
}

void CurvePosterior::add_moments(std::span<const Hypothesis> hypotheses,
                                 std::span<const double> weights, const Eigen::VectorXd& centre,
                                 Eigen::MatrixXd& out) const {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(information_.size());
  Eigen::MatrixXd apart(axes_.rows(), std::ssize(hypotheses));
  for (std::size_t h = 0; h < hypotheses.size(); ++h) {
    const double amplitude = hypotheses[h].prior.amplitude_mm;
    sum += weights[h] * variances(amplitude);
    apart.col(static_cast<Eigen::Index>(h)) = std::sqrt(weights[h]) * (mean(amplitude) - centre);
  }
  out += axes_ * sum.asDiagonal() * axes_.transpose() + apart * apart.transpose();
}

Eigen::MatrixXd second_moments(const CurveData& data, const std::vector<Hypothesis>& hypotheses,
                               const Eigen::VectorXd& centre) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(centre.size(), centre.size());
  const Hypothesis* const best = likeliest(hypotheses);
  std::vector<double> weights;
  double sum = 0.0;
  for (const Hypothesis& each : hypotheses)
    sum += weights.emplace_back(std::exp(each.log_likelihood - best->log_likelihood));
  for (double& weight : weights) weight /= sum;
  const std::span<const Hypothesis> all = hypotheses;
  for (std::size_t first = 0, next = 0; first < all.size(); first = next) {
    while (next < all.size() && all[next].prior.length_mm == all[first].prior.length_mm &&
           all[next].prior.roughness == all[first].prior.roughness)
      ++next;
    CurvePosterior(data, all[first].prior)
        .add_moments(all.subspan(first, next - first),
                     std::span(weights).subspan(first, next - first), centre, out);
  }
  return out;
}

}  // namespace slideway
