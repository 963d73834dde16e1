#include "slideway/identify/pooling.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "slideway/base/distribution.hpp"
#include "slideway/base/statistics.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/identify/gates.hpp"
#include "slideway/identify/identifiability.hpp"
#include "slideway/identify/uncertainty.hpp"
#include "trend.hpp"

namespace slideway {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kPoolRegion = 0.954499736103642;  // of two standard deviations
constexpr double kPoolCoverage = 2.0;              // of kPoolRegion, the uncertainties known
constexpr double kFalseAlarm = 0.05;               // of any item of a machine whose items all fit
constexpr std::size_t kKnowsScatter = 5;           // items that tell a scatter from an outlier
constexpr std::size_t kKnowsDrift = 6;  // items, all with a time, that tell a drift from one

/// Rows [A | y] of an item for the carriages' parameters alone: what else it has is left free.
MatrixXd carriage_rows(const PoolItem& item) {
  const auto rows = static_cast<Index>(item.evidence.rows.size());
  const auto all = static_cast<Index>(item.evidence.parameters.size());
  std::vector<Index> own, others;
  for (Index p = 0; p < all; ++p)
    (is_carriage_parameter(item.evidence.parameters[p]) ? own : others).push_back(p);
  MatrixXd a(rows, all + 1);
  for (Index i = 0; i < rows; ++i)
    for (Index p = 0; p <= all; ++p)
      a(i, p) = p < all ? item.evidence.rows[i][p] : item.evidence.values[i];
  own.push_back(all);
  MatrixXd kept = a(Eigen::all, own);
  if (others.empty()) return kept;
  MatrixXd foreign = a(Eigen::all, others);
  foreign.colwise().normalize();
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(foreign.array().isFinite().select(foreign, 0.0));
  const MatrixXd turned = qr.householderQ().adjoint() * kept;
  return turned.bottomRows(rows - qr.rank());
}

/// The least-squares solution of stacked rows of unit variance.
struct SolvedRows {
  Rank rank;
  VectorXd values;      // with the parameters nobody determines along null_space at the least
  MatrixXd covariance;  // of what is determined

  explicit SolvedRows(const MatrixXd& rows) {
    const Index p = rows.cols() - 1;
    const MatrixXd a = rows.leftCols(p);
    const Eigen::HouseholderQR<MatrixXd> qr(rows);
    MatrixXd triangle = MatrixXd::Zero(p + 1, p + 1);
    const Index height = std::min(rows.rows(), p + 1);
    triangle.topRows(height) =
        qr.matrixQR().topRows(height).triangularView<Eigen::Upper>().toDenseMatrix();
    const MatrixXd left = triangle.topLeftCorner(p, p);
    rank = analyse_rank(left, a.colwise().norm().transpose(), Gates{}.rank_tolerance);
    values = rank.basis * (rank.basis.transpose() * (left.transpose() * triangle.col(p).head(p)));
    covariance = rank.basis * rank.basis.transpose();
  }

