#include "slideway/identify/noise.hpp"

#include <ceres/first_order_function.h>
#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>

#include <Eigen/Cholesky>
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>

#include "restricted_likelihood.hpp"

namespace slideway {
namespace {

using Cost = std::function<double(const Eigen::VectorXd&)>;

/// Largest Σ atanh π on n values, where the correlation length, Π (1 + π) / (1 - π) values, is that
/// of so many traces: beyond it an offset and the noise are one.
double most_correlated(Eigen::Index n, const Gates& gates) {
  return 0.5 * std::log(gates.correlation_traces * static_cast<double>(n));
}

/// Noise parameters within their limits. An excess of Σ atanh π comes off the first.
Eigen::VectorXd limited(Eigen::VectorXd parameters, double most_correlated) {
  auto partial = parameters.head(parameters.size() - 1);
  partial = partial.cwiseMin(kLargestAtanh).cwiseMax(-kLargestAtanh);
  if (partial.size() > 0) partial[0] -= std::max(partial.sum() - most_correlated, 0.0);
  return parameters;
}

constexpr double kStep = 1e-3;  // of differences by atanh π and ln σ: both of order one

/// Central-difference gradient.
Eigen::VectorXd gradient_of(const Cost& f, const Eigen::VectorXd& x) {
  Eigen::VectorXd gradient(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(x.size(), i);
    gradient[i] = (f(x + step) - f(x - step)) / (2.0 * kStep);
  }
  return gradient;
}

/// Central differences of the gradient.
Eigen::MatrixXd hessian_of(const Cost& f, const Eigen::VectorXd& x) {
  Eigen::MatrixXd hessian(x.size(), x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(x.size(), i);
    hessian.col(i) = (gradient_of(f, x + step) - gradient_of(f, x - step)) / (2.0 * kStep);
  }
  return 0.5 * (hessian + hessian.transpose());
}

constexpr double kImpossible = 1e30;  // -2 ln likelihood where it cannot be evaluated

/// -2 ln likelihood as Ceres takes it.
class Likelihood final : public ceres::FirstOrderFunction {
 public:
  Likelihood(const Cost& cost, Eigen::Index size) : cost_(cost), size_(size) {}

  bool Evaluate(const double* const parameters, double* cost, double* gradient) const override {
    const Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(parameters, size_);
    *cost = cost_(x);
    const bool possible = std::isfinite(*cost);
    if (!possible) *cost = kImpossible;  // the line search aborts the process on a value not valid
    if (!gradient) return true;
    Eigen::Map<Eigen::VectorXd> slope(gradient, size_);
    slope.setZero();
    if (possible) slope = gradient_of(cost_, x);
    if (!slope.allFinite()) slope.setZero();
    return true;
  }
  [[nodiscard]] int NumParameters() const override { return static_cast<int>(size_); }

