#include "numeric_derivative.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace slideway {
namespace {

constexpr int kStepHalvings = 14;
constexpr double kGoodEnough = 1e-11;  // of the largest derivative: rounding is next
constexpr double kSmall = 1e-6;        // of the largest derivative: the step resolves f
constexpr double kWorse = 2.0;         // times the best error, once small: rounding has taken over
constexpr double kLeastRoom = 0.05;    // of the step; nearer to an end differences are one-sided

}  // namespace

NumericDerivative numeric_derivative(const std::function<Eigen::MatrixXd(double)>& f, double p,
                                     double step, double lower, double upper) {
  const double room = std::min(p - lower, upper - p);
  const bool central = room >= kLeastRoom * step;
  const double side = upper - p >= p - lower ? 1.0 : -1.0;
  double h = central ? std::min(step, room) : std::min(step, 0.5 * (upper - lower));
  const Eigen::MatrixXd here = central ? Eigen::MatrixXd{} : f(p);
  const auto difference = [&]() -> Eigen::MatrixXd {
    if (central) return (f(p + h) - f(p - h)) / ((p + h) - (p - h));
    return (f(p + side * h) - here) / ((p + side * h) - p);
  };
  NumericDerivative best{difference(), std::numeric_limits<double>::infinity()};
  std::vector<Eigen::MatrixXd> row{best.value};  // extrapolated once, twice, ... from this step
  for (int i = 1; i < kStepHalvings; ++i) {
    h /= 2.0;
    std::vector<Eigen::MatrixXd> next{difference()};
    const double shrink = central ? 4.0 : 2.0;
    double factor = shrink, least = std::numeric_limits<double>::infinity();
    for (const Eigen::MatrixXd& coarser : row) {
      const Eigen::MatrixXd& finer = next.back();
      Eigen::MatrixXd value = finer + (finer - coarser) / (factor - 1.0);
      const double error =
          std::max((value - finer).cwiseAbs().maxCoeff(), (value - coarser).cwiseAbs().maxCoeff());
      least = std::min(least, error);
      if (error < best.error) best = {value, error};
      next.push_back(std::move(value));
      factor *= shrink;
    }
    const double largest = best.value.cwiseAbs().maxCoeff();
    if (best.error <= kGoodEnough * largest) break;
    if (best.error <= kSmall * largest && least > kWorse * best.error) break;
    row = std::move(next);
  }
  return best;
}

}  // namespace slideway
