#include "slideway/identify/curve_prior.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "curve_likelihood.hpp"
#include "slideway/base/units.hpp"
#include "slideway/identify/fit.hpp"

namespace slideway {

namespace {

constexpr Eigen::Index kValuesPerDirection = 3;  // of a curve: fewer leave too little for a noise
constexpr double kValuesPerKnot = 2.0;           // fewer do not tell a curve from noise
constexpr int kHalvings = 6;                     // of the noise, to either side
constexpr double kRuledOut = 9.0;                // difference in log likelihood: 1e-4
constexpr double kAsLikely = 1.0;                // difference in log likelihood
constexpr std::size_t kMostKinks = 6;            // more are a rough way, not kinks

bool is_declared(const Observation* observation) {
  return observation->profile->standard_uncertainty.has_value();
}

/// A size of the noise, with what the data do not rule out of the curve beside it.
struct NoiseSize {
  double factor = 1.0;  // of its variances
  CurveHypotheses likely;
  double log_likelihood = 0.0;  // with the likeliest of them
};

/// Whether a curve with a form of its own at each knot could be what was taken for noise, and no
/// uncertainty is declared.
bool is_open(const CurveData& data, const Linearisation& linear) {
  return static_cast<double>(data.freedom()) <
             kValuesPerKnot * static_cast<double>(data.knots().positions_mm.size()) &&
         std::ranges::none_of(linear.observations, is_declared);
}

/// The noise from 2^kHalvings to 2^-kHalvings of what it is.
std::vector<NoiseSize> sizes_of(const Model& model, const Linearisation& linear,
                                const std::vector<Noise>& noise, const Estimate& estimate,
                                Kinks kinks) {
  std::vector<NoiseSize> out;
  for (int halvings = -kHalvings; halvings <= kHalvings; ++halvings) {
    const double factor = std::pow(4.0, -halvings);
    std::vector<Noise> scaled;
    for (const Noise& each : noise) scaled.push_back(each.scaled(factor));
    CurveHypotheses likely(model, linear, scaled, estimate, kinks);
    const double log_likelihood =
        likely.log_likelihood() -
        0.5 * static_cast<double>(likely.smooth.data.freedom()) * std::log(factor);
    out.push_back({factor, std::move(likely), log_likelihood});
  }
  return out;
}

/// The likeliest of more than so many kinks, or null.
const Hypothesis* likeliest_kink(const std::vector<Hypothesis>& hypotheses, std::size_t kinks) {
  const Hypothesis* out = nullptr;
  for (const Hypothesis& each : hypotheses)
    if (each.prior.kinks.size() > kinks && (!out || each.log_likelihood > out->log_likelihood))
      out = &each;
  return out;
}

double largest_likelihood(const std::vector<NoiseSize>& sizes) {
  return std::ranges::max_element(sizes, {}, &NoiseSize::log_likelihood)->log_likelihood;
}

}  // namespace

const ModelTerm* curve_term(const Model& model) {
  const auto found = std::ranges::find_if(
      model.terms, [](const ModelTerm& term) { return term.effect->knots().has_value(); });
  return found == model.terms.end() ? nullptr : &*found;
}

CurvePrior first_curve_prior(const Model& model, const Knots& knots) {
  const double travel = knots.positions_mm[knots.positions_mm.size() - 1] - knots.positions_mm[0];
  double largest = 0.0;
  for (const Observation* observation : fitted_observations(model)) {
    const double size = levelled(*observation, observation->values).norm() /
                        std::sqrt(static_cast<double>(observation->low_band.samples()));
    const bool slope = observation->profile->setup.quantity == Quantity::slope;
    largest = std::max(largest, slope ? size * travel : size);
  }
  const double height = largest > 0.0 ? largest : kMicrometre;
  return {height, travel / 4.0, 1.5, height};
}

namespace {

/// Rows R with RᵀR the inverse of a covariance C become those of C + (a form of this height) ⊗
/// itself.
void add_form(double height, const Eigen::VectorXd& form, Eigen::MatrixXd& rows) {
  const Eigen::VectorXd white = height * (rows * form);
  const double size = white.squaredNorm();
  if (!(size > 0.0)) return;
  rows.noalias() -=
      (1.0 - 1.0 / std::sqrt(1.0 + size)) / size * white * (white.transpose() * rows).eval();
}

}  // namespace

Eigen::MatrixXd curve_prior_rows(const Knots& knots, const CurvePrior& prior) {
  const Eigen::MatrixXd root =
      prior.amplitude_mm * correlation_root(knots, prior.length_mm, prior.roughness);
  Eigen::MatrixXd rows = root.triangularView<Eigen::Lower>().solve(
      Eigen::MatrixXd::Identity(root.rows(), root.cols()));
  add_form(prior.bow_mm, bow_form(knots), rows);
  const Eigen::MatrixXd kinks = prior.kinks.empty() ? Eigen::MatrixXd() : kink_forms(knots);
  for (const CurveKink& kink : prior.kinks)
    add_form(kink.height_mm, kinks.col(kink.knot - 1), rows);
  return rows;
}

CurveEstimate estimate_curve(const Model& model, const Linearisation& linear,
                             const std::vector<Noise>& noise, const Estimate& estimate) {
  Eigen::Index values = 0, known = 0;  // known: of a declared noise
  for (const Observation* observation : linear.observations)
    (is_declared(observation) ? known : values) +=
        observation->values.size() - observation->nuisances.cols();
  CurveEstimate out{*estimate.curve, {}};
  double most = -INFINITY;
  std::vector<CurveKink> kinks;
  for (std::size_t in_vain = 0; in_vain < 2;) {  // one of two kinks may explain nothing by itself
    const CurveData data(*curve_term(model), linear, noise, estimate, kinks);
    const std::vector<Hypothesis> likely = likely_priors(data);
    const Hypothesis* const best = likeliest(likely);
    const double log_likelihood = data.log_likelihood() + (best ? best->log_likelihood : 0.0);
    ++in_vain;
    if (log_likelihood > most || kinks.empty()) {  // whatever it is
      most = log_likelihood;
      if (best) out.prior = best->prior;
      out.determined = CurvePosterior(data, out.prior.length_mm, out.prior.roughness)
                           .determined(out.prior, known + values / kValuesPerDirection);
      in_vain = 0;
    }
    const Hypothesis* const next = likeliest_kink(likely, kinks.size());
    if (!next || next->prior.kinks.size() > kMostKinks) break;
    kinks = next->prior.kinks;
  }
  return out;
}

double noise_beside_curve(const Model& model, const Linearisation& linear,
                          const std::vector<Noise>& noise, const Estimate& estimate) {
  if (!is_open({*curve_term(model), linear, noise, estimate}, linear)) return 1.0;
  const std::vector<NoiseSize> sizes = sizes_of(model, linear, noise, estimate, Kinks::none);
  const double least = largest_likelihood(sizes) - kAsLikely;
  const auto size = std::ranges::find_if(
      sizes, [&](const NoiseSize& each) { return each.log_likelihood >= least; });
  return size == sizes.end() ? 1.0 : size->factor;  // of numbers that are none
}

std::optional<Eigen::VectorXd> curve_beside_least_noise(const Model& model,
                                                        const Linearisation& linear,
                                                        const std::vector<Noise>& noise,
                                                        const Estimate& estimate) {
  if (!is_open({*curve_term(model), linear, noise, estimate}, linear)) return std::nullopt;
  const std::vector<NoiseSize> sizes = sizes_of(model, linear, noise, estimate, Kinks::none);
  const double least = largest_likelihood(sizes) - kRuledOut;
  const auto size = std::find_if(sizes.rbegin(), sizes.rend(), [&](const NoiseSize& each) {
    return each.log_likelihood >= least;
  });
  const Hypothesis* const best =
      size == sizes.rend() ? nullptr : likeliest(size->likely.smooth.likely);
  if (!best) return std::nullopt;
  return CurvePosterior(size->likely.smooth.data, best->prior.length_mm, best->prior.roughness)
      .mean(best->prior);
}

Eigen::MatrixXd covariance_of_curve_prior(const Model& model, const Linearisation& linear,
                                          const std::vector<Noise>& noise,
                                          const Estimate& estimate) {
  std::vector<NoiseSize> sizes;
  if (is_open({*curve_term(model), linear, noise, estimate}, linear))
    sizes = sizes_of(model, linear, noise, estimate, Kinks::allowed);
  else
    sizes.push_back({1.0, {model, linear, noise, estimate, Kinks::allowed}, 0.0});
  const CurveHypotheses& as_it_is = std::ranges::find(sizes, 1.0, &NoiseSize::factor)->likely;
  const CurvePrior& prior = *estimate.curve;
  const CurveData& data = prior.kinks.empty() ? as_it_is.smooth.data : as_it_is.kinked->data;
  const CurvePosterior own(data, prior.length_mm, prior.roughness);
  const Eigen::VectorXd centre = own.mean(prior);
  Eigen::MatrixXd moments = Eigen::MatrixXd::Zero(centre.size(), centre.size());
  const double most = largest_likelihood(sizes);
  double sum = 0.0;
  for (const NoiseSize& size : sizes) {
    if (size.likely.smooth.likely.empty()) continue;
    const double weight = std::exp(size.log_likelihood - most);
    sum += weight;
    moments += weight * size.likely.second_moments(centre);
  }
  if (!(sum > 0.0)) return Eigen::MatrixXd::Zero(data.carried().rows(), data.carried().rows());
  moments = moments / sum - own.covariance(prior);
  return data.carried() * moments * data.carried().transpose();
}

Linearisation beside_curve(const Model& model, const Linearisation& linear,
                           const CurveEstimate& curve, const Estimate& estimate) {
  const ModelTerm& term = *curve_term(model);
  const Eigen::Index first = term.first_amplitude + term.effect->knots()->first;
  const Eigen::Index own = curve.determined.rows(), free = curve.determined.cols();
  Linearisation out = linear;
  const auto replaced = [&](const Eigen::MatrixXd& columns) {
    const Eigen::Index behind = columns.cols() - first - own;
    Eigen::MatrixXd all(columns.rows(), columns.cols() - own + free);
    all << columns.leftCols(first), columns.middleCols(first, own) * curve.determined,
        columns.rightCols(behind);
    return all;
  };
  for (std::size_t i = 0; i < out.columns.size(); ++i) {
    out.residuals[i] +=
        linear.columns[i].middleCols(first, own) * estimate.amplitudes.segment(first, own);
    out.columns[i] = replaced(linear.columns[i]);
  }
  const Eigen::Index declared = linear.prior_rows.rows() - linear.curve_rows;
  out.prior_rows = replaced(linear.prior_rows.topRows(declared));
  out.prior_residuals = linear.prior_residuals.head(declared);
  out.curve_rows = 0;
  return out;
}

}  // namespace slideway
