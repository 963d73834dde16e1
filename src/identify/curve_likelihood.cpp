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
    out.push_back({{a, length, roughness, data.bow_mm(), data.kinks()}, prior.log_evidence(a * a)});
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
      if (kinked(k, i) > least) {
        out.push_back({out[static_cast<std::size_t>(i)].prior, kinked(k, i)});
        out.back().prior.kinks.push_back({k + 1, data.bow_mm()});
      }
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
                     const std::vector<Noise>& noise, const Estimate& estimate,
                     std::vector<CurveKink> kinks)
    : knots_(*term.effect->knots()),
      bow_mm_(estimate.curve->bow_mm),
      kinks_(std::move(kinks)),
      kink_forms_(slideway::kink_forms(knots_)) {
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
  log_likelihood_ = -0.5 * (target.squaredNorm() + square_beyond(compressed, data.prior_residuals));
  free_forms();
}

void CurveData::free_forms() {
  const Eigen::Index count = 1 + std::ssize(kinks_);
  forms_.forms.resize(information_.rows(), count);
  Eigen::VectorXd heights(count);
  forms_.forms.col(0) = bow_form(knots_);
  heights[0] = bow_mm_;
  for (Eigen::Index i = 1; i < count; ++i) {
    const CurveKink& kink = kinks_[static_cast<std::size_t>(i) - 1];
    forms_.forms.col(i) = kink_forms_.col(kink.knot - 1);
    heights[i] = kink.height_mm;
    log_likelihood_ -= std::log(static_cast<double>(kink_forms_.cols()));
  }
  const Eigen::MatrixXd informed = information_ * forms_.forms;
  const Eigen::VectorXd product = forms_.forms.transpose() * products_;
  // In units of their prior standard deviations: I + what the data say.
  const Eigen::MatrixXd known =
      heights.asDiagonal() * (forms_.forms.transpose() * informed) * heights.asDiagonal();
  const Eigen::LLT<Eigen::MatrixXd> both(Eigen::MatrixXd::Identity(count, count) + known);
  forms_.covariance = heights.asDiagonal() * both.solve(heights.asDiagonal().toDenseMatrix());
  forms_.mean = forms_.covariance * product;
  const Eigen::MatrixXd root = both.matrixL();
  log_likelihood_ += 0.5 * forms_.mean.dot(product) - root.diagonal().array().log().sum();
  for (Eigen::Index i = 0; i < count; ++i)
    if (known(i, i) > 1.0) forms_.determined.push_back(i);
  forms_.moved = informed * forms_.covariance;
  products_ -= informed * forms_.mean;
  information_ -= forms_.moved * informed.transpose();
  informed_kinks_ = information_ * kink_forms_;
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
  const auto has_one_more = [&](const Hypothesis& each) {
    return each.prior.kinks.size() > data.kinks().size();
  };
  std::vector<Hypothesis> out;
  double smooth = -INFINITY, best = -INFINITY;
  for (const std::vector<Hypothesis>& each : found)
    for (const Hypothesis& one : each) {
      best = std::max(best, one.log_likelihood);
      if (!has_one_more(one)) smooth = std::max(smooth, one.log_likelihood);
    }
  for (const std::vector<Hypothesis>& each : found)
    for (const Hypothesis& one : each)
      if (one.log_likelihood > (has_one_more(one) ? best : smooth) + std::log(kLikely))
        out.push_back(one);
  return out;
}

const Hypothesis* likeliest(const std::vector<Hypothesis>& hypotheses) {
  const auto found = std::ranges::max_element(hypotheses, {}, &Hypothesis::log_likelihood);
  return found == hypotheses.end() ? nullptr : &*found;
}

CurvePosterior::CurvePosterior(const CurveData& data, double length_mm, double roughness)
    : known_kinks_(data.kinks().size()), forms_(data.forms()) {
  const Knots& knots = data.knots();
  const Eigen::MatrixXd root = correlation_root(knots, length_mm, roughness);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(root.transpose() * data.information() *
                                                             root);
  information_ = eigen.eigenvalues().cwiseMax(0.0);
  const Eigen::MatrixXd axes = root * eigen.eigenvectors();
  products_ = axes.transpose() * data.products();
  kinks_on_axes_ = axes.transpose() * data.informed_kinks();
  kink_information_ = data.kink_forms().cwiseProduct(data.informed_kinks()).colwise().sum();
  kink_products_ = data.kink_forms().transpose() * data.products();
  axes_ = forms_.beside(axes);
  kinks_ = forms_.beside(data.kink_forms());
}

bool CurvePosterior::has_one_more(const CurvePrior& prior) const {
  return prior.kinks.size() > known_kinks_;
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
  const Eigen::Index k = prior.kinks.back().knot - 1;
  const Eigen::VectorXd own = variances(prior.amplitude_mm);
  const Eigen::VectorXd shared = own.cwiseProduct(kinks_on_axes_.col(k));
  const double information =
      std::max(kink_information_[k] - kinks_on_axes_.col(k).dot(shared), 0.0);
  const double product = kink_products_[k] - shared.dot(products_);
  const double before = std::pow(prior.kinks.back().height_mm, 2);
  const double variance = before / (1.0 + before * information);
  return {variance * product, variance, before * information, kinks_.col(k) - axes_ * shared};
}

Eigen::VectorXd CurvePosterior::mean(const CurvePrior& prior) const {
  Eigen::VectorXd out =
      forms_.forms * forms_.mean + axes_ * variances(prior.amplitude_mm).cwiseProduct(products_);
  if (!has_one_more(prior)) return out;
  const Kink kink = kink_of(prior);
  return out + kink.height * kink.moves;
}

