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

/// What pairs of readings have in common, summed over values at one radius.
class Common {
 public:
  Common(const Linearisation& linear, const Fine& fine, const std::vector<Noise>& noise)
      : fine_(fine), noise_(noise) {
    for (std::size_t i = 0; i < fine.size(); ++i) {
      stations_.push_back(stations_from_axis(*linear.observations[i]));
      bounded_.push_back(fine[i] ? bounded(fine[i]->residual) : Eigen::VectorXd());
    }
  }

  /// A value has in common with one at another station what their blocks overlap by: with the two
  /// nearest ones together as much as with one at its own station.
  /// @return whether half of the values of `a` have others
  bool add(std::size_t a, const Reading& b) {
    if (!fine_[a] || !fine_[b.profile]) return false;
    const std::vector<double>&of_a = stations_[a], &of_b = stations_[b.profile];
    const Eigen::VectorXd &own = bounded_[a], &other = bounded_[b.profile];
    if (of_b.size() < 2 || (b.side < 0.0 && -of_a.back() > of_b.back()) ||
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

  /// Within three standard deviations of most values: a step or an edge at one radius is no
  /// texture.
  static Eigen::VectorXd bounded(const Eigen::VectorXd& values) {
    constexpr double kNormal = 0.6744897501960817;  // median of the size of a standard normal value
    Eigen::VectorXd sizes = values.cwiseAbs();
    const double most =
        3.0 / kNormal * median({sizes.data(), static_cast<std::size_t>(sizes.size())});
    return values.cwiseMax(-most).cwiseMin(most);
  }

  const Fine& fine_;
  const std::vector<Noise>& noise_;
  std::vector<std::vector<double>> stations_;
  std::vector<Eigen::VectorXd> bounded_;
  double products_ = 0.0, squares_ = 0.0, white_ = 0.0, effective_ = 0.0;
};

bool is_face(const Linearisation& linear, std::size_t i) {
  return linear.observations[i]->profile->setup.kind == Kind::face;
}

/// Profiles that read one face, by index, rising.
std::vector<std::vector<std::size_t>> faces_of(const Linearisation& linear, const Gates& gates) {
  std::vector<std::vector<std::size_t>> out;
  for (std::size_t i = 0; i < linear.observations.size(); ++i) {
    if (!is_face(linear, i)) continue;
    const auto own = std::ranges::find_if(out, [&](const std::vector<std::size_t>& face) {
      return are_of_one_surface(*linear.observations[face.front()], *linear.observations[i], gates);
    });
    if (own != out.end())
      own->push_back(i);
    else
      out.push_back({i});
  }
  return out;
}

/// With the columns of suspects beside those of the model, of each profile by itself.
Linearisation beside(const Linearisation& linear, const std::vector<Eigen::MatrixXd>& suspect) {
  Linearisation out = linear;
  Eigen::Index more = 0;
  for (const Eigen::MatrixXd& own : suspect) more += own.cols();
  if (more == 0) return out;
  for (Eigen::Index i = 0, first = 0; i < std::ssize(suspect); ++i) {
    Eigen::MatrixXd& columns = out.columns[static_cast<std::size_t>(i)];
    const Eigen::MatrixXd& own = suspect[static_cast<std::size_t>(i)];
    append_columns(columns, Eigen::MatrixXd::Zero(columns.rows(), more));
    columns.middleCols(linear.columns[static_cast<std::size_t>(i)].cols() + first, own.cols()) =
        own;
    first += own.cols();
  }
  append_columns(out.prior_rows, Eigen::MatrixXd::Zero(out.prior_rows.rows(), more));
  return out;
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
  std::vector<Noise> with_places = noise;
  bool any = false;
  for (const std::vector<std::size_t>& face : faces_of(linear, gates)) {
    Common repeats(linear, fine, noise), places(linear, fine, noise);
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
  if (any && !lack_of_fit(beside(linear, suspect), with_places, gates).significant(gates))
    noise = std::move(with_places);
}

void weigh_halves(const Linearisation& alone, const std::optional<LinearProfile>& fine,
                  const Gates& gates, Noise& noise) {
  if (!is_face(alone, 0) || noise.declared || !may_be_of_turns(noise, fine)) return;
  const Fine own{fine};
  const std::vector<Noise> of_it{noise};
  Common halves(alone, own, of_it);
  if (!halves.add(0, {0, -1.0})) return;
  const Noise::Weight shares = halves.shares();
  if (shares.memory == 0.0 && shares.white == 0.0) return;
  Noise weighed = noise;
  weigh({1.0 + shares.memory, 1.0 + shares.white}, weighed);
  if (!lack_of_fit(alone, {weighed}, gates).significant(gates)) noise = std::move(weighed);
}

}  // namespace slideway
