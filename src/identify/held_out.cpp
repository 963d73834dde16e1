#include "slideway/identify/held_out.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>

#include "slideway/base/distribution.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/identify/agreement.hpp"
#include "slideway/identify/linear_algebra.hpp"
#include "slideway/identify/noise_model.hpp"

namespace slideway {
namespace {

double trace_length(const Observation& observation) {
  return observation.profile->setup.last_mm - observation.profile->setup.first_mm;
}

/// Whether the noise of one low band is that of the other: read in the same way, value by value.
bool are_sisters(const Observation& a, const Observation& b, double tolerance) {
  const Setup &s = a.profile->setup, &t = b.profile->setup;
  const auto alike = [&](double of_a, double of_b) {
    return std::abs(of_a / trace_length(a) - of_b / trace_length(b)) <=
           tolerance * of_b / trace_length(b);
  };
  return s.kind == t.kind && s.quantity == t.quantity && s.base_mm == t.base_mm &&
         alike(static_cast<double>(a.low_band.samples()),
               static_cast<double>(b.low_band.samples())) &&
         alike(static_cast<double>(a.values.size()), static_cast<double>(b.values.size()));
}

/// What a cut has by its kinematics, as its samples show it: no fit of other cuts knows that,
/// unless the model has it in all.
struct OwnMarks {
  Eigen::VectorXd values;
  Eigen::MatrixXd columns;  // one standard uncertainty each

  OwnMarks(const Model& model, const Observation& observation)
      : values(Eigen::VectorXd::Zero(observation.values.size())), columns(values.size(), 0) {
    const Profile& profile = *observation.profile;
    const auto is_in_model = [&](const std::string& name) {
      return std::ranges::any_of(model.terms, [&](const ModelTerm& term) {
        return term.effect->description().name == name && term.acts_on(profile);
      });
    };
    for (const std::string& name : effect_names()) {
      const Effect& effect = specimen(name);
      if (!effect.description().kinematic || !effect.applies_to(profile.setup) ||
          !effect.lacking(profile.setup).empty() || is_in_model(name))
        continue;
      auto shown =
          effect.shown_by(profile.stations(model.machine), profile.values, model.gates.false_line);
      if (!shown) continue;
      shown->options.profiles = {profile.name};
      const ModelTerm term{name, make_effect(name, shown->options, model.machine, model.range), {}};
      const Eigen::MatrixXd images = low_band_images(model, term, shown->values, observation);
      values += images.leftCols(images.cols() / 2).rowwise().sum();
      append_columns(columns, images.rightCols(images.cols() / 2));
    }
  }
};

/// A profile that was not fitted, held against what the fit says of it.
struct Predicted {
  Eigen::MatrixXd free;        // nuisances, and directions the fit does not determine
  Eigen::MatrixXd columns;     // by the directions it determines, and of own marks
  Eigen::MatrixXd covariance;  // of these
  Eigen::VectorXd error;
  Noise noise;

  /// @param fitted  noise_of_each() fitted profile
  Predicted(const Model& model, const Solution& fit, const std::vector<Noise>& fitted,
            const Observation& observation) {
    const Eigen::MatrixXd all = linear_columns(model, fit.estimate, observation);
    error = observation.values - all.leftCols(model.amplitudes()) * fit.estimate.amplitudes;
    columns = all * fit.uncertainty.basis;
    const OwnMarks marks(model, observation);
    error -= marks.values;
    const Eigen::Index known = columns.cols();
    append_columns(columns, marks.columns);
    covariance = Eigen::MatrixXd::Identity(columns.cols(), columns.cols());
    covariance.topLeftCorner(known, known) = fit.uncertainty.inflation * fit.uncertainty.covariance;
    free = observation.nuisances;
    append_columns(free, all * fit.rank.null_space);
    set_noise(model, fit, fitted, observation);
  }

  [[nodiscard]] Eigen::MatrixXd free_basis() const {
    Eigen::MatrixXd white = free;
    noise.whiten(white);
    return orthonormal(std::move(white));
  }

