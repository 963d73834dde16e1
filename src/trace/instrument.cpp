#include "instrument.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>

#include "process.hpp"
#include "slideway/base/distribution.hpp"
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

/// The residual of a reading along the slide, in mm or rad.
struct Curve {
  const Profile* profile;
  std::vector<double> positions;
  Eigen::VectorXd values;
  Eigen::Index taken = 0;  // coefficients that the model takes, beside the mean

  Curve(const Linearisation& linear, std::size_t i)
      : profile(linear.observations[i]->profile),
        positions(
            linear.observations[i]->low_band.positions(linear.observations[i]->profile->positions)),
        values(linear.residuals[i] / low_band_scale(*linear.observations[i])) {
    const Observation& observation = *linear.observations[i];
    const Eigen::Index levelling = std::ssize(observation.nuisance_names);
    Eigen::MatrixXd span(values.size(), levelling + linear.columns[i].cols());
    span << observation.nuisances.leftCols(levelling), linear.columns[i];
    const Eigen::MatrixXd basis = orthonormal(std::move(span));
    project_out(basis, values);  // weights of the fit move a line
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

/// The curves side by side, at as many places of their common travel as the one with fewest values
/// has there.
Eigen::MatrixXd on_one_grid(const std::vector<const Curve*>& curves) {
  double low = -INFINITY, high = INFINITY;
  for (const Curve* curve : curves) {
    low = std::max(low, curve->positions.front());
    high = std::min(high, curve->positions.back());
  }
  if (!(high > low)) return Eigen::MatrixXd(0, std::ssize(curves));
  std::ptrdiff_t count = std::numeric_limits<std::ptrdiff_t>::max();
  for (const Curve* curve : curves)
    count = std::min(count, std::ranges::upper_bound(curve->positions, high) -
                                std::ranges::lower_bound(curve->positions, low));
  count = std::max<std::ptrdiff_t>(count, 0);
  Eigen::MatrixXd out(count, std::ssize(curves));
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const double x =
        low + (high - low) * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    for (std::size_t c = 0; c < curves.size(); ++c)
      out(i, static_cast<Eigen::Index>(c)) = curves[c]->at(x);
  }
  return out;
}

/// Their cosine coefficients beyond those that the model takes; none where there are too few.
Eigen::MatrixXd coefficients(const Eigen::MatrixXd& grid, const std::vector<const Curve*>& curves) {
  Eigen::Index taken = 0;
  for (const Curve* curve : curves) taken = std::max(taken, curve->taken);
  const Eigen::Index count = std::min<Eigen::Index>(grid.rows() / 2, kSharedCosines) - taken;
  if (count < kFirstOctave) return Eigen::MatrixXd(0, grid.cols());
  return slow_cosines(grid.rows(), taken + count).rightCols(count).transpose() * grid;
}

/// Calls use(first, count) for each octave of so many coefficients.
template <typename Use>
void for_each_octave(Eigen::Index coefficients, const Use& use) {
  for (Eigen::Index first = 0, width = kFirstOctave; first + kFirstOctave <= coefficients;
       first += width, width *= 2)
    use(first, std::min(width, coefficients - first));
}

double correlation(const Eigen::Ref<const Eigen::VectorXd>& a,
                   const Eigen::Ref<const Eigen::VectorXd>& b) {
  const double norm = a.norm() * b.norm();
  return norm > 0.0 ? a.dot(b) / norm : 0.0;
}

double statistic(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  double out = 0.0;
  for_each_octave(a.size(), [&](Eigen::Index first, Eigen::Index count) {
    const double r = correlation(a.segment(first, count), b.segment(first, count));
    if (r > 0.0)
      out -= 0.5 * static_cast<double>(count) * std::log1p(-std::min(r * r, 1.0 - 1e-12));
  });
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
  return key(a) == key(b);
}

bool of_two_surfaces(const Curve& a, const Curve& b) {
  return is_one_instrument(*a.profile, *b.profile) && a.profile->surface != b.profile->surface;
}

std::optional<SharedResidual> shared(const Curve& a, const Curve& b) {
  const Eigen::MatrixXd grid = on_one_grid({&a, &b});
  const Eigen::MatrixXd cosines = coefficients(grid, {&a, &b});
  if (cosines.rows() == 0) return std::nullopt;
  SharedResidual out{{a.profile->name, b.profile->name}, correlation(grid.col(0), grid.col(1))};
  out.p_value = probability(statistic(cosines.col(0), cosines.col(1)), cosines.rows());
  const double rms =
      std::sqrt(std::max(0.0, grid.col(0).dot(grid.col(1))) / static_cast<double>(grid.rows()));
  if (a.profile->setup.quantity == Quantity::height)
    out.rms_um = rms / kMicrometre;
  else
    out.rms_urad = rms / kMicroradian;
  return out;
}

/// Probability that so little of what a and b share is in c by chance.
double p_lacked(const Curve& a, const Curve& b, const Curve& c) {
  const Eigen::MatrixXd cosines = coefficients(on_one_grid({&a, &b, &c}), {&a, &b, &c});
  double sum = 0.0, squares = 0.0, n = 0.0;
  for_each_octave(cosines.rows(), [&](Eigen::Index first, Eigen::Index count) {
    const Eigen::MatrixXd part = cosines.middleRows(first, count);
    const Eigen::VectorXd mean = 0.5 * (part.col(0) + part.col(1));
    const double size = part.col(0).norm() * part.col(1).norm() + part.col(2).norm() * mean.norm();
    if (!(size > 0.0)) return;
    const Eigen::VectorXd missing =
        (part.col(2).cwiseProduct(mean) - part.col(0).cwiseProduct(part.col(1))) *
        (static_cast<double>(count) / size);
    sum += missing.sum();
    squares += missing.squaredNorm();
    n += static_cast<double>(count);
  });
  const double left = n * squares - sum * sum;  // of their variance, times n²
  return left > 0.0 ? student_tail(n - 1.0, -sum * std::sqrt((n - 1.0) / left)) : 1.0;
}

/// The further surfaces that lack what two share.
std::vector<std::string> lacking(const std::vector<Curve>& curves, const Curve& a, const Curve& b,
                                 double doubt) {
  std::vector<std::pair<std::string, double>> further;
  for (const Curve& c : curves)
    if (of_two_surfaces(a, c) && of_two_surfaces(b, c))
      further.emplace_back(c.profile->name, p_lacked(a, b, c));
  std::vector<std::string> out;
  for (const auto& [name, p] : further)
    if (p * static_cast<double>(further.size()) <= doubt) out.push_back(name);
  return out;
}

}  // namespace