  /// Which parameters are determined by themselves.
  [[nodiscard]] std::vector<bool> determined(const VectorXd& scale) const {
    std::vector<bool> out(values.size(), true);
    for (Index j = 0; j < rank.null_space.cols(); ++j) {
      const VectorXd direction = scale.cwiseProduct(rank.null_space.col(j)).cwiseAbs();
      for (Index p = 0; p < direction.size(); ++p)
        if (direction[p] > 1e-6 * direction.maxCoeff()) out[p] = false;
    }
    return out;
  }
};

VectorXd scale_of(const MatrixXd& rows) {
  return rows.leftCols(rows.cols() - 1).colwise().norm().transpose().unaryExpr([](double norm) {
    return norm > 0.0 ? norm : 1.0;
  });
}

MatrixXd stacked(const std::vector<MatrixXd>& parts, const std::vector<bool>& taken,
                 std::size_t except) {
  Index rows = 0;
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (taken[i] && i != except) rows += parts[i].rows();
  MatrixXd out(rows, parts.front().cols());
  rows = 0;
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (taken[i] && i != except) {
      out.middleRows(rows, parts[i].rows()) = parts[i];
      rows += parts[i].rows();
    }
  return out;
}

struct Misfit {
  double chi_square = 0.0;
  Index degrees_of_freedom = 0;  // 0: nothing to hold it against
  [[nodiscard]] double quantile(double probability) const {
    return chi_squared_quantile(static_cast<double>(degrees_of_freedom), probability);
  }
  [[nodiscard]] double p_value(double scatter) const {
    return chi_squared_tail(static_cast<double>(degrees_of_freedom),
                            chi_square / (scatter * scatter));
  }
};

/// v = y - A θ_rest, along what the rest determines.
Misfit misfit(const MatrixXd& item, const MatrixXd& rest) {
  if (rest.rows() == 0) return {};
  const SolvedRows solution(rest);
  const MatrixXd a = item.leftCols(item.cols() - 1);
  const VectorXd v = item.rightCols(1) - a * solution.values;
  MatrixXd determined = MatrixXd::Identity(item.rows(), item.rows());
  if (solution.rank.null_space.cols() > 0) {
    MatrixXd open = a * solution.rank.null_space;
    const double size = (a * scale_of(item).cwiseInverse().asDiagonal()).norm();
    Eigen::ColPivHouseholderQR<MatrixXd> qr(open);
    const double longest = qr.maxPivot();
    qr.setThreshold(longest > 0.0 ? std::min(1.0, 1e-6 * size / longest) : 1.0);
    const MatrixXd q = qr.householderQ();
    determined = q.rightCols(item.rows() - qr.rank());
  }
  const VectorXd left = determined.transpose() * v;
  const MatrixXd spread =
      determined.transpose() *
      (MatrixXd::Identity(item.rows(), item.rows()) + a * solution.covariance * a.transpose()) *
      determined;
  return {left.dot(spread.llt().solve(left)), left.size()};
}

/// Holds the items against each other; left-out ones against those that fit.
class Comparison {
 public:
  explicit Comparison(const std::vector<MatrixXd>& parts)
      : parts_(&parts), fits_(parts.size(), true), misfits_(parts.size()) {
    compare();
    while (const std::optional<std::size_t> worst = worst_misfit()) {
      fits_[*worst] = false;
      compare();
    }
  }
  [[nodiscard]] const std::vector<bool>& fits() const { return fits_; }
  [[nodiscard]] const Misfit& of(std::size_t item) const { return misfits_[item]; }
  [[nodiscard]] double scatter() const { return scatter_; }

 private:
  void compare() {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < parts_->size(); ++i) {
      misfits_[i] = misfit((*parts_)[i], stacked(*parts_, fits_, i));
      if (fits_[i] && misfits_[i].degrees_of_freedom > 0)
        ratios.push_back(misfits_[i].chi_square / misfits_[i].quantile(0.5));
    }
    scatter_ = 1.0;
    if (ratios.size() < kKnowsScatter) return;
    scatter_ = std::sqrt(std::max(1.0, median(ratios)));
  }

  [[nodiscard]] std::optional<std::size_t> worst_misfit() const {
    const std::size_t all = parts_->size();
    const auto left = static_cast<std::size_t>(std::count(fits_.begin(), fits_.end(), true));
    if (left < 3 || 2 * (left - 1) <= all) return std::nullopt;  // no majority to tell by
    std::optional<std::size_t> worst;
    double least = kFalseAlarm / static_cast<double>(all), largest = 0.0;
    for (std::size_t i = 0; i < all; ++i) {
      if (!fits_[i] || misfits_[i].degrees_of_freedom == 0) continue;
      const double p = misfits_[i].p_value(scatter_);
      // Beyond the range of p-values the larger χ² is the worse.
      if (p > least || (p == least && misfits_[i].chi_square <= largest)) continue;
      least = p;
      largest = misfits_[i].chi_square;
      worst = i;
    }
    return worst;
  }

  const std::vector<MatrixXd>* parts_;
  std::vector<bool> fits_;
  std::vector<Misfit> misfits_;
  double scatter_ = 1.0;
};

struct CarriageParameters {
  std::vector<std::string> names, units;
  bool operator==(const CarriageParameters&) const = default;
};

