#include "heat.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "process.hpp"
#include "search.hpp"

namespace slideway {
namespace {

constexpr int kTimes = 24;                         // time constants tried at first
constexpr double kShortest = 0.005, kLongest = 5;  // of the time of the cuts
constexpr int kHeatRefinements = 3;                // each about the best pair, four times finer

class HeatSearch {
 public:
  HeatSearch(const Model& model, const Whitened& data, const Linearisation& linear)
      : data_(data),
        linear_(linear),
        t_(readings_of(model, linear, "t")),
        x_(slide_positions(model, linear)) {}

  double run() {
    double first = INFINITY, last = -INFINITY;
    for (const Eigen::VectorXd& t : t_)
      first = std::min(first, t.minCoeff()), last = std::max(last, t.maxCoeff());
    if (!(first < last)) return 0.0;
    const double shortest = kShortest * (last - first);
    double spacing = std::log(kLongest / kShortest) / (kTimes - 1);
    std::vector<double> lift, tilt;
    for (int i = 0; i < kTimes; ++i) lift.push_back(shortest * std::exp(spacing * i));
    tilt = lift;
    for (int pass = 0; pass <= kHeatRefinements; ++pass) {
      try_pairs(lift, tilt);
      spacing /= 4.0;
      lift = about(best_lift_, spacing);
      tilt = about(best_tilt_, spacing);
    }
    return gain_;
  }

 private:
  static std::vector<double> about(double best, double spacing) {
    std::vector<double> out;
    for (int i = -4; i <= 4; ++i) out.push_back(best * std::exp(spacing * i));
    return out;
  }

  void try_pairs(const std::vector<double>& lift, const std::vector<double>& tilt) {
    const Eigen::Index lifts = std::ssize(lift), tilts = std::ssize(tilt);
    const Eigen::MatrixXd columns = data_.outside(stack(linear_, lifts + tilts, [&](std::size_t i) {
      Eigen::MatrixXd rows(t_[i].size(), lifts + tilts);
      for (Eigen::Index j = 0; j < rows.cols(); ++j) {
        const double time = j < lifts ? lift[static_cast<std::size_t>(j)]
                                      : tilt[static_cast<std::size_t>(j - lifts)];
        rows.col(j) = -(-t_[i].array() / time).expm1();
      }
      rows.rightCols(tilts).array().colwise() *= x_[i].array();
      rows *= low_band_scale(*linear_.observations[i]);
      return rows;
    }));
    const Eigen::VectorXd products = columns.transpose() * data_.residual();
    const Eigen::MatrixXd gram = columns.transpose() * columns;
    for (Eigen::Index j = 0; j < tilts; ++j) {
      const Eigen::Index b = lifts + j;
      if (!(gram(b, b) > 0.0)) continue;
      keep(products[b] * products[b] / gram(b, b), 2, lift.front(), tilt[std::size_t(j)]);
      for (Eigen::Index a = 0; a < lifts; ++a) {
        constexpr double kAlike = 1e-6;  // 1 - cos²: below it the two are one
        const double determinant = gram(a, a) * gram(b, b) - gram(a, b) * gram(a, b);
        if (!(determinant > kAlike * gram(a, a) * gram(b, b))) continue;
        const double fall =
            (gram(b, b) * products[a] * products[a] - 2.0 * gram(a, b) * products[a] * products[b] +
             gram(a, a) * products[b] * products[b]) /
            determinant;
        keep(fall, 4, lift[std::size_t(a)], tilt[std::size_t(j)]);
      }
    }
  }

  void keep(double fall, Eigen::Index unknowns, double lift, double tilt) {
    const double gain = 0.5 * (fall - penalty(data_, unknowns));
    if (!(gain > gain_) && best_tilt_ > 0.0) return;
    gain_ = std::max(gain, gain_);
    best_lift_ = lift;
    best_tilt_ = tilt;
  }

  const Whitened& data_;
  const Linearisation& linear_;
  std::vector<Eigen::VectorXd> t_, x_;
  double gain_ = 0.0, best_lift_ = 0.0, best_tilt_ = 0.0;
};

}  // namespace

double heat_lifts_and_tilts(const Model& model, const Whitened& data, const Linearisation& linear) {
  return HeatSearch(model, data, linear).run();
}

}  // namespace slideway