 private:
  void set_noise(const Model& model, const Solution& fit, const std::vector<Noise>& fitted,
                 const Observation& observation) {
    const Noise* largest = nullptr;
    for (std::size_t i = 0; i < fitted.size(); ++i)
      if (are_sisters(observation, *fit.linear.observations[i], model.gates.same_place) &&
          (!largest || fitted[i].long_run_deviation() > largest->long_run_deviation()))
        largest = &fitted[i];
    if (largest) {
      noise = *largest;
      return;
    }
    Linearisation alone;
    alone.observations = {&observation};
    alone.columns = {Eigen::MatrixXd(error.size(), 0)};
    alone.residuals = {error};
    alone.prior_rows.resize(0, 0);
    noise = noise_beside(alone, model.gates).front();
  }
};

/// A square and how many independent ones it is the sum of.
struct Square {
  double found = 0.0, count = 0.0;
};

/// zᵀ (I + B Σ Bᵀ)⁻¹ z of white z.
double square_of(const Eigen::VectorXd& z, const Eigen::MatrixXd& B,
                 const Eigen::MatrixXd& covariance) {
  if (B.cols() == 0) return z.squaredNorm();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(covariance);
  const Eigen::MatrixXd A =
      B * eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  const Eigen::VectorXd products = A.transpose() * z;
  Eigen::MatrixXd information = A.transpose() * A;
  information.diagonal().array() += 1.0;
  return std::max(0.0, z.squaredNorm() - products.dot(information.llt().solve(products)));
}

/// Probability of a larger square under a noise whose size is an estimate (LackOfFit).
/// @param more  relative variance of that size besides
double tail(const Square& square, const Noise& noise, double more) {
  constexpr double kMostSpread = 1.0;  // of ln(long-run variance)
  if (square.count < 1.0) return 1.0;
  const double spread = std::min(noise.log_long_run_variance(), kMostSpread);
  const double mean = square.count * std::exp(0.5 * spread);
  const double variance = 2.0 * mean * mean / square.count +
                          mean * mean * (std::expm1(spread) + (noise.is_estimated() ? more : 0.0));
  return gamma_tail(mean * mean / variance, square.found * mean / variance);
}

/// Probability of as large a white error, wherever it is (Bonferroni).
double tail_of_largest(const Eigen::VectorXd& error, const Eigen::MatrixXd& columns,
                       const Eigen::MatrixXd& covariance, const Noise& noise) {
  const Eigen::VectorXd variance =
      ((columns * covariance).cwiseProduct(columns)).rowwise().sum().array() + 1.0;
  const double largest = std::sqrt(error.cwiseAbs2().cwiseQuotient(variance).maxCoeff());
  const double of_one = noise.is_estimated() ? student_tail(noise.freedom, largest)
                                             : 0.5 * std::erfc(largest / std::sqrt(2.0));
  return std::min(1.0, 2.0 * static_cast<double>(error.size()) * of_one);
}

void set_largest(const Observation& observation, const Predicted& predicted, HeldOutCheck& out) {
  Eigen::MatrixXd white(predicted.error.size(), predicted.free.cols() + 1);
  white << predicted.free, predicted.error;
  predicted.noise.whiten(white);
  const Eigen::Index m = predicted.free.cols();
  Eigen::VectorXd error = predicted.error;
  if (m > 0)
    error -= predicted.free * least_squares(white.leftCols(m), white.rightCols(1)).values.col(0);
  const Eigen::VectorXd variance =
      ((predicted.columns * predicted.covariance).cwiseProduct(predicted.columns))
          .rowwise()
          .sum()
          .array() +
      std::pow(predicted.noise.standard_deviation(), 2);
  Eigen::Index at = 0;
  error.cwiseAbs2().cwiseQuotient(variance).maxCoeff(&at);
  const double size = error[at] / std::sqrt(static_cast<double>(observation.low_band.samples()) /
                                            static_cast<double>(error.size()));
  out.at_mm = observation.low_band.positions(observation.profile->positions)[std::size_t(at)];
  if (observation.profile->setup.quantity == Quantity::height)
    out.largest_um = size / kMicrometre;
  else
    out.largest_urad = size / kMicroradian;
}

/// Residuals of the fitted profiles but for odd repeats.
Linearisation without_odd(const Linearisation& fitted, const Gates& gates) {
  const std::vector<OddRepeat> odd = odd_repeats(fitted, gates);
  Linearisation out;
  for (std::size_t i = 0; i < fitted.observations.size(); ++i) {
    if (std::ranges::count(odd, i, &OddRepeat::profile) > 0) continue;
    out.observations.push_back(fitted.observations[i]);
    out.residuals.push_back(fitted.residuals[i]);
  }
  return out;
}

/// @param repeats  without_odd()
HeldOutCheck check(const Model& model, const Solution& fit, const std::vector<Noise>& fitted,
                   Linearisation repeats, const Observation& observation) {
  const Predicted predicted(model, fit, fitted, observation);
  const Eigen::MatrixXd& covariance = predicted.covariance;
  const Eigen::Index n = predicted.error.size(), r = predicted.columns.cols();
  const Eigen::Index q = slow_cosine_count(n, model.gates);
  Eigen::MatrixXd rows(n, r + 1 + q);
  rows << predicted.columns, predicted.error, slow_cosines(n, q);
  predicted.noise.whiten(rows);
  const Eigen::MatrixXd free = predicted.free_basis();
  project_out(free, rows);
  const Eigen::MatrixXd slow = orthonormal(rows.rightCols(q));
  const auto columns = rows.leftCols(r);
  const Eigen::VectorXd error = rows.col(r);
  const Square all{square_of(error, columns, covariance), static_cast<double>(n - free.cols())};
  const Square band{square_of(slow.transpose() * error, slow.transpose() * columns, covariance),
                    static_cast<double>(slow.cols())};
  HeldOutCheck out;
  out.profile = observation.profile->name;
  out.chi2 = all.found / std::max(all.count, 1.0);
  const double extrapolation = std::pow(model.gates.noise_extrapolation, 2);
  repeats.observations.push_back(&observation);
  repeats.residuals.push_back(predicted.error);
  out.p_value = std::min(
      1.0,
      4.0 * std::min({tail(all, predicted.noise, 0.0), tail(band, predicted.noise, extrapolation),
                      tail_of_largest(error, columns, covariance, predicted.noise),
                      probability_beside_repeats(repeats, repeats.observations.size() - 1,
                                                 model.gates)}));
  set_largest(observation, predicted, out);
  if (out.p_value < model.gates.held_out_p) out.verdict = HeldOutVerdict::does_not_fit;
  return out;
}

}  // namespace

std::vector<HeldOutCheck> check_held_out(const Model& model, const Solution& fit,
                                         const std::vector<Noise>& of_each) {
  std::vector<HeldOutCheck> out;
  std::optional<Linearisation> repeats;
  for (const Observation& observation : model.observations) {
    if (observation.profile->role != Role::holdout) continue;
    if (!repeats) repeats = without_odd(fit.linear, model.gates);
    out.push_back(check(model, fit, of_each, *repeats, observation));
  }
  return out;
}

}  // namespace slideway
