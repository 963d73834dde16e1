#include "holdout.hpp"

#include <cmath>

#include "slideway/identify/departures.hpp"
#include "slideway/identify/linear_algebra.hpp"

namespace slideway {
namespace {

/// White columns [model, effect, residual] of one profile, free of its nuisances and loose values,
/// as the triangle that has the same inner products.
Eigen::MatrixXd white_rows(const Linearisation& linear, const Whitened& data, std::size_t i,
                           const Eigen::MatrixXd& effect) {
  const Observation& observation = *linear.observations[i];
  const Eigen::Index k = linear.prior_rows.cols(), a = effect.cols();
  const Eigen::Index free = observation.nuisances.cols();
  const Eigen::MatrixXd units = unit_columns(data.undescribed()[i], data.count(i));
  Eigen::MatrixXd rows(observation.values.size(), free + units.cols() + k + a + 1);
  rows << observation.nuisances, units, linear.columns[i],
      effect.middleRows(data.first_row(i), data.count(i)), linear.residuals[i];
  data.noise()[i].whiten(rows);
  const Eigen::MatrixXd basis = orthonormal(rows.leftCols(rows.cols() - k - a - 1));
  Eigen::MatrixXd rest = rows.rightCols(k + a + 1);
  const Eigen::VectorXd before = rest.colwise().norm();
  project_out(basis, rest);
  clear_rounding(rest.leftCols(k + a), before);
  return upper_triangle(rest);
}

Eigen::MatrixXd below(const Eigen::MatrixXd& top, const Eigen::MatrixXd& bottom) {
  Eigen::MatrixXd out(top.rows() + bottom.rows(), top.cols());
  out << top, bottom;
  return out;
}

/// The triangle of what comes before each block: `first` and the blocks before it.
template <typename Iterator>
std::vector<Eigen::MatrixXd> triangles_before(Eigen::MatrixXd first, Iterator block, Iterator end) {
  std::vector<Eigen::MatrixXd> out{std::move(first)};
  for (; block != end; ++block) out.push_back(upper_triangle(below(out.back(), *block)));
  return out;
}

/// What some profiles say: model, and model with effect, fitted to their rows and the priors.
struct FitOfOthers {
  LeastSquares without, with;
  Eigen::Index rank = 0;  // amplitudes of the effect that they tell from the model

  /// @param kept        white_rows() of these profiles and the rows of the priors
  /// @param amplitudes  of the effect as all profiles have it
  FitOfOthers(const Eigen::MatrixXd& kept, const Eigen::VectorXd& amplitudes) {
    const Eigen::Index a = amplitudes.size(), k = kept.cols() - a - 1;
    Eigen::MatrixXd targets(kept.rows(), 2);
    targets << kept.rightCols(1), kept.middleCols(k, a) * amplitudes;
    without = least_squares(kept.leftCols(k), targets);
    with = least_squares(kept.leftCols(k + a), kept.rightCols(1));
    rank = orthonormal(kept.leftCols(k + a)).cols() - orthonormal(kept.leftCols(k)).cols();
  }

  [[nodiscard]] double gain() const { return without.squares[0] - with.squares[0]; }
  /// Gain to expect from an effect of the given amplitudes.
  [[nodiscard]] double expected() const { return without.squares[1]; }
  [[nodiscard]] Eigen::VectorXd model() const { return without.values.col(0); }
};

/// A square summed over the profiles left out, as predicted without and with the effect.
struct PredictionError {
  double before = 0.0, after = 0.0;