 private:
  const Cost& cost_;
  Eigen::Index size_;
};

/// Minimises by BFGS.
Eigen::VectorXd minimise(const Cost& f, Eigen::VectorXd x) {
  const ceres::GradientProblem problem(new Likelihood(f, x.size()));
  ceres::GradientProblemSolver::Options options;
  options.line_search_direction_type = ceres::BFGS;
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = 50;
  options.function_tolerance = 1e-9;  // of -2 ln likelihood: no estimate moves visibly
  ceres::GradientProblemSolver::Summary summary;
  ceres::Solve(options, problem, x.data(), &summary);
  return x;
}

/// Directions in which noise parameters can move without crossing a limit they stand at.
Eigen::MatrixXd free_directions(const Eigen::VectorXd& parameters, double most_correlated) {
  constexpr double kAtLimit = 1e-9;
  const Eigen::Index last = parameters.size() - 1;
  const auto partial = parameters.head(last);
  const bool whole_trace = last > 0 && partial.sum() > most_correlated - kAtLimit;
  Eigen::MatrixXd directions = Eigen::MatrixXd::Zero(last + 1, last + 1);
  for (Eigen::Index j = whole_trace ? 1 : 0; j < last; ++j) {
    if (std::abs(partial[j]) > kLargestAtanh - kAtLimit) continue;
    directions(j, j) = 1.0;
    if (whole_trace) directions(0, j) = -1.0;
  }
  directions(last, last) = 1.0;
  const Eigen::Index free = (directions.diagonal().array() > 0.0).count();
  Eigen::MatrixXd out(last + 1, free);
  for (Eigen::Index j = 0, next = 0; j <= last; ++j)
    if (directions(j, j) > 0.0) out.col(next++) = directions.col(j);
  return out;
}

/// Covariance of noise parameters at the minimum of f = -2 ln likelihood; none across a limit.
Eigen::MatrixXd covariance(const Cost& f, const Eigen::VectorXd& parameters,
                           double most_correlated) {
  constexpr double kLeastInformation = 0.5;  // of atanh π where the data say nothing
  const Eigen::MatrixXd directions = free_directions(parameters, most_correlated);
  const Cost along = [&](const Eigen::VectorXd& y) { return f(parameters + directions * y); };
  const Eigen::MatrixXd hessian = hessian_of(along, Eigen::VectorXd::Zero(directions.cols()));
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(0.5 * hessian);
  const Eigen::MatrixXd axes = directions * eigen.eigenvectors();
  return axes * eigen.eigenvalues().cwiseMax(kLeastInformation).cwiseInverse().asDiagonal() *
         axes.transpose();
}

int order_by_bic(const std::vector<double>& partial, Eigen::Index n) {
  double best = 0.0, log_variance = 0.0;
  int order = 0;
  for (std::size_t p = 1; p <= partial.size(); ++p) {
    log_variance += std::log1p(-partial[p - 1] * partial[p - 1]);
    const double bic = static_cast<double>(n) * log_variance +
                       static_cast<double>(p) * std::log(static_cast<double>(n));
    if (bic < best) {
      best = bic;
      order = static_cast<int>(p);
    }
  }
  return order;
}

Noise make_noise(const Eigen::VectorXd& parameters) {
  Noise noise;
  noise.correlation = correlation_of(parameters);
  noise.innovation = std::exp(parameters[parameters.size() - 1]);
  return noise;
}

Noise white(double deviation) {
  Noise noise;
  noise.innovation = deviation;
  return noise;
}

/// Values of a residual beyond what the columns take.
int spare(const LinearProfile& profile) {
  return static_cast<int>(std::max<Eigen::Index>(
      profile.residual.size() - profile.nuisances.cols() - profile.columns.cols(), 1));
}

double white_variance(const LinearProfile& profile) {
  return profile.residual.squaredNorm() / spare(profile);
}

/// State of the estimation: noise parameters of each profile and the information they give.
class Estimator {
 public:
  Estimator(std::span<const LinearProfile> profiles, const Eigen::MatrixXd& prior_information,
            const Gates& gates)
      : profiles_(profiles),
        prior_(prior_information),
        gates_(gates),
        parameters_(profiles.size()),
        information_(profiles.size()) {
    for (std::size_t i = 0; i < profiles.size(); ++i) start(i);
  }

  std::vector<Noise> run() {
    // The profiles are coupled only through a few shared parameters.
    const int sweeps = profiles_.size() > 1 ? 3 : 1;
    constexpr double kSettled = 1e-6;
    double moved = INFINITY;
    for (int sweep = 0; sweep < sweeps && moved > kSettled; ++sweep) {
      moved = 0.0;
      for (std::size_t i = 0; i < profiles_.size(); ++i) moved = std::max(moved, refine(i));
    }
    std::vector<Noise> out;
    for (std::size_t i = 0; i < profiles_.size(); ++i) out.push_back(conclude(i));
    return out;
  }

 private:
  void start(std::size_t i) {
    const LinearProfile& profile = profiles_[i];
    const Eigen::Index n = profile.residual.size();
    const int most = std::clamp(static_cast<int>(spare(profile) / gates_.values_per_order) - 1, 0,
                                static_cast<int>(gates_.noise_order));
    std::vector<double> partial =
        Autoregression::burg({profile.residual.data(), static_cast<std::size_t>(n)}, most);
    partial.resize(order_by_bic(partial, n));
    if (Autoregression(partial).long_run_ratio() < 1.0) partial.clear();
    const auto least = static_cast<std::size_t>(std::min(profile.least_order, most));
    partial.resize(std::max(partial.size(), least), 0.0);
    likelihood_.emplace_back(profile, static_cast<int>(partial.size()));
    Eigen::VectorXd x(partial.size() + 1);
    for (std::size_t j = 0; j < partial.size(); ++j) x[j] = std::atanh(partial[j]);
    x[x.size() - 1] =
        0.5 * std::log(white_variance(profile) / Autoregression(partial).variance_ratio());
    parameters_[i] = x;
    information_[i] = likelihood_[i].information(x, nullptr);
  }