std::vector<SharedResidual> shared_residuals(const FittedModel& fitted) {
  const Linearisation& linear = fitted.fit.linear;
  const Gates& gates = fitted.model.gates;
  std::vector<Curve> curves;
  for (std::size_t i = 0; i < linear.observations.size(); ++i) {
    const Profile& profile = *linear.observations[i]->profile;
    if (profile.setup.kind == Kind::slide && profile.surface) curves.emplace_back(linear, i);
  }
  std::vector<SharedResidual> out;
  std::vector<std::pair<const Curve*, const Curve*>> pairs;
  for (std::size_t i = 0; i < curves.size(); ++i)
    for (std::size_t j = i + 1; j < curves.size(); ++j) {
      if (!of_two_surfaces(curves[i], curves[j])) continue;
      if (auto found = shared(curves[i], curves[j])) {
        out.push_back(*std::move(found));
        pairs.emplace_back(&curves[i], &curves[j]);
      }
    }
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k].significant = out[k].p_value * static_cast<double>(out.size()) <= gates.significance;
    if (out[k].significant)
      out[k].lacked_by = lacking(curves, *pairs[k].first, *pairs[k].second, gates.instrument_doubt);
  }
  return out;
}

void name_instrument(const Gates& gates, TraceResult& out) {
  TraceRound round;
  round.accepted = kInstrument;
  const auto in_all = [](const SharedResidual& each) {
    return each.significant && each.lacked_by.empty();
  };
  const bool is_certain = std::ranges::any_of(out.instrument, in_all);
  if (!is_certain) round.ambiguous_with.emplace_back(kUnnamedRival);
  std::set<std::string> profiles, without;
  for (const SharedResidual& each : out.instrument) {
    const double p_value = each.p_value * static_cast<double>(out.instrument.size());
    if (is_certain ? !in_all(each) : p_value > gates.instrument_doubt) continue;
    profiles.insert(each.profiles.begin(), each.profiles.end());
    without.insert(each.lacked_by.begin(), each.lacked_by.end());
    round.p_value = std::min(round.p_value, each.p_value);
  }
  if (profiles.empty()) return;
  round.profiles.assign(profiles.begin(), profiles.end());
  for (TraceRound& other : out.rounds)
    if (other.profiles.empty() ||
        std::ranges::find_first_of(other.profiles, round.profiles) != other.profiles.end())
      other.ambiguous_with.emplace_back(kInstrument);
  out.advice.insert(
      out.advice.begin(),
      "profiles " + joined(round.profiles, ", ") +
          " are of different surfaces and share a residual" +
          (without.empty()
               ? ""
               : ", which " +
                     joined(std::vector<std::string>(without.begin(), without.end()), ", ") +
                     " lacks") +
          ": " + (is_certain ? "an error" : "probably an error") +
          " of the instrument, not of the slide; turn the instrument or the part by "
          "180°, and read again");
  out.rounds.push_back(std::move(round));
}

}  // namespace slideway
