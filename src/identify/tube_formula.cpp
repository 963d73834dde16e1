#include "tube_formula.hpp"

#include <algorithm>
#include <cmath>

#include "slideway/base/distribution.hpp"
#include "slideway/base/units.hpp"

namespace slideway {

double path_length(const Eigen::MatrixXd& rows, const Eigen::VectorXd& variance, double least) {
  double length = 0.0;
  Eigen::RowVectorXd before(0);
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    if (!(variance[i] > least)) continue;
    const Eigen::RowVectorXd unit = rows.row(i) / std::sqrt(variance[i]);
    if (before.size() > 0) length += std::min((unit - before).norm(), (unit + before).norm());
    before = unit;
  }
  return length;
}

double simultaneous_factor(double length, double freedom, double outside) {
  const auto probability = [&](double c) {
    const double of_path = std::isfinite(freedom) ? std::pow(1.0 + c * c / freedom, -0.5 * freedom)
                                                  : std::exp(-0.5 * c * c);
    const double of_point =
        std::isfinite(freedom) ? student_tail(freedom, c) : 0.5 * std::erfc(c / std::sqrt(2.0));
    return length / kPi * of_path + 2.0 * of_point;
  };
  double low = 0.0, high = 1.0;
  while (probability(high) > outside) low = high, high *= 2.0;
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    (probability(middle) > outside ? low : high) = middle;
  }
  return high;
}

}  // namespace slideway
