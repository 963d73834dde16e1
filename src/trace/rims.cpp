#include "rims.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

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

  [[nodiscard]] double at(double radius) const {  // REQUIRES radii.back() <= radius <= radii[0]
    const auto inner = std::ranges::find_if(radii, [&](double r) { return r <= radius; });
    const auto k = static_cast<std::size_t>(inner - radii.begin());
    if (k == 0) return residuals[0];
    const double part = (radii[k - 1] - radius) / (radii[k - 1] - radii[k]);
    return (1.0 - part) * residuals[k - 1] + part * residuals[k];
  }
};

Half half_of(const Observation& observation, const Eigen::VectorXd& residual, double sign) {
  const Profile& profile = *observation.profile;
  const std::vector<double> places = observation.low_band.positions(profile.positions);
  const ValueIndices gone = left_out_values(observation);
  Half out;
  for (Eigen::Index k = 0; k < std::ssize(places); ++k) {
    const Eigen::Index i = sign < 0.0 ? k : std::ssize(places) - 1 - k;
    const double r = sign * (places[static_cast<std::size_t>(i)] - profile.setup.center_mm);
    if (r <= 0.0) break;
    if (std::ranges::binary_search(gone, i)) continue;
    out.radii.push_back(r);
    out.residuals.push_back(residual[i]);
    out.values.push_back(i);
  }
  return out;
}

/// The two halves of a diameter against each other, from the rim inwards.
struct Halves {
  Half near, far;
  std::vector<double> radii, differences;  // where both have values

  Halves(const Observation& observation, const Eigen::VectorXd& residual)
      : near(half_of(observation, residual, 1.0)), far(half_of(observation, residual, -1.0)) {
    if (near.radii.empty() || far.radii.empty()) return;
    for (std::size_t k = 0; k < near.radii.size(); ++k) {
      const double r = near.radii[k];
      if (r > far.radii.front() || r < far.radii.back()) continue;
      radii.push_back(r);
      differences.push_back(near.residuals[k] - far.at(r));
    }
  }

  [[nodiscard]] Eigen::Index size() const { return std::ssize(radii); }

  /// What a difference has beyond the parabola through `count` of them from `first` inwards.
  [[nodiscard]] double beyond_parabola(Eigen::Index k, Eigen::Index first,
                                       Eigen::Index count) const {
    Eigen::MatrixX3d columns(count, 3);
    const auto place = [&](Eigen::Index at) { return radii[static_cast<std::size_t>(at)]; };
    const double middle = place(first + count / 2), unit = place(first) - middle;
    const auto powers = [&](Eigen::Index at) {
      const double u = (place(at) - middle) / unit;
      return Eigen::RowVector3d(1.0, u, u * u);
    };
    for (Eigen::Index i = 0; i < count; ++i) columns.row(i) = powers(first + i);
    const Eigen::Map<const Eigen::VectorXd> values(differences.data() + first, count);
    const Eigen::Vector3d parabola =
        (columns.transpose() * columns).ldlt().solve(columns.transpose() * values);
    return differences[static_cast<std::size_t>(k)] - powers(k) * parabola;
  }
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
    square += std::pow(halves.beyond_parabola(k, k + beyond, fitted), 2);
  const double most = gates.one_rim * std::sqrt(square / static_cast<double>(end - beyond));
  const auto deviation = [&](Eigen::Index k) {
    return std::abs(halves.beyond_parabola(k, beyond, fitted));
  };
  if (!(deviation(0) > most)) return {};
  Eigen::Index last = 0;
  while (last + 1 < beyond && deviation(last + 1) > 0.5 * most) ++last;
  const double inner = halves.radii[static_cast<std::size_t>(last)] * (1.0 - 1e-9);
  ValueIndices out;
  for (const Half* half : {&halves.near, &halves.far})
    for (std::size_t k = 0; k < half->radii.size() && half->radii[k] >= inner; ++k)
      out.push_back(half->values[k]);
  std::ranges::sort(out);
  return out;
}

std::optional<WithinRims> within_rims(const FittedModel& declared) {
  std::vector<std::string> names;
  Model model = declared.model;
  const Linearisation& linear = declared.fit.linear;
  for (std::size_t i = 0; i < linear.observations.size(); ++i) {
    const Profile* const profile = linear.observations[i]->profile;
    Observation& own = *std::ranges::find(model.observations, profile, &Observation::profile);
    if (leave_out(own, values_past_a_rim(own, linear.residuals[i], model.gates)))
      names.push_back("'" + profile->name + "'");
  }
  if (names.empty()) return std::nullopt;
  return WithinRims{fit_model(std::move(model)),
                    "at the rim the two ends of " + joined(names) +
                        " differ, as where a trace runs past the face: values there are left out; "
                        "check center_mm, or give a window"};
}

}  // namespace slideway
