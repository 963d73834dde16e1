#include "copies.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace slideway {
namespace {

constexpr double kSamePlace = 1e-3;    // of a station
constexpr double kRoundings = 0.75;    // of two roundings: half, and what levelling adds
constexpr double kScatter = 10.0;      // roundings a value scatters by: noise that a display shows
constexpr double kRough = 0.02;        // fourth over second differences: a smooth curve has none
constexpr Eigen::Index kLeast = 8;     // values
constexpr double kArithmetic = 1e-12;  // of the largest value

using Values = Eigen::Map<const Eigen::ArrayXd>;

Values values_of(const Profile& profile) {
  return {profile.values.data(), std::ssize(profile.values)};
}

bool have_same_stations(const Profile& a, const Profile& b) {
  if (a.setup.kind != b.setup.kind || a.setup.quantity != b.setup.quantity ||
      a.positions.size() != b.positions.size())
    return false;
  const bool face = a.setup.kind == Kind::face;
  const double shift = face ? b.setup.center_mm - a.setup.center_mm : 0.0;
  const double near = kSamePlace * (a.positions.back() - a.positions.front()) /
                      static_cast<double>(a.positions.size());
  return std::ranges::equal(a.positions, b.positions,
                            [&](double s, double t) { return std::abs(t - shift - s) <= near; });
}

/// Largest difference of two profiles after levelling.
double largest_difference(const Profile& a, const Profile& b) {
  Eigen::ArrayXd rest = values_of(b) - values_of(a);
  rest -= rest.mean();
  if (a.setup.quantity == Quantity::height) {
    Eigen::ArrayXd x = Eigen::Map<const Eigen::ArrayXd>(a.positions.data(), rest.size());
    x -= x.mean();
    rest -= (x * rest).sum() / x.square().sum() * x;
  }
  return rest.abs().maxCoeff();
}

/// Standard deviation of white noise with the same differences of an even order.
double scatter(Eigen::ArrayXd values, int order) {
  double gain = 1.0;  // binomial(2 order, order)
  for (int k = 1; k <= order; ++k) {
    values = (values.tail(values.size() - 1) - values.head(values.size() - 1)).eval();
    gain *= static_cast<double>(order + k) / k;
  }
  return std::sqrt(values.square().mean() / gain);
}

/// Least difference between two values.
double rounding(const Profile& profile) {
  std::vector<double> sorted = profile.values;
  std::ranges::sort(sorted);
  const double none = kArithmetic * values_of(profile).abs().maxCoeff();
  double least = HUGE_VAL;
  for (std::size_t i = 1; i < sorted.size(); ++i)
    if (const double gap = sorted[i] - sorted[i - 1]; gap > none) least = std::min(least, gap);
  return least;
}

bool is_copy(const Profile& a, const Profile& b) {
  if (!have_same_stations(a, b)) return false;
  if (!a.sha256.empty() && a.sha256 == b.sha256 && a.values == b.values) return true;
  if (std::ssize(a.values) < kLeast) return false;
  const double fine = scatter(values_of(a), 4);
  const double difference = largest_difference(a, b);
  if (!(difference < fine) || fine < kRough * scatter(values_of(a), 2)) return false;
  const double both = rounding(a) + rounding(b);
  return difference <= kRoundings * both && fine >= kScatter * both;
}

}  // namespace

void hold_out_copies(std::vector<Profile>& profiles) {
  for (auto copy = profiles.begin(); copy != profiles.end(); ++copy) {
    const auto original = std::find_if(profiles.begin(), copy,
                                       [&](const Profile& each) { return is_copy(each, *copy); });
    if (original == copy) continue;
    const bool both = original->role == Role::fit && copy->role == Role::fit;
    copy->doubts.push_back(
        "a copy of profile '" + original->name +
        "': the same values after levelling, to their rounding; " +
        (both ? "it is not fitted, so that they count once" : "that they agree says nothing"));
    original->notes.push_back("profile '" + copy->name + "' is a copy of this one");
    if (both) copy->role = Role::holdout;
  }
}

}  // namespace slideway
