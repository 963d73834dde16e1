#include "shared_texture.hpp"

#include <algorithm>
#include <cmath>

#include "repeats.hpp"
#include "slideway/base/statistics.hpp"
#include "slideway/identify/lack_of_fit.hpp"
#include "slideway/identify/linear_algebra.hpp"

namespace slideway {
namespace {

constexpr double kChance = 2.0;       // standard errors of a correlation
constexpr double kNearlyWhite = 0.5;  // of the values: so many white ones would say as much

using Fine = std::vector<std::optional<LinearProfile>>;

/// A reading, by its profile; its stations as they are or with the other half in front.
struct Reading {
  std::size_t profile;
  double side;  // 1 or -1
};

/// What is compared of all profiles, at its stations from the axis.
struct Textures {
  std::vector<std::vector<double>> stations;
  std::vector<Eigen::VectorXd> values;  // none: it says nothing

  Textures(const Linearisation& linear, const Fine& fine) {
    for (std::size_t i = 0; i < fine.size(); ++i) {
      stations.push_back(stations_from_axis(*linear.observations[i]));
      values.push_back(fine[i] ? bounded(fine[i]->residual) : Eigen::VectorXd());
    }
  }

 private:
  /// Within three standard deviations of most values: a step or an edge at one radius is no
  /// texture.
  static Eigen::VectorXd bounded(const Eigen::VectorXd& all) {
    const double most = 3.0 * deviation_of_most({all.data(), static_cast<std::size_t>(all.size())});
    return all.cwiseMax(-most).cwiseMin(most);
  }
};

/// What pairs of readings have in common, summed over values at one radius.
class Common {
 public:
  Common(const Textures& textures, const std::vector<Noise>& noise)
      : textures_(textures), noise_(noise) {}

  /// A value has in common with one at another station what their blocks overlap by: with the two
  /// nearest ones together as much as with one at its own station.
  /// @return whether half of the values of `a` have others
  bool add(std::size_t a, const Reading& b) {
    const std::vector<double>&of_a = textures_.stations[a], &of_b = textures_.stations[b.profile];
    const Eigen::VectorXd &own = textures_.values[a], &other = textures_.values[b.profile];
    if (own.size() == 0 || other.size() < 2 || (b.side < 0.0 && -of_a.back() > of_b.back()) ||
        (b.side < 0.0 && -of_a.front() < of_b.front()))
      return false;  // nothing at these radii
    const double step = (of_b.back() - of_b.front()) / static_cast<double>(of_b.size() - 1);
    const bool is_itself = b.profile == a;
    double matched = 0.0, rows = 0.0;
    for (std::size_t i = 0; i < of_a.size(); ++i) {
      const double at = b.side * of_a[i];
      if (is_itself && of_a[i] < 0.0) continue;  // each pair of halves once
      rows += 1.0;
      const auto row = static_cast<Eigen::Index>(i);
      bool found = false;
      for (auto j = std::ranges::upper_bound(of_b, at - kOneStep * step) - of_b.begin();
           j < std::ssize(of_b) && of_b[static_cast<std::size_t>(j)] < at + kOneStep * step; ++j) {
        if (is_itself && j == row) continue;  // at the axis
        products_ += own[row] * other[j];
        found = true;
      }
      if (!found) continue;
      matched += 1.0;
      squares_ += own[row] * own[row];
      white_ += 0.5 * (noise_[a].covariance().white + noise_[b.profile].covariance().white);
    }
    effective_ += noise_[a].effective_values() * matched / static_cast<double>(of_a.size());
    return 2.0 * matched >= rows && rows > 0.0;
  }

  /// Shares of the variances that are common.
  [[nodiscard]] Noise::Weight shares() const {
    if (products_ * std::sqrt(effective_) <= kChance * squares_) return {0.0, 0.0};
    const double memory = std::max(squares_ - white_, 0.0);
    return {memory > 0.0 ? std::min(products_ / memory, 1.0) : 0.0,
            white_ > 0.0 ? std::clamp((products_ - memory) / white_, 0.0, 1.0) : 0.0};
  }

 private:
  static constexpr double kOneStep = 1.0 - 1e-6;