  [[nodiscard]] Eigen::MatrixXd others(std::size_t i) const {
    Eigen::MatrixXd rest = Eigen::MatrixXd::Zero(prior_.rows() + 1, prior_.cols() + 1);
    rest.topLeftCorner(prior_.rows(), prior_.cols()) = prior_;
    for (std::size_t j = 0; j < profiles_.size(); ++j)
      if (j != i) rest += information_[j];
    return rest;
  }

  /// @return the largest change of a parameter
  double refine(std::size_t i) {
    const Eigen::MatrixXd rest = others(i);
    const double most = most_correlated(profiles_[i].residual.size(), gates_);
    const Cost cost = [&](const Eigen::VectorXd& x) {
      return likelihood_[i](limited(x, most), rest);
    };
    const Eigen::VectorXd before = parameters_[i];
    parameters_[i] = limited(minimise(cost, before), most);
    information_[i] = likelihood_[i].information(parameters_[i], nullptr);
    return (parameters_[i] - before).lpNorm<Eigen::Infinity>();
  }

  [[nodiscard]] Noise conclude(std::size_t i) const {
    Noise noise = make_noise(parameters_[i]);
    const Eigen::MatrixXd rest = others(i);
    const Cost cost = [&](const Eigen::VectorXd& x) { return likelihood_[i](x, rest); };
    if (noise.correlation.order() > 0 && noise.correlation.long_run_ratio() < 1.0) {
      // Its own spread may be that of frequencies the columns have taken, which nobody has seen.
      noise = white(std::sqrt(white_variance(profiles_[i])));
      noise.covariance.setConstant(1, 1, 0.5 / spare(profiles_[i]));  // of ln σ
    } else {
      noise.covariance =
          covariance(cost, parameters_[i], most_correlated(profiles_[i].residual.size(), gates_));
    }
    const auto d = static_cast<Eigen::Index>(noise.covariance.rows());
    const std::optional<double>& declared = profiles_[i].declared;
    if (!declared) return noise;
    const auto n = static_cast<double>(profiles_[i].residual.size());
    const double gain = likelihood_[i](declared_parameters(i, *declared), rest) -
                        likelihood_[i](parameters_[i], rest);
    noise.overruled = gain > static_cast<double>(d) * std::log(n) + gates_.declared_noise_bic &&
                      noise.long_run_deviation() > *declared;
    if (noise.overruled) return noise;
    Noise out = white(*declared);
    out.declared = true;
    return out;
  }

  [[nodiscard]] Eigen::VectorXd declared_parameters(std::size_t i, double declared) const {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(parameters_[i].size());
    x[x.size() - 1] = std::log(declared);
    return x;
  }

  std::span<const LinearProfile> profiles_;
  const Eigen::MatrixXd& prior_;
  const Gates& gates_;
  std::vector<RestrictedLikelihood> likelihood_;
  std::vector<Eigen::VectorXd> parameters_;
  std::vector<Eigen::MatrixXd> information_;
};

}  // namespace

double Noise::standard_deviation() const {
  return innovation * std::sqrt(correlation.variance_ratio());
}

double Noise::long_run_deviation() const {
  return standard_deviation() * std::sqrt(correlation.long_run_ratio());
}

Eigen::VectorXd Noise::parameters() const {
  const auto& partial = correlation.partial_autocorrelations();
  Eigen::VectorXd x(partial.size() + 1);
  for (std::size_t j = 0; j < partial.size(); ++j) x[j] = std::atanh(partial[j]);
  x[x.size() - 1] = std::log(innovation);
  return x;
}

Noise Noise::at(const Eigen::VectorXd& parameters) const { return make_noise(parameters); }

void Noise::whiten(Eigen::Ref<Eigen::MatrixXd> rows) const {
  correlation.whiten(rows);
  rows /= innovation;
}

void Noise::colour(Eigen::Ref<Eigen::MatrixXd> rows) const {
  correlation.colour(rows);
  rows *= innovation;
}

double Noise::log_long_run_variance() const {
  if (!is_estimated()) return 0.0;
  const Eigen::VectorXd at_estimate = parameters();
  const Cost log_variance = [this](const Eigen::VectorXd& x) {
    return 2.0 * std::log(at(x).long_run_deviation());
  };
  const Eigen::VectorXd gradient = gradient_of(log_variance, at_estimate);
  return gradient.dot(covariance * gradient);
}

std::vector<Noise> estimate_noise(std::span<const LinearProfile> profiles,
                                  const Eigen::MatrixXd& prior_information, const Gates& gates) {
  return Estimator(profiles, prior_information, gates).run();
}

}  // namespace slideway
