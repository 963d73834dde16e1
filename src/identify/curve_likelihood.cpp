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
constexpr double kLikely = 1e-4;    // of the best hypothesis of its kind: less is not looked at
constexpr double kLevelled = 1e-9;  // of a column: what levelling leaves of an offset
constexpr double kJitter = 1e-10;   // of the variance, for a covariance of rounded numbers

double matern(double roughness, double u) {
  const double v = std::sqrt(2.0 * roughness) * u;
  const double falling = std::exp(-v);
  return roughness < 2.0 ? (1.0 + v) * falling : (1.0 + v + v * v / 3.0) * falling;
}

/// Every amplitude of one length and roughness: with the correlation's root L and the coefficients
/// L⁻¹ of the knots, a prior a² I. Beside each, a kink at every knot, all of them as likely as
/// none.
std::vector<Hypothesis> along_amplitudes(const CurveData& data, double length, double roughness,
                                         Kinks kinks) {
  const Eigen::MatrixXd root = correlation_root(data.knots(), length, roughness);
  const Eigen::MatrixXd inner = root.transpose() * data.information() * root;
  const double most = inner.trace();
  std::vector<Hypothesis> out;
  if (!(most > 0.0)) return out;
  const IsotropicPrior prior(inner, root.transpose() * data.products());
  const double last = std::sqrt(kMostInformation / most);
  for (double a = std::sqrt(kLeastInformation / most); a < last; a *= kAmplitudeStep)
    out.push_back({{a, length, roughness, data.bow_mm()}, prior.log_evidence(a * a)});
  if (!(data.bow_mm() > 0.0) || kinks == Kinks::none) return out;
  const Eigen::Index smooth = std::ssize(out);
  Eigen::RowVectorXd amplitudes(smooth), without(smooth);
  for (Eigen::Index i = 0; i < smooth; ++i) {
    amplitudes[i] = out[static_cast<std::size_t>(i)].prior.amplitude_mm;
    without[i] = out[static_cast<std::size_t>(i)].log_likelihood;
  }
  Eigen::MatrixXd kinked =
      CurvePosterior(data, length, roughness).log_evidence_of_kinks(amplitudes, data.bow_mm());
  if (kinked.size() == 0) return out;
  kinked.rowwise() += without;
  kinked.array() -= std::log(static_cast<double>(kinked.rows()));
  const double least = std::max(kinked.maxCoeff(), without.maxCoeff()) + std::log(kLikely);
  for (Eigen::Index i = 0; i < smooth; ++i)
    for (Eigen::Index k = 0; k < kinked.rows(); ++k)
      if (kinked(k, i) > least)
        out.push_back(
            {{amplitudes[i], length, roughness, data.bow_mm(), CurveKink{k + 1, data.bow_mm()}},
             kinked(k, i)});
  return out;
}

/// Square of what no change of (amplitudes, shapes) reaches.
double square_beyond(const Compressed& compressed, const Eigen::VectorXd& prior_residuals) {
  double whole = prior_residuals.squaredNorm();
  for (const ProfileTriangle& profile : compressed.profiles)
    whole += profile.free().rightCols<1>().squaredNorm();
  return std::max(whole - compressed.target.squaredNorm(), 0.0);
}

