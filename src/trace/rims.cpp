#include "rims.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>

#include "slideway/base/text.hpp"
#include "slideway/profile/profile.hpp"

namespace slideway {
namespace {

constexpr Eigen::Index kLeastFitted = 12;  // differences
constexpr Eigen::Index kFitted = 4;        // times as many as it is extrapolated over

/// Of a low band, what is not left out on one side of the axis, from the rim inwards.
struct Half {
  std::vector<double> radii, residuals;
  ValueIndices values;

  void add(double radius, double residual, Eigen::Index value) {
    radii.push_back(radius);
    residuals.push_back(residual);
    values.push_back(value);
  }

  [[nodiscard]] double at(double radius) const {  // REQUIRES radii.back() <= radius <= radii[0]
    const auto inner = std::ranges::lower_bound(radii, radius, std::greater());
    const auto k = static_cast<std::size_t>(inner - radii.begin());
    if (k == 0) return residuals[0];
    const double part = (radii[k - 1] - radius) / (radii[k - 1] - radii[k]);
    return (1.0 - part) * residuals[k - 1] + part * residuals[k];
  }
};

/// The two halves of a diameter against each other, from the rim inwards.
class Halves {
 public:
  Halves(const Observation& observation, const Eigen::VectorXd& residual) {
    const Profile& profile = *observation.profile;
    const std::vector<double> places = observation.low_band.positions(profile.positions);
    const ValueIndices gone = left_out_values(observation);
    for (Eigen::Index i = 0; i < std::ssize(places); ++i) {
      const double x = places[static_cast<std::size_t>(i)] - profile.setup.center_mm;
      if (x == 0.0 || std::ranges::binary_search(gone, i)) continue;
      (x < 0.0 ? far_ : near_).add(std::abs(x), residual[i], i);
    }
    for (auto* list : {&near_.radii, &near_.residuals}) std::ranges::reverse(*list);
    std::ranges::reverse(near_.values);
    if (!near_.radii.empty() && !far_.radii.empty()) compare();
  }

  [[nodiscard]] Eigen::Index size() const { return std::ssize(radii_); }

  /// Of `count` differences from `first` inwards.
  [[nodiscard]] Eigen::Vector3d parabola(Eigen::Index first, Eigen::Index count) const {
    const Sums own = sums_.col(first + count) - sums_.col(first);
    Eigen::Matrix3d gram;
    gram << own[0], own[1], own[2], own[1], own[2], own[3], own[2], own[3], own[4];
    return gram.ldlt().solve(own.tail<3>());
  }

  /// What a difference has beyond a parabola.
  [[nodiscard]] double beyond(const Eigen::Vector3d& parabola, Eigen::Index k) const {
    const double u = place(k);
    return differences_[static_cast<std::size_t>(k)] - parabola.dot(Eigen::Vector3d(1.0, u, u * u));
  }

  /// The values of both halves from the rim to the difference `last`.
  [[nodiscard]] ValueIndices values_to(Eigen::Index last) const {
    const double inner = radii_[static_cast<std::size_t>(last)] * (1.0 - 1e-9);
    ValueIndices out;
    for (const Half* half : {&near_, &far_})
      for (std::size_t k = 0; k < half->radii.size() && half->radii[k] >= inner; ++k)
        out.push_back(half->values[k]);
    std::ranges::sort(out);
    return out;
  }

 private:
  using Sums = Eigen::Vector<double, 8>;  // of 1, u ... u⁴, and of d, d u, d u²

  [[nodiscard]] double place(Eigen::Index k) const {
    return radii_[static_cast<std::size_t>(k)] / radii_[0];
  }

  void compare() {
    for (std::size_t k = 0; k < near_.radii.size(); ++k) {
      const double r = near_.radii[k];
      if (r > far_.radii.front() || r < far_.radii.back()) continue;
      radii_.push_back(r);
      differences_.push_back(near_.residuals[k] - far_.at(r));
    }
    sums_ = Eigen::MatrixXd::Zero(8, size() + 1);
    for (Eigen::Index k = 0; k < size(); ++k) {
      const double u = place(k), d = differences_[static_cast<std::size_t>(k)];
      sums_.col(k + 1) =
          sums_.col(k) + Sums{1.0, u, u * u, u * u * u, u * u * u * u, d, d * u, d * u * u};
    }
  }

  Half near_, far_;
  std::vector<double> radii_, differences_;  // where both have values
  Eigen::MatrixXd sums_;                     // those of all before k in column k
};

}  // namespace

ValueIndices values_past_a_rim(const Observation& observation, const Eigen::VectorXd& residual,
                               const Gates& gates) {
  const Setup& setup = observation.profile->setup;
  if (setup.kind != Kind::face || setup.quantity != Quantity::height) return {};
  const Halves halves(observation, residual);
  const auto beyond =
      static_cast<Eigen::Index>(std::ceil(gates.most_lost * static_cast<double>(halves.size())));
  const Eigen::Index fitted = std::max(kLeastFitted, kFitted * beyond);
  const Eigen::Index end = halves.size() - 2 * beyond - fitted;  // at the axis a centre error bends
  if (end - beyond < kLeastFitted) return {};
  double square = 0.0;
  for (Eigen::Index k = beyond; k < end; ++k)
    square += std::pow(halves.beyond(halves.parabola(k + beyond, fitted), k), 2);
  const double most = gates.one_rim * std::sqrt(square / static_cast<double>(end - beyond));
  const Eigen::Vector3d parabola = halves.parabola(beyond, fitted);
  const auto deviation = [&](Eigen::Index k) { return std::abs(halves.beyond(parabola, k)); };
  if (!(deviation(0) > most)) return {};
  Eigen::Index last = 0;
  while (last + 1 < beyond && deviation(last + 1) > 0.5 * most) ++last;
  return halves.values_to(last);
}

std::string leave_out_past_rims(const FittedModel& fitted, Model& model) {
  std::vector<std::string> names;
  const Linearisation& linear = fitted.fit.linear;
  for (std::size_t i = 0; i < linear.observations.size(); ++i) {
    const Profile* const profile = linear.observations[i]->profile;
    Observation& own = *std::ranges::find(model.observations, profile, &Observation::profile);
    if (leave_out(own, values_past_a_rim(own, linear.residuals[i], model.gates)))
      names.push_back("'" + profile->name + "'");
  }
  if (names.empty()) return "";
  return "at the rim the two ends of " + joined(names) +
         " differ, as where a trace runs past the face: values there are left out; check "
         "center_mm, "
         "or give a window";
}

}  // namespace slideway