CarriageParameters carriage_parameters(const PoolItem& item) {
  CarriageParameters out;
  for (std::size_t p = 0; p < item.evidence.parameters.size(); ++p)
    if (is_carriage_parameter(item.evidence.parameters[p])) {
      out.names.push_back(item.evidence.parameters[p]);
      out.units.push_back(item.evidence.units[p]);
    }
  return out;
}

std::vector<FittedParameter> estimates(const CarriageParameters& parameters, const MatrixXd& rows,
                                       double scatter) {
  const SolvedRows solution(rows);
  const std::vector<bool> determined = solution.determined(scale_of(rows));
  std::vector<FittedParameter> out;
  for (std::size_t p = 0; p < parameters.names.size(); ++p) {
    FittedParameter parameter;
    parameter.name = parameters.names[p];
    parameter.unit = parameters.units[p];
    parameter.identifiable = determined[p];
    if (parameter.identifiable) {
      parameter.value = solution.values[p];
      parameter.standard_uncertainty = scatter * std::sqrt(solution.covariance(p, p));
      parameter.coverage_factor = kPoolCoverage;
      parameter.expanded_uncertainty = kPoolCoverage * *parameter.standard_uncertainty;
    }
    out.push_back(std::move(parameter));
  }
  return out;
}

/// Every part with as many columns again, for what its parameters change over time: a machine that
/// drifts is no reason for its first and last items not to fit. Times from -1 to 1 about their
/// mean; as they are where an item has none, or where too few would tell a drift from an outlier.
std::vector<MatrixXd> drifting(const std::vector<MatrixXd>& parts,
                               const std::vector<std::optional<double>>& times) {
  double mean = 0.0, span = 0.0;
  for (const std::optional<double>& time : times) {
    if (!time || parts.size() < kKnowsDrift) return parts;
    mean += *time / static_cast<double>(times.size());
  }
  for (const std::optional<double>& time : times) span = std::max(span, std::abs(*time - mean));
  if (!(span > 0.0)) return parts;
  std::vector<MatrixXd> out;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const MatrixXd a = parts[i].leftCols(parts[i].cols() - 1);
    out.emplace_back(parts[i].rows(), 2 * a.cols() + 1);
    out.back() << a, a * ((*times[i] - mean) / span), parts[i].rightCols(1);
  }
  return out;
}

}  // namespace

bool is_carriage_parameter(const std::string& name) {
  return motion_error_of(name) != MotionError::none;
}

PooledMachine pool(const std::string& machine, const std::vector<PoolItem>& items) {
  PooledMachine out;
  out.machine = machine;
  std::vector<MatrixXd> parts;
  std::vector<std::optional<double>> part_times;
  CarriageParameters parameters;
  for (const PoolItem& item : items) {
    if (parts.empty()) parameters = carriage_parameters(item);
    if (parameters.names.empty() || carriage_parameters(item) != parameters) {
      out.left_out.push_back(item.id);
      continue;
    }
    out.items.push_back({item.id});
    parts.push_back(carriage_rows(item));
    part_times.push_back(item.time);
  }
  if (parts.empty()) return out;

  const std::vector<MatrixXd> over_time = drifting(parts, part_times);
  const Comparison comparison(over_time);
  out.scatter = comparison.scatter();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    out.items[i].fits = comparison.fits()[i];
    const Misfit& misfit = comparison.of(i);
    if (misfit.degrees_of_freedom == 0) continue;
    out.items[i].p_value = misfit.p_value(out.scatter);
    out.items[i].En = std::sqrt(misfit.chi_square / misfit.quantile(kPoolRegion)) / out.scatter;
  }
  const MatrixXd rows = stacked(parts, comparison.fits(), parts.size());
  out.parameters = estimates(parameters, rows, out.scatter);

  std::vector<std::vector<FittedParameter>> single;  // of the items with a time that fit
  std::vector<double> at;
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (comparison.fits()[i] && part_times[i]) {
      single.push_back(estimates(parameters, parts[i], 1.0));
      at.push_back(*part_times[i]);
    }
  out.trends = trends(single, at);
  return out;
}

}  // namespace slideway
