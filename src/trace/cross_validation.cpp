#include "cross_validation.hpp"

#include <algorithm>
#include <cmath>

#include "slideway/identify/linear_algebra.hpp"

namespace slideway {
namespace {

/// rms of the values predicted from every other block and the priors, mm or rad; none where too few
/// are left.
std::optional<double> prediction_error(const Solution& fit, Eigen::Index blocks) {
  const Linearisation& linear = fit.linear;
  const Observation& observation = *linear.observations.front();
  const Eigen::Index n = observation.values.size(), m = observation.nuisances.cols();
  const Eigen::Index k = linear.columns.front().cols();
  Eigen::MatrixXd rows(n, m + k + 1);
  rows << observation.nuisances, linear.columns.front(), linear.residuals.front();
  const Eigen::Index of_priors = linear.prior_rows.rows();
  Eigen::MatrixXd priors(of_priors, m + k + 1);  // in units of the noise, as rows are
  priors.leftCols(m).setZero();
  priors.middleCols(m, k) = linear.prior_rows;
  priors.rightCols(1) = linear.prior_residuals;
  priors *= fit.noise.front().standard_deviation();
  const std::vector<Eigen::Index> undescribed = left_out_values(observation);
  double square = 0.0;
  for (Eigen::Index fold = 0; fold < 2; ++fold) {
    std::vector<Eigen::Index> kept, left_out;
    for (Eigen::Index i = 0; i < n; ++i)
      (i * blocks / n % 2 == fold ? left_out : kept).push_back(i);
    Eigen::MatrixXd of(std::ssize(kept) + of_priors, m + k + 1);
    if (of.rows() <= m + k) return std::nullopt;
    of.topRows(std::ssize(kept)) = rows(kept, Eigen::all);
    of.bottomRows(of_priors) = priors;
    const Eigen::VectorXd fitted = least_squares(of.leftCols(m + k), of.rightCols(1)).values;
    const Eigen::MatrixXd gap = rows(left_out, Eigen::all);
    Eigen::VectorXd error = gap.rightCols(1) - gap.leftCols(m + k) * fitted;
    for (std::size_t row = 0; row < left_out.size(); ++row)
      if (std::ranges::binary_search(undescribed, left_out[row]))
        error[static_cast<Eigen::Index>(row)] = 0.0;
    square += error.squaredNorm();
  }
  return std::sqrt(square / static_cast<double>(observation.low_band.samples()));
}

}  // namespace

std::vector<BlockPrediction> cross_validate(const Solution& before, const Solution& after,
                                            const Gates& gates) {
  if (before.linear.observations.size() != 1) return {};
  const Profile& profile = *before.linear.observations.front()->profile;
  const bool height = profile.setup.quantity == Quantity::height;
  const double unit = height ? kMicrometre : kMicroradian;
  std::vector<BlockPrediction> out;
  for (double blocks = gates.most_blocks; blocks >= gates.least_blocks; blocks /= 2.0) {
    const auto count = static_cast<Eigen::Index>(blocks);
    const auto without = prediction_error(before, count), with = prediction_error(after, count);
    if (!without || !with) continue;
    BlockPrediction& entry = out.emplace_back();
    entry.block_mm = (profile.setup.last_mm - profile.setup.first_mm) / static_cast<double>(count);
    (height ? entry.before_rms_um : entry.before_rms_urad) = *without / unit;
    (height ? entry.after_rms_um : entry.after_rms_urad) = *with / unit;
  }
  return out;
}

Gain gain_of(const std::vector<BlockPrediction>& predictions) {
  const auto falls = [](const BlockPrediction& each) {
    return each.before_rms_um ? *each.after_rms_um < *each.before_rms_um
                              : *each.after_rms_urad < *each.before_rms_urad;
  };
  return std::ranges::all_of(predictions, falls) ? Gain::prediction : Gain::interpolation;
}

}  // namespace slideway