  const Textures& textures_;
  const std::vector<Noise>& noise_;
  double products_ = 0.0, squares_ = 0.0, white_ = 0.0, effective_ = 0.0;
};

bool is_face(const Linearisation& linear, std::size_t i) {
  return linear.observations[i]->profile->setup.kind == Kind::face;
}

/// Whether the noise and what suspects may make, in each profile by itself, leave structure.
bool leaves_structure(Linearisation linear, const std::vector<Noise>& noise,
                      const std::vector<Eigen::MatrixXd>& suspect, const Gates& gates) {
  std::vector<Observation> with_suspects;
  with_suspects.reserve(suspect.size());
  for (std::size_t i = 0; i < suspect.size(); ++i) {
    Observation& own = with_suspects.emplace_back(*linear.observations[i]);
    append_columns(own.nuisances, suspect[i]);
    own.nuisances = orthonormal(std::move(own.nuisances));
    linear.observations[i] = &own;
  }
  return lack_of_fit(linear, noise, gates).significant(gates);
}

/// What turns leave differs from turn to turn; what is slow may be an effect that the model lacks.
bool may_be_of_turns(const Noise& noise, const std::optional<LinearProfile>& fine) {
  return fine &&
         noise.effective_values() >= kNearlyWhite * static_cast<double>(fine->residual.size());
}

void weigh(const Noise::Weight& weight, Noise& noise) {
  if (!noise.declared && (weight.memory > 1.0 || weight.white > 1.0))
    noise = noise.repeated(weight);
}

}  // namespace

void weigh_shared_texture(const Linearisation& linear, const Fine& fine,
                          const std::vector<Eigen::MatrixXd>& suspect, const Gates& gates,
                          std::vector<Noise>& noise) {
  const auto faces = grouped(linear, [&](const Observation& a, const Observation& b) {
    return are_of_one_surface(a, b, gates);
  });
  const Textures textures(linear, fine);
  std::vector<Noise> with_places = noise;
  bool any = false;
  for (const std::vector<std::size_t>& face : faces) {
    if (!is_face(linear, face.front())) continue;
    Common repeats(textures, noise), places(textures, noise);
    std::vector<double> of_repeats(face.size(), 0.0), of_places(face.size(), 0.0);
    for (std::size_t a = 0; a < face.size(); ++a)
      for (const std::size_t b : face)
        for (const double side : {1.0, -1.0}) {
          if (b == face[a] && side > 0.0) continue;
          const bool repeat = side > 0.0 && are_repeats(*linear.observations[face[a]],
                                                        *linear.observations[b], gates);
          const bool together = (repeat ? repeats : places).add(face[a], {b, side});
          (repeat ? of_repeats : of_places)[a] += together ? 1.0 : 0.0;
        }
    const Noise::Weight r = repeats.shares(), p = places.shares();
    any |= p.memory > 0.0 || p.white > 0.0;
    for (std::size_t a = 0; a < face.size(); ++a) {
      const Noise::Weight own{1.0 + of_repeats[a] * r.memory, 1.0 + of_repeats[a] * r.white};
      const double places_of_it =
          may_be_of_turns(noise[face[a]], fine[face[a]]) ? of_places[a] : 0.0;
      weigh({own.memory + places_of_it * p.memory, own.white + places_of_it * p.white},
            with_places[face[a]]);
      weigh(own, noise[face[a]]);
    }
  }
  if (any && !leaves_structure(linear, with_places, suspect, gates)) noise = std::move(with_places);
}

void weigh_halves(const Linearisation& alone, const std::optional<LinearProfile>& fine,
                  const Gates& gates, Noise& noise) {
  if (!is_face(alone, 0) || noise.declared || !may_be_of_turns(noise, fine)) return;
  const Textures textures(alone, {fine});
  const std::vector<Noise> of_it{noise};
  Common halves(textures, of_it);
  if (!halves.add(0, {0, -1.0})) return;
  const Noise::Weight shares = halves.shares();
  if (shares.memory == 0.0 && shares.white == 0.0) return;
  Noise weighed = noise;
  weigh({1.0 + shares.memory, 1.0 + shares.white}, weighed);
  if (!leaves_structure(alone, {weighed}, {}, gates)) noise = std::move(weighed);
}

}  // namespace slideway