  void add(const Eigen::VectorXd& without, const Eigen::VectorXd& with) {
    before += without.squaredNorm();
    after += with.squaredNorm();
  }
};

/// Prediction of a profile's low band, its own levelling allowed: what is left of the residual.
Eigen::VectorXd left_over(const Observation& observation, Eigen::VectorXd rest) {
  if (observation.nuisances.cols() > 0)
    rest -= observation.nuisances * fitted_nuisances(observation, rest);
  return rest;
}

std::optional<HeldOut> left_out_in_turn(const Linearisation& linear, const Whitened& data,
                                        const Refined& candidate, const Gates& gates) {
  const double certain = gates.size * gates.size;  // gain of an effect of that size
  const std::size_t count = linear.observations.size();
  const Eigen::Index k = linear.prior_rows.cols(), a = candidate.columns.cols();
  const Projection& whole = candidate.projection;
  const Eigen::VectorXd& amplitudes = whole.amplitudes;
  if (count < 2) return std::nullopt;
  std::vector<Eigen::MatrixXd> rows;
  for (std::size_t i = 0; i < count; ++i)
    rows.push_back(white_rows(linear, data, i, candidate.columns));
  Eigen::MatrixXd priors = Eigen::MatrixXd::Zero(linear.prior_rows.rows(), k + a + 1);
  priors.leftCols(k) = linear.prior_rows;
  priors.rightCols(1) = linear.prior_residuals;
  const std::vector<Eigen::MatrixXd> before =
      triangles_before(std::move(priors), rows.begin(), rows.end());
  const std::vector<Eigen::MatrixXd> behind =
      triangles_before(Eigen::MatrixXd(0, k + a + 1), rows.rbegin(), rows.rend());
  PredictionError heights;
  bool shown_by_each = true;
  double support = 0.0, shown = 0.0, samples = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto model = rows[i].leftCols(k), effect = rows[i].middleCols(k, a);
    if (effect.isZero(0.0)) continue;
    const FitOfOthers others(below(before[i], behind[count - 1 - i]), amplitudes);
    if (others.rank < whole.rank || !(others.expected() >= gates.holdout_share * whole.gain))
      continue;
    const Eigen::VectorXd carried = others.with.values.bottomRows(a);
    const Eigen::VectorXd astray = carried - amplitudes;
    shown += whole.gain - others.expected();
    support += whole.gain - astray.dot(whole.gram * astray) - others.gain();
    const Eigen::MatrixXd basis = orthonormal(model);
    const auto outside = [&](const Eigen::VectorXd& column) -> Eigen::VectorXd {
      return column - basis * (basis.transpose() * column);
    };
    if (others.expected() >= certain && outside(effect * amplitudes).squaredNorm() >= certain) {
      const Eigen::VectorXd residual = rows[i].col(k + a);
      shown_by_each &=
          outside(residual - effect * carried).squaredNorm() <= outside(residual).squaredNorm();
    }
    const Observation& observation = *linear.observations[i];
    if (observation.profile->setup.quantity != Quantity::height) continue;
    const auto own = candidate.columns.middleRows(data.first_row(i), data.count(i));
    heights.add(left_over(observation, linear.residuals[i] - linear.columns[i] * others.model()),
                left_over(observation, linear.residuals[i] -
                                           linear.columns[i] * others.with.values.topRows(k) -
                                           own * carried));
    samples += static_cast<double>(observation.low_band.samples());
  }
  if (!(shown >= certain)) return std::nullopt;
  HeldOut out{support > 0.0 && shown_by_each, {}, {}};
  if (samples > 0.0) {
    out.before_um = std::sqrt(heights.before / samples) / kMicrometre;
    out.after_um = std::sqrt(heights.after / samples) / kMicrometre;
  }
  return out;
}

}  // namespace

std::optional<HeldOut> leave_one_out(const Model& model, const Linearisation& linear,
                                     const Whitened& data, const Refined& candidate) {
  const Projection& found = candidate.projection;
  if (found.rank == 0) return std::nullopt;
  const std::vector<Eigen::MatrixXd> errors = errors_of_cause(
      model, linear, candidate.candidate->term, candidate.shape, found.amplitudes[0]);
  if (errors.empty()) return left_out_in_turn(linear, data, candidate, model.gates);
  std::vector<Noise> noise = data.noise();
  for (std::size_t i = 0; i < noise.size(); ++i) noise[i].add_known(errors[i]);
  const Whitened wider(linear, std::move(noise), data.undescribed());
  Refined again = candidate;
  again.projection = project(wider, candidate.columns);
  return left_out_in_turn(linear, wider, again, model.gates);
}

}  // namespace slideway
