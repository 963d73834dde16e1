#include "detection.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <boost/math/distributions/non_central_chi_squared.hpp>
#include <cmath>

#include "gates.hpp"
#include "linear_algebra.hpp"
#include "slideway/base/parallel.hpp"
#include "slideway/base/text.hpp"

namespace slideway {
namespace {

constexpr double kPower = 0.8;
constexpr double kPowerDeviate = 0.8416;  // normal deviate of 80 %
constexpr double kNegligible = 0.02;      // of a column's size: not worth a name

/// Distribution of a gain where there is an effect, in plain doubles; not finite instead of an
/// exception where it can not be evaluated.
namespace policies = boost::math::policies;
using Quiet = policies::policy<policies::domain_error<policies::ignore_error>,
                               policies::evaluation_error<policies::ignore_error>,
                               policies::overflow_error<policies::ignore_error>,
                               policies::promote_double<false>>;
using GainOfEffect = boost::math::non_central_chi_squared_distribution<double, Quiet>;

std::span<const double> middle_shape(const Candidate& candidate) {
  return candidate.shapes[candidate.shapes.size() / 2];
}

std::string shape_text(const Candidate& candidate, std::span<const double> shape) {
  std::string out;
  for (std::size_t s = 0; s < shape.size(); ++s) {
    const int p = candidate.term.effect->shapes()[s].parameter;
    out += candidate.term.effect->parameters()[static_cast<std::size_t>(p)].name + " = " +
           significant(shape[s], 3);
  }
  return out;
}

/// Share of a candidate's column each parameter of the model takes, as a column of its own.
std::string made_by(const Model& model, const Fit& fit, const Whitened& data,
                    const Eigen::VectorXd& column) {
  const Linearisation& linear = fit.linear;
  const Eigen::Index k = linear.prior_rows.cols();
  Eigen::MatrixXd columns(data.rows(), k);
  columns = stack(linear, k, [&](std::size_t i) { return linear.columns[i]; });
  Eigen::MatrixXd all = columns;
  for (std::size_t i = 0; i < linear.observations.size(); ++i) {
    const Eigen::MatrixXd& own = linear.observations[i]->nuisances;
    Eigen::MatrixXd wide = Eigen::MatrixXd::Zero(data.rows(), own.cols());
    wide.middleRows(data.first_row(i), data.count(i)) = own;
    Eigen::MatrixXd joined(data.rows(), all.cols() + own.cols());
    joined << all, wide;
    all = std::move(joined);
  }
  const Eigen::VectorXd amplitudes = least_squares(all, column).values.topRows(k);
  const Eigen::VectorXd parameters = fit.parameters.jacobian * amplitudes;
  const Eigen::MatrixXd back =
      Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(fit.parameters.jacobian)
          .pseudoInverse();
  const std::vector<std::string> names = model.parameter_names();
  std::vector<std::string> out;
  for (Eigen::Index p = 0; p < parameters.size(); ++p) {
    if (fit.null.identifiable.size() > static_cast<std::size_t>(p) &&
        !fit.null.identifiable[static_cast<std::size_t>(p)])
      continue;
    const double share =
        (columns * back.col(p) * parameters[p]).norm() / std::max(column.norm(), 1e-300);
    if (share > kNegligible) out.push_back(names[static_cast<std::size_t>(p)]);
  }
  return out.empty() ? "offset and tilt of the traces" : joined(out);
}

}  // namespace

std::optional<double> detection_limit(const Model& model, const Whitened& data,
                                      const Candidate& candidate, std::span<const double> shape,
                                      const Calibration& calibration, double significance) {
  const Eigen::MatrixXd columns =
      stacked_columns(model, candidate.term, shape, data.rows() - data.values());
  const Projection own = project(data, columns);
  if (own.rank == 0 || !candidate.term.effect->has_one_size()) return std::nullopt;
  const double enough = std::max(penalty(data, candidate.unknowns(own.rank)) +
                                     std::max(kEnough, calibration.threshold(significance)),
                                 kLeastSize * kLeastSize);
  const double noncentrality =
      GainOfEffect::find_non_centrality(static_cast<double>(own.rank), enough, 1.0 - kPower);
  if (!std::isfinite(noncentrality)) return std::nullopt;
  const Effect& effect = *candidate.term.effect;
  const Eigen::Index a = candidate.amplitudes();
  Eigen::VectorXd values =
      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(effect.parameters().size()));
  values[0] = 1.0;
  for (std::size_t s = 0; s < shape.size(); ++s) values[effect.shapes()[s].parameter] = shape[s];
  // Gain of one unit of the first parameter; the mean over its phase, where it has one.
  const double gain = own.gram.diagonal().head(std::min<Eigen::Index>(a, 2)).mean() *
                      effect.from_parameters(values).head(a).squaredNorm();
  if (!(gain > 0.0)) return std::nullopt;
  const double limit = std::sqrt(noncentrality / gain);
  if (shape.empty()) return limit;
  values[0] = limit;
  const Eigen::VectorXd inner = effect.from_parameters(values);
  Eigen::MatrixXd joint(data.rows(), a + 1);
  joint << columns, stacked_derivatives(model, candidate.term, shape, data.rows() - data.values()) *
                        inner.head(a);
  joint = data.outside(std::move(joint));
  const Eigen::MatrixXd inverse =
      Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(joint).pseudoInverse();
  const ParameterValues at = effect.parameter_values(inner.head(a), shape);
  const double uncertainty = (at.jacobian.row(0) * inverse).norm();
  return std::max(limit, (kLeastSize + kPowerDeviate) * uncertainty);
}

std::vector<DetectionLimit> detection_limits(const Model& model, const Whitened& data,
                                             const Candidates& candidates,
                                             const Calibration& calibration, double significance) {
  std::vector<std::optional<double>> limits(candidates.size());
  parallel_for(candidates.size(), [&](std::size_t c) {
    limits[c] = detection_limit(model, data, *candidates[c], middle_shape(*candidates[c]),
                                calibration, significance);
  });
  std::vector<DetectionLimit> out;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    if (!limits[c]) continue;
    const Candidate& candidate = *candidates[c];
    const Parameter& first = candidate.term.effect->parameters()[0];
    out.push_back({candidate.name(), first.name, first.unit, *limits[c],
                   shape_text(candidate, middle_shape(candidate))});
  }
  return out;
}

std::vector<std::pair<std::string, std::string>> inseparable(const Model& model, const Fit& fit,
                                                             const Whitened& data,
                                                             const Candidates& candidates) {
  std::vector<std::pair<std::string, std::string>> out;
  for (const Candidate* candidate : candidates) {
    const Eigen::MatrixXd columns = stacked_columns(
        model, candidate->term, middle_shape(*candidate), data.rows() - data.values());
    if (project(data, columns).rank > 0 || columns.isZero(0.0)) continue;
    out.emplace_back(candidate->name(), made_by(model, fit, data, columns.col(0)));
  }
  return out;
}

}  // namespace slideway
