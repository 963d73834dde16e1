#include "instrument.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>

#include "process.hpp"
#include "slideway/base/random.hpp"
#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"
#include "slideway/identify/linear_algebra.hpp"
#include "slideway/identify/noise_model.hpp"

namespace slideway {
namespace {

constexpr Eigen::Index kFirstOctave = 4;  // coefficients
constexpr Eigen::Index kSharedCosines = 512;
constexpr int kDraws = 1999;  // of the null distribution
constexpr std::uint64_t kSeed = 18110914;

/// A residual in mm or rad along the slide.
struct Curve {
  std::vector<double> positions;
  Eigen::VectorXd values;
  Eigen::Index taken = 0;  // coefficients that the model takes, beside the mean

  Curve(const Linearisation& linear, std::size_t i)
      : positions(
            linear.observations[i]->low_band.positions(linear.observations[i]->profile->positions)),
        values(linear.residuals[i] / low_band_scale(*linear.observations[i])) {
    const Observation& observation = *linear.observations[i];
    const Eigen::Index levelling = std::ssize(observation.nuisance_names);
    Eigen::MatrixXd span(values.size(), levelling + linear.columns[i].cols());
    span << observation.nuisances.leftCols(levelling), linear.columns[i];
    const Eigen::MatrixXd basis = orthonormal(std::move(span));
    values -= basis * (basis.transpose() * values).eval();  // weights of the fit move a line
    taken = std::max<Eigen::Index>(basis.cols() - 1, 0);
    if (observation.profile->setup.reversed) values = -values;
  }

  [[nodiscard]] double at(double x) const {
    const auto next = std::clamp<std::ptrdiff_t>(
        std::ranges::lower_bound(positions, x) - positions.begin(), 1, std::ssize(positions) - 1);
    const double share = (x - positions[next - 1]) / (positions[next] - positions[next - 1]);
    return values[next - 1] + share * (values[next] - values[next - 1]);
  }
};

/// Both curves at as many places of their common travel as the one with fewer values has there.
std::pair<Eigen::VectorXd, Eigen::VectorXd> on_one_grid(const Curve& a, const Curve& b) {
  const double low = std::max(a.positions.front(), b.positions.front());
  const double high = std::min(a.positions.back(), b.positions.back());
  const auto inside = [&](const Curve& curve) {
    return std::ranges::upper_bound(curve.positions, high) -
           std::ranges::lower_bound(curve.positions, low);
  };
  const std::ptrdiff_t count =
      high > low ? std::max<std::ptrdiff_t>(0, std::min(inside(a), inside(b))) : 0;
  std::pair<Eigen::VectorXd, Eigen::VectorXd> out{Eigen::VectorXd(count), Eigen::VectorXd(count)};
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const double x =
        low + (high - low) * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    out.first[i] = a.at(x);
    out.second[i] = b.at(x);
  }
  return out;
}

double correlation(const Eigen::Ref<const Eigen::VectorXd>& a,
                   const Eigen::Ref<const Eigen::VectorXd>& b) {
  const double norm = a.norm() * b.norm();
  return norm > 0.0 ? a.dot(b) / norm : 0.0;
}

double statistic(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  double out = 0.0;
  for (Eigen::Index first = 0, width = kFirstOctave; first + kFirstOctave <= a.size();
       first += width, width *= 2) {
    const Eigen::Index count = std::min(width, a.size() - first);
    const double r = correlation(a.segment(first, count), b.segment(first, count));
    if (r > 0.0)
      out -= 0.5 * static_cast<double>(count) * std::log1p(-std::min(r * r, 1.0 - 1e-12));
  }
  return out;
}

double probability(double found, Eigen::Index coefficients) {
  RandomStream random(kSeed, "instrument");
  const auto draw = [&] {
    Eigen::VectorXd out(coefficients);
    for (double& value : out) value = random.normal();
    return out;
  };
  int as_large = 1;
  for (int k = 0; k < kDraws; ++k) {
    const Eigen::VectorXd a = draw(), b = draw();
    as_large += statistic(a, b) >= found ? 1 : 0;
  }
  return as_large / (kDraws + 1.0);
}

bool is_one_instrument(const Profile& a, const Profile& b) {
  const auto key = [](const Profile& p) {
    return std::tuple(p.instrument, p.setup.quantity, p.setup.base_mm);
  };
  return a.setup.kind == Kind::slide && b.setup.kind == Kind::slide && key(a) == key(b);
}

std::optional<SharedResidual> shared(const Linearisation& linear, std::size_t i, std::size_t j) {
  const Profile &p = *linear.observations[i]->profile, &q = *linear.observations[j]->profile;
  if (!is_one_instrument(p, q) || !p.surface || !q.surface || p.surface == q.surface)
    return std::nullopt;
  const Curve a(linear, i), b(linear, j);
  const auto [of_a, of_b] = on_one_grid(a, b);
  const Eigen::Index taken = std::max(a.taken, b.taken);
  const Eigen::Index count = std::min<Eigen::Index>(of_a.size() / 2, kSharedCosines) - taken;
  if (count < kFirstOctave) return std::nullopt;
  const Eigen::MatrixXd cosines = slow_cosines(of_a.size(), taken + count).rightCols(count);
  SharedResidual out{{p.name, q.name}, correlation(of_a, of_b)};
  out.p_value =
      probability(statistic(cosines.transpose() * of_a, cosines.transpose() * of_b), count);
  const double rms = std::sqrt(std::max(0.0, of_a.dot(of_b)) / static_cast<double>(of_a.size()));
  if (p.setup.quantity == Quantity::height)
    out.rms_um = rms / kMicrometre;
  else
    out.rms_urad = rms / kMicroradian;
  return out;
}

}  // namespace