Eigen::MatrixXd CurvePosterior::covariance(const CurvePrior& prior) const {
  Eigen::MatrixXd out = axes_ * variances(prior.amplitude_mm).asDiagonal() * axes_.transpose() +
                        forms_.forms * forms_.covariance * forms_.forms.transpose();
  if (!has_one_more(prior)) return out;
  const Kink kink = kink_of(prior);
  return out + kink.variance * kink.moves * kink.moves.transpose();
}

Eigen::MatrixXd CurvePosterior::determined(const CurvePrior& prior, Eigen::Index most) const {
  const Eigen::Index of_kink = has_one_more(prior) && kink_of(prior).determined > 1.0 ? 1 : 0,
                     of_forms = std::ssize(forms_.determined);
  most -= of_forms + of_kink;
  std::vector<Eigen::Index> which;
  for (Eigen::Index i = information_.size() - 1; i >= 0 && std::ssize(which) < most; --i)
    if (prior.amplitude_mm * prior.amplitude_mm * information_[i] > 1.0) which.push_back(i);
  const Eigen::Index of_axes = std::ssize(which);
  Eigen::MatrixXd out(axes_.rows(), of_axes + of_forms + of_kink);
  out.leftCols(of_axes) = axes_(Eigen::all, which);
  out.middleCols(of_axes, of_forms) = forms_.forms(Eigen::all, forms_.determined);
  if (of_kink > 0) out.rightCols(1) = kinks_.col(prior.kinks.back().knot - 1);
  return out;
}

void CurvePosterior::add_moments(std::span<const Hypothesis> hypotheses,
                                 std::span<const double> weights, const Eigen::VectorXd& centre,
                                 Eigen::MatrixXd& out) const {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(information_.size());
  const Eigen::VectorXd of_forms = forms_.forms * forms_.mean;
  double all = 0.0;
  Eigen::MatrixXd apart(axes_.rows(), 2 * std::ssize(hypotheses));
  for (std::size_t h = 0; h < hypotheses.size(); ++h) {
    const CurvePrior& prior = hypotheses[h].prior;
    const Eigen::VectorXd own = variances(prior.amplitude_mm);
    sum += weights[h] * own;
    all += weights[h];
    auto pair = apart.middleCols(2 * static_cast<Eigen::Index>(h), 2);
    pair.col(0) = of_forms + axes_ * own.cwiseProduct(products_) - centre;
    pair.col(1).setZero();
    if (has_one_more(prior)) {
      const Kink kink = kink_of(prior);
      pair.col(0) += kink.height * kink.moves;
      pair.col(1) = std::sqrt(kink.variance) * kink.moves;
    }
    pair *= std::sqrt(weights[h]);
  }
  out += axes_ * sum.asDiagonal() * axes_.transpose() + apart * apart.transpose() +
         all * forms_.forms * forms_.covariance * forms_.forms.transpose();
}

Eigen::MatrixXd second_moments(const CurveData& data, const std::vector<Hypothesis>& hypotheses,
                               const Eigen::VectorXd& centre) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(centre.size(), centre.size());
  std::vector<double> weights;
  const Hypothesis* const best = likeliest(hypotheses);
  double sum = 0.0;
  for (const Hypothesis& each : hypotheses)
    sum += weights.emplace_back(std::exp(each.log_likelihood - best->log_likelihood));
  for (double& weight : weights) weight /= sum;
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

double CurveHypotheses::Kind::log_likelihood() const {
  const Hypothesis* const best = likeliest(likely);
  return data.log_likelihood() + (best ? std::max(best->log_likelihood, 0.0) : 0.0);
}

double CurveHypotheses::Kind::log_sum() const {
  const Hypothesis* const best = likeliest(likely);
  if (!best) return -INFINITY;
  double sum = 0.0;
  for (const Hypothesis& each : likely) sum += std::exp(each.log_likelihood - best->log_likelihood);
  return data.log_likelihood() + best->log_likelihood + std::log(sum);
}

CurveHypotheses::CurveHypotheses(const Model& model, const Linearisation& linear,
                                 const std::vector<Noise>& noise, const Estimate& estimate,
                                 Kinks kinks)
    : smooth{{*curve_term(model), linear, noise, estimate}, {}} {
  std::vector<CurveKink> all_but_last = estimate.curve->kinks;
  if (kinks == Kinks::allowed && all_but_last.size() > 1) {
    all_but_last.pop_back();
    smooth.likely = likely_priors(smooth.data, Kinks::none);
    kinked = {{*curve_term(model), linear, noise, estimate, std::move(all_but_last)}, {}};
    kinked->likely = likely_priors(kinked->data);
    return;
  }
  smooth.likely = likely_priors(smooth.data, kinks);
  if (kinks == Kinks::none) return;
  const auto first =
      std::stable_partition(smooth.likely.begin(), smooth.likely.end(),
                            [](const Hypothesis& each) { return each.prior.kinks.empty(); });
  kinked = {smooth.data, {first, smooth.likely.end()}};
  smooth.likely.erase(first, smooth.likely.end());
}

double CurveHypotheses::log_likelihood() const {
  return std::max(smooth.log_likelihood(), kinked ? kinked->log_likelihood() : -INFINITY);
}

Eigen::MatrixXd CurveHypotheses::second_moments(const Eigen::VectorXd& centre) const {
  constexpr double kLeastSmooth = 0.5, kLeastKinked = 0.25;
  const auto moments = [&](const Kind& kind) {
    return slideway::second_moments(kind.data, kind.likely, centre);
  };
  if (!kinked || kinked->likely.empty()) return moments(smooth);
  const double odds = std::exp(kinked->log_sum() - smooth.log_sum());
  const double share = std::clamp(1.0 / (1.0 + odds), kLeastSmooth, 1.0 - kLeastKinked);
  return share * moments(smooth) + (1.0 - share) * moments(*kinked);
}

}  // namespace slideway
