#include "calibration.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "slideway/base/random.hpp"
#include "slideway/base/units.hpp"

namespace slideway {
namespace {

constexpr std::uint64_t kNullSeed = 20120712;
constexpr double kEuler = 0.5772156649015329;

/// Which of the noises the residual allows has this share of their probabilities below it.
std::size_t drawn(const std::vector<Noise::Alternative>& alternatives, double share) {
  std::size_t which = 0;
  while (which + 1 < alternatives.size() && share > alternatives[which].probability)
    share -= alternatives[which++].probability;
  return which;
}

/// White rows of one profile become noise: of the drawn memory, and of a size as well known as it
/// is.
void colour(const Noise& noise, const std::vector<double>& shares, const Eigen::VectorXd& normals,
            Eigen::Ref<Eigen::MatrixXd> rows) {
  if (!noise.is_estimated()) return noise.colour(rows);
  std::vector<std::vector<Eigen::Index>> columns(noise.alternatives.size());
  for (Eigen::Index j = 0; j < rows.cols(); ++j) {
    columns[drawn(noise.alternatives, shares[static_cast<std::size_t>(j)])].push_back(j);
    rows.col(j) *= std::exp(normals[j] / std::sqrt(2.0 * noise.freedom));
  }
  for (std::size_t g = 0; g < columns.size(); ++g) {
    if (columns[g].empty()) continue;
    Eigen::MatrixXd some = rows(Eigen::all, columns[g]);
    noise.factored(noise.alternatives[g].covariance).colour(some);
    rows(Eigen::all, columns[g]) = some;
  }
}

/// Sample L-moments (Hosking 1990, J. R. Stat. Soc. B 52:105).
struct LMoments {
  double mean = 0.0, scale = 0.0, skewness = 0.0;

  explicit LMoments(const std::vector<double>& sorted) {
    const auto n = static_cast<double>(sorted.size());
    double b0 = 0.0, b1 = 0.0, b2 = 0.0;
    for (double i = 0.0; const double value : sorted) {
      b0 += value / n;
      b1 += value * i / (n * (n - 1.0));
      b2 += value * i * (i - 1.0) / (n * (n - 1.0) * (n - 2.0));
      i += 1.0;
    }
    mean = b0;
    scale = 2.0 * b1 - b0;
    skewness = (6.0 * b2 - 6.0 * b1 + b0) / scale;
  }
};

}  // namespace

double Calibration::p_value(double penalised_gain) const {
  const double reduced = (penalised_gain - location) / scale;
  const double beyond = shape == 0.0            ? std::exp(-reduced)
                        : shape * reduced < 1.0 ? std::pow(1.0 - shape * reduced, 1.0 / shape)
                                                : INFINITY;
  return -std::expm1(-beyond);
}

double Calibration::threshold(double significance) const {
  const double beyond = -std::log1p(-significance);
  return location +
         scale * (shape == 0.0 ? -std::log(beyond) : (1.0 - std::pow(beyond, shape)) / shape);
}

Calibration fit_extremes(std::vector<double> gains) {
  // Hosking, Wallis and Wood (1985), Technometrics 27:251, Eqs. (14) to (16) and the test of k = 0.
  constexpr double kVariance = 0.5633;  // of the estimate of k under Gumbel, times n
  constexpr double kRefuted = -1.645;   // one-sided, 5 %
  constexpr double kLeastScale = 1e-6;
  std::ranges::sort(gains);
  const auto n = static_cast<double>(gains.size());
  const LMoments moments(gains);
  const double c = 2.0 / (3.0 + moments.skewness) - std::log(2.0) / std::log(3.0);
  const double k = c * (7.8590 + 2.9554 * c);
  Calibration out;
  if (k * std::sqrt(n / kVariance) < kRefuted) {
    const double gamma = std::tgamma(1.0 + k);
    out.shape = k;
    out.scale = std::max(moments.scale * k / (gamma * (1.0 - std::exp2(-k))), kLeastScale);
    out.location = moments.mean - out.scale * (1.0 - gamma) / k;
    return out;
  }
  double squares = 0.0;
  for (const double gain : gains) squares += (gain - moments.mean) * (gain - moments.mean);
  out.scale = std::max(std::sqrt(6.0 * squares / (n - 1.0)) / kPi, kLeastScale);
  out.location = moments.mean - kEuler * out.scale;
  return out;
}

namespace {

/// Of unit variance, each profile's its own. #errors by #draws
Eigen::MatrixXd known_errors(std::size_t profile, Eigen::Index errors, Eigen::Index draws) {
  Eigen::MatrixXd out(errors, draws);
  for (Eigen::Index j = 0; j < draws; ++j) {
    RandomStream random(kNullSeed + static_cast<std::uint64_t>(j),
                        "known " + std::to_string(profile));
    for (double& value : out.col(j)) value = random.normal();
  }
  return out;
}

}  // namespace

Eigen::MatrixXd null_residuals(const Whitened& data, const Gates& gates) {
  const auto count = static_cast<Eigen::Index>(gates.resamples);
  Eigen::MatrixXd out(data.rows(), count);
  Eigen::MatrixXd normals(count, static_cast<Eigen::Index>(data.observations()));
  std::vector<double> shares;  // one for all profiles: they share their memory
  for (Eigen::Index j = 0; j < count; ++j) {
    RandomStream random(kNullSeed + static_cast<std::uint64_t>(j), "null");
    for (double& value : out.col(j)) value = random.normal();
    for (double& value : normals.row(j)) value = random.normal();
    shares.push_back(random.uniform());
  }
  for (std::size_t i = 0; i < data.observations(); ++i) {
    auto rows = out.middleRows(data.first_row(i), data.count(i));
    colour(data.noise()[i], shares, normals.col(static_cast<Eigen::Index>(i)), rows);
    const Eigen::MatrixXd known = data.total_noise()[i].known();
    const Eigen::Index more =
        known.cols() - (data.noise()[i].is_estimated() ? 0 : data.noise()[i].known().cols());
    if (more > 0) rows += known.rightCols(more) * known_errors(i, more, count);
  }
  return data.outside(std::move(out));
}

double probability_of_others(const std::vector<Noise>& noise) {
  double out = 0.0;
  for (const Noise& each : noise)
    if (each.is_estimated())
      out = std::max(out,
                     1.0 - std::ranges::max(each.alternatives, {}, &Noise::Alternative::probability)
                               .probability);
  return out;
}

Calibration calibrate(const Whitened& data, const Candidates& candidates, const Gates& gates,
                      const std::function<void(double)>& progress) {
  const Eigen::VectorXd gains =
      largest_gains(data, candidates, null_residuals(data, gates).cast<float>(), progress);
  Calibration out = fit_extremes({gains.begin(), gains.end()});
  out.of_others = probability_of_others(data.noise());
  return out;
}

}  // namespace slideway