std::vector<SharedResidual> shared_residuals(const FittedModel& fitted) {
  std::vector<SharedResidual> out;
  const Linearisation& linear = fitted.fit.linear;
  for (std::size_t i = 0; i < linear.observations.size(); ++i)
    for (std::size_t j = i + 1; j < linear.observations.size(); ++j)
      if (auto found = shared(linear, i, j)) out.push_back(*std::move(found));
  for (SharedResidual& each : out)
    each.significant =
        each.p_value * static_cast<double>(out.size()) <= fitted.model.gates.significance;
  return out;
}

void name_instrument(const Gates& gates, TraceResult& out) {
  TraceRound round;
  round.accepted = kInstrument;
  const bool is_certain = std::ranges::any_of(out.instrument, &SharedResidual::significant);
  if (!is_certain) round.ambiguous_with.emplace_back(kUnnamedRival);
  for (const SharedResidual& each : out.instrument) {
    const double p_value = each.p_value * static_cast<double>(out.instrument.size());
    if (is_certain ? !each.significant : p_value > gates.instrument_doubt) continue;
    std::ranges::copy(each.profiles, std::back_inserter(round.profiles));
    round.p_value = std::min(round.p_value, each.p_value);
  }
  if (round.profiles.empty()) return;
  std::ranges::sort(round.profiles);
  round.profiles.erase(std::unique(round.profiles.begin(), round.profiles.end()),
                       round.profiles.end());
  for (TraceRound& other : out.rounds)
    if (other.profiles.empty() ||
        std::ranges::find_first_of(other.profiles, round.profiles) != other.profiles.end())
      other.ambiguous_with.emplace_back(kInstrument);
  out.advice.insert(out.advice.begin(),
                    "profiles " + joined(round.profiles, ", ") +
                        " are of different surfaces and share a residual: " +
                        (is_certain ? "an error" : "probably an error") +
                        " of the instrument, not of the slide; turn the instrument or the part by "
                        "180°, and read again");
  out.rounds.push_back(std::move(round));
}

}  // namespace slideway