/// Coefficients of the spline through heights at even knots, side by side.
Eigen::MatrixXd spline_through(const Eigen::MatrixXd& heights) {
  const Eigen::Index count = heights.rows();
  Eigen::MatrixXd spline = Eigen::MatrixXd::Identity(count, count);
  for (Eigen::Index i = 1; i + 1 < count; ++i)
    spline.row(i).segment(i - 1, 3) << 1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0;
  return spline.lu().solve(heights);
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
    : knots_(*term.effect->knots()), bow_mm_(estimate.curve->bow_mm) {
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
  project_out(basis, curve);
  project_out(basis, target);
  information_ = curve.transpose() * curve;
  products_ = curve.transpose() * target;
  freedom_ = -basis.cols();
  for (const Observation* each : linear.observations)
    freedom_ += each->values.size() - each->nuisances.cols();
  bow_.form = bow_form(knots_);
  const Eigen::VectorXd informed = information_ * bow_.form;
  const double of_data = informed.dot(bow_.form), of_prior = 1.0 / (bow_mm_ * bow_mm_);
  bow_.variance = 1.0 / (of_data + of_prior);
  bow_.mean = bow_.variance * products_.dot(bow_.form);
  log_likelihood_ =
      0.5 * (bow_.mean * products_.dot(bow_.form) - std::log1p(of_data * bow_mm_ * bow_mm_) -
             target.squaredNorm() - square_beyond(compressed, data.prior_residuals));
  bow_.moved = bow_.variance * informed;
  bow_.determined = of_data > of_prior;
  products_ -= bow_.mean * informed;
  information_ -= bow_.moved * informed.transpose();
  kinks_ = kink_forms(knots_);
  informed_kinks_ = information_ * kinks_;
}

Eigen::MatrixXd kink_forms(const Knots& knots) {
  const Eigen::ArrayXd x = knots.positions_mm.array();
  const Eigen::Index count = x.size();
  const double first = x[0], last = x[count - 1];
  Eigen::MatrixXd heights(count, std::max<Eigen::Index>(count - 2, 0));
  for (Eigen::Index k = 0; k < heights.cols(); ++k)
    heights.col(k) =
        ((x - first) / (x[k + 1] - first)).min((last - x) / (last - x[k + 1])).matrix();
  return spline_through(heights);
}

Eigen::VectorXd bow_form(const Knots& knots) {
  const Eigen::ArrayXd x = knots.positions_mm.array();
  const double first = x[0], last = x[x.size() - 1], half = 0.5 * (last - first);
  return spline_through(((x - first) * (last - x) / (half * half)).matrix());
}

std::vector<Hypothesis> likely_priors(const CurveData& data, Kinks kinks) {
  const Eigen::VectorXd& x = data.knots().positions_mm;
  const double travel = x[x.size() - 1] - x[0];
  std::vector<CurvePrior> shapes;
  for (const double roughness : kRoughness)
    for (double length = 2.0 * (x[1] - x[0]); length < 2.0 * travel * kLengthStep;
         length *= kLengthStep)
      shapes.push_back({0.0, std::min(length, 2.0 * travel), roughness});
  std::vector<std::vector<Hypothesis>> found(shapes.size());
  parallel_for(shapes.size(), [&](std::size_t i) {
    found[i] = along_amplitudes(data, shapes[i].length_mm, shapes[i].roughness, kinks);
  });
  std::vector<Hypothesis> out;
  double smooth = -INFINITY, best = -INFINITY;
  for (const std::vector<Hypothesis>& each : found)
    for (const Hypothesis& one : each) {
      best = std::max(best, one.log_likelihood);
      if (!one.prior.kink) smooth = std::max(smooth, one.log_likelihood);
    }
  for (const std::vector<Hypothesis>& each : found)
    for (const Hypothesis& one : each)
      if (one.log_likelihood > (one.prior.kink ? best : smooth) + std::log(kLikely))
        out.push_back(one);
  return out;
}

const Hypothesis* likeliest(const std::vector<Hypothesis>& hypotheses) {
  const auto found = std::ranges::max_element(hypotheses, {}, &Hypothesis::log_likelihood);
  return found == hypotheses.end() ? nullptr : &*found;
}

CurvePosterior::CurvePosterior(const CurveData& data, double length_mm, double roughness) {
  const Knots& knots = data.knots();
  const Eigen::MatrixXd root = correlation_root(knots, length_mm, roughness);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(root.transpose() * data.information() *
                                                             root);
  information_ = eigen.eigenvalues().cwiseMax(0.0);
  const Eigen::MatrixXd axes = root * eigen.eigenvectors();
  products_ = axes.transpose() * data.products();
  kinks_on_axes_ = axes.transpose() * data.informed_kinks();
  kink_information_ = data.kinks().cwiseProduct(data.informed_kinks()).colwise().sum();
  kink_products_ = data.kinks().transpose() * data.products();
  bow_ = data.bow();
  axes_ = bow_.beside(axes);
  kinks_ = bow_.beside(data.kinks());
}

Eigen::VectorXd CurvePosterior::variances(double amplitude) const {
  const double variance = amplitude * amplitude;
  return variance / (1.0 + variance * information_.array());
}

Eigen::MatrixXd CurvePosterior::log_evidence_of_kinks(const Eigen::RowVectorXd& amplitudes_mm,
                                                      double kink_mm) const {
  Eigen::MatrixXd own(information_.size(), amplitudes_mm.size());
  for (Eigen::Index i = 0; i < own.cols(); ++i) own.col(i) = variances(amplitudes_mm[i]);
  Eigen::MatrixXd information = -(kinks_on_axes_.cwiseAbs2().transpose() * own);
  information.colwise() += kink_information_;
  Eigen::MatrixXd products = -(kinks_on_axes_.transpose() * products_.asDiagonal() * own);
  products.colwise() += kink_products_;
  const double variance = kink_mm * kink_mm;
  const Eigen::ArrayXXd wider = 1.0 + variance * information.array().max(0.0);
  return 0.5 * (variance * products.array().square() / wider - wider.log());
}

CurvePosterior::Kink CurvePosterior::kink_of(const CurvePrior& prior) const {
  const Eigen::Index k = prior.kink->knot - 1;
  const Eigen::VectorXd own = variances(prior.amplitude_mm);
  const Eigen::VectorXd shared = own.cwiseProduct(kinks_on_axes_.col(k));
  const double information =
      std::max(kink_information_[k] - kinks_on_axes_.col(k).dot(shared), 0.0);
  const double product = kink_products_[k] - shared.dot(products_);
  const double before = prior.kink->height_mm * prior.kink->height_mm;
  const double variance = before / (1.0 + before * information);
  return {variance * product, variance, before * information, kinks_.col(k) - axes_ * shared};
}

Eigen::VectorXd CurvePosterior::mean(const CurvePrior& prior) const {
  Eigen::VectorXd out =
      bow_.mean * bow_.form + axes_ * variances(prior.amplitude_mm).cwiseProduct(products_);
  if (!prior.kink) return out;
  const Kink kink = kink_of(prior);
  return out + kink.height * kink.moves;
}

Eigen::MatrixXd CurvePosterior::covariance(const CurvePrior& prior) const {
  Eigen::MatrixXd out = axes_ * variances(prior.amplitude_mm).asDiagonal() * axes_.transpose() +
                        bow_.variance * bow_.form * bow_.form.transpose();
  if (!prior.kink) return out;
  const Kink kink = kink_of(prior);
  return out + kink.variance * kink.moves * kink.moves.transpose();
}

Eigen::MatrixXd CurvePosterior::determined(const CurvePrior& prior, Eigen::Index most) const {
  const bool has_kink = prior.kink && kink_of(prior).determined > 1.0;
  most -= (bow_.determined ? 1 : 0) + (has_kink ? 1 : 0);
  std::vector<Eigen::Index> which;
  for (Eigen::Index i = information_.size() - 1; i >= 0 && std::ssize(which) < most; --i)
    if (prior.amplitude_mm * prior.amplitude_mm * information_[i] > 1.0) which.push_back(i);
  const Eigen::Index of_axes = std::ssize(which), of_bow = bow_.determined ? 1 : 0;
  Eigen::MatrixXd out(axes_.rows(), of_axes + of_bow + (has_kink ? 1 : 0));
  out.leftCols(of_axes) = axes_(Eigen::all, which);
  if (bow_.determined) out.col(of_axes) = bow_.form;
  if (has_kink) out.rightCols(1) = kinks_.col(prior.kink->knot - 1);
  return out;
}

void CurvePosterior::add_moments(std::span<const Hypothesis> hypotheses,
                                 std::span<const double> weights, const Eigen::VectorXd& centre,
                                 Eigen::MatrixXd& out) const {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(information_.size());
  const Eigen::VectorXd bow = bow_.mean * bow_.form;
  double all = 0.0;
  Eigen::MatrixXd apart(axes_.rows(), 2 * std::ssize(hypotheses));
  for (std::size_t h = 0; h < hypotheses.size(); ++h) {
    const CurvePrior& prior = hypotheses[h].prior;
    const Eigen::VectorXd own = variances(prior.amplitude_mm);
    sum += weights[h] * own;
    all += weights[h];
    auto pair = apart.middleCols(2 * static_cast<Eigen::Index>(h), 2);
    pair.col(0) = bow + axes_ * own.cwiseProduct(products_) - centre;
    pair.col(1).setZero();
    if (prior.kink) {
      const Kink kink = kink_of(prior);
      pair.col(0) += kink.height * kink.moves;
      pair.col(1) = std::sqrt(kink.variance) * kink.moves;
    }
    pair *= std::sqrt(weights[h]);
  }
  out += axes_ * sum.asDiagonal() * axes_.transpose() + apart * apart.transpose() +
         all * bow_.variance * bow_.form * bow_.form.transpose();
}

namespace {

/// By likelihood; but curves without a kink keep half of all at least: that one kink explains more
/// does not make it the only form that is there.
std::vector<double> weights_of(const std::vector<Hypothesis>& hypotheses) {
  constexpr double kLeastSmooth = 0.5;
  struct Kind {
    double best = -INFINITY, sum = 0.0;
    [[nodiscard]] double log_sum() const { return best + std::log(sum); }
  } smooth, kinked;
  const auto kind_of = [&](const Hypothesis& each) -> Kind& {
    return each.prior.kink ? kinked : smooth;
  };
  for (const Hypothesis& each : hypotheses)
    kind_of(each).best = std::max(kind_of(each).best, each.log_likelihood);
  std::vector<double> out;
  for (const Hypothesis& each : hypotheses)
    kind_of(each).sum += out.emplace_back(std::exp(each.log_likelihood - kind_of(each).best));
  const double odds = kinked.sum > 0.0 ? std::exp(kinked.log_sum() - smooth.log_sum()) : 0.0;
  const double share = std::max(1.0 / (1.0 + odds), kLeastSmooth);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] *= (hypotheses[i].prior.kink ? 1.0 - share : share) / kind_of(hypotheses[i]).sum;
  return out;
}

}  // namespace

Eigen::MatrixXd second_moments(const CurveData& data, const std::vector<Hypothesis>& hypotheses,
                               const Eigen::VectorXd& centre) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(centre.size(), centre.size());
  const std::vector<double> weights = weights_of(hypotheses);
  const std::span<const Hypothesis> all = hypotheses;
  for (std::size_t first = 0, next = 0; first < all.size(); first = next) {
    while (next < all.size() && all[next].prior.length_mm == all[first].prior.length_mm &&
           all[next].prior.roughness == all[first].prior.roughness)
      ++next;
    CurvePosterior(data, all[first].prior.length_mm, all[first].prior.roughness)
        .add_moments(all.subspan(first, next - first),
                     std::span(weights).subspan(first, next - first), centre, out);
  }
  return out;
}

}  // namespace slideway
