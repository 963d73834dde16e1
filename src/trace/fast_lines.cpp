#include "fast_lines.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <optional>

#include "modulation.hpp"
#include "sample_residuals.hpp"
#include "slideway/base/units.hpp"
#include "slideway/identify/low_band_lines.hpp"
#include "slideway/signal/spectrum.hpp"

namespace slideway {
namespace {

constexpr std::size_t kMostLines = 4;             // of a profile
constexpr int kOfOwn = 3, kNear = 12, kFar = 64;  // cycles to either side of a line
constexpr Eigen::Index kFewestSamples = 4 * kFar;
constexpr double kHannWidth = 1.5;  // cycles, of noise
// Of the median of an exponential distribution, over that of its mean: 1 / ln² 2.
constexpr double kVarianceOfMedian = 2.08;
// How far off the rate of a line may be, cycles: the halves of a diameter may cancel each other
// there.
constexpr double kRateReach = 1.5;
constexpr Eigen::Index kMostShapes = 256;  // about one line
constexpr double kSameRate = 1e-6;         // of a rate: what rounding leaves

/// Power of a levelled signal under a Hann window, at `per_cycle` places a cycle over the trace.
struct Periodogram {
  std::vector<double> power;
  double per_cycle;

  explicit Periodogram(const Eigen::VectorXd& signal) {
    const auto n = static_cast<std::size_t>(signal.size());
    std::vector<double> padded(2 * std::bit_ceil(n), 0.0);
    for (std::size_t i = 0; i < n; ++i)
      padded[i] =
          signal[static_cast<Eigen::Index>(i)] *
          (1.0 - std::cos(2.0 * kPi * (static_cast<double>(i) + 0.5) / static_cast<double>(n)));
    power = power_spectrum(padded);
    per_cycle = static_cast<double>(padded.size()) / static_cast<double>(n);
  }

  /// Logarithm of the probability that noise stands out as much at a place, beside what is near it
  /// and beside what is further off: a vibration that loses its phase is a hump. The larger one.
  [[nodiscard]] double chance(std::size_t at) const {
    return std::max(chance_within(at, kNear), chance_within(at, kFar));
  }

 private:
  /// Of an F distribution of 2 and 2 m degrees of freedom: ln 2 of the mean of an exponential is
  /// its median.
  [[nodiscard]] double chance_within(std::size_t at, int cycles) const {
    std::vector<double> beside;
    const auto own = static_cast<std::ptrdiff_t>(kOfOwn * per_cycle),
               far = static_cast<std::ptrdiff_t>(cycles * per_cycle);
    for (std::ptrdiff_t d = -far; d <= far; ++d) {
      const std::ptrdiff_t k = static_cast<std::ptrdiff_t>(at) + d;
      if (std::abs(d) > own && k >= 0 && k < std::ssize(power))
        beside.push_back(power[static_cast<std::size_t>(k)]);
    }
    const double m = static_cast<double>(beside.size()) /
                     (per_cycle * kHannWidth * kVarianceOfMedian);  // independent places
    const auto middle = beside.begin() + std::ssize(beside) / 2;
    std::ranges::nth_element(beside, middle);
    const double mean = *middle / std::numbers::ln2;
    return mean > 0.0 ? -m * std::log1p(power[at] / (mean * m)) : 0.0;
  }
};

/// Cycles over a trace beyond which a wave may be the image of a slower one: a face has one groove
/// a turn, and a trace a sample a step. 0: those of the grooves are not known, or closer than
/// samples.
double fastest_shown(const Profile& profile) {
  const Setup& setup = profile.setup;
  const double samples = 0.5 * static_cast<double>(profile.positions.size());
  if (setup.kind != Kind::face) return samples;
  const std::optional<double> feed = setup.feed_per_revolution();
  const double grooves = feed ? 0.5 * (setup.last_mm - setup.first_mm) / *feed : 0.0;
  return grooves < samples ? grooves : 0.0;
}

struct Peak {
  double cycles, chance;
};

std::vector<Peak> peaks_of(const Periodogram& spectrum, double from_cycles, double to_cycles,
                           double significance) {
  const std::vector<double>& power = spectrum.power;
  const auto first = static_cast<std::size_t>(from_cycles * spectrum.per_cycle) + 1;
  std::vector<Peak> out;
  if (first + 1 >= power.size()) return out;
  const auto places = static_cast<double>(power.size() - first);
  const auto last = static_cast<std::size_t>(to_cycles * spectrum.per_cycle);
  for (std::size_t k = first; k <= last && k + 1 < power.size(); ++k) {
    if (!(power[k] > power[k - 1] && power[k] >= power[k + 1])) continue;
    const double chance = spectrum.chance(k);
    if (chance < std::log(significance / places))
      out.push_back({static_cast<double>(k) / spectrum.per_cycle, chance});
  }
  std::ranges::stable_sort(out, {}, &Peak::chance);
  return out;
}

/// Rate of the one line of an effect over the independent variable, or none.
std::optional<double> rate_of(const Effect& effect, const Stations& stations, double shape) {
  const std::vector<LineBand> lines = effect.lines(stations, std::array{shape});
  if (lines.size() != 1 || lines[0].low != lines[0].high || !(lines[0].low > 0.0))
    return std::nullopt;
  return lines[0].low;
}

/// The shape at which an effect of one rate, which goes with the shape or with its inverse, has a
/// line.
std::optional<double> shape_at(const Effect& effect, const Setup& setup, const Stations& stations,
                               double cycles) {
  const Parameter& parameter = effect.parameters()[effect.shapes()[0].parameter];
  const double shape = parameter.scale;
  const std::optional<double> rate = rate_of(effect, stations, shape);
  if (!rate) return std::nullopt;
  const double per_line = cycles_along(setup, effect, {1.0, 1.0});
  const double factor = cycles / (*rate * per_line);
  for (const double out : {shape * factor, shape / factor}) {
    const std::optional<double> there = rate_of(effect, stations, out);
    if (out >= parameter.lower && out <= parameter.upper && there &&
        std::abs(*there * per_line - cycles) < kSameRate * cycles)
      return out;
  }
  return std::nullopt;
}

}  // namespace

std::vector<FastLine> fast_lines(const Model& model, const Solution& fit) {
  const SampleResiduals samples(model, fit);
  std::vector<FastLine> out;
  for (const SampleResiduals::Trace& trace : samples.traces()) {
    if (trace.low_band->resampled() || trace.residual.size() < kFewestSamples) continue;
    const double slowest =
        static_cast<double>(trace.low_band->values() - 1) / model.gates.values_per_cycle;
    const double fastest = fastest_shown(*trace.profile);
    if (fastest <= slowest) continue;
    std::vector<FastLine> own;
    for (const Peak& peak :
         peaks_of(Periodogram(trace.residual), slowest, fastest, model.gates.significance)) {
      const bool is_known = std::ranges::any_of(own, [&](const FastLine& other) {
        return std::abs(other.cycles - peak.cycles) < kOfOwn;
      });
      if (is_known || mark_at(*trace.profile, peak.cycles, model.gates)) continue;
      own.push_back({trace.profile, peak.cycles});
      if (own.size() == kMostLines) break;
    }
    std::ranges::move(own, std::back_inserter(out));
  }
  return out;
}

std::vector<ShapeLattice> shapes_of_lines(const Model& model, const ModelTerm& term,
                                          const std::vector<FastLine>& lines) {
  const Effect& effect = *term.effect;
  std::vector<ShapeLattice> out;
  if (effect.shapes().size() != 1 || effect.description().kinematic) return out;
  std::vector<Stations> stations;
  for (const Observation* each : fitted_observations(model))
    if (term.acts_on(*each->profile) && effect.applies_to(each->profile->setup))
      stations.push_back(each->profile->stations(model.machine));
  for (const FastLine& line : lines) {
    const Setup& setup = line.profile->setup;
    if (!term.acts_on(*line.profile) || !effect.applies_to(setup)) continue;
    const Stations own = line.profile->stations(model.machine);
    const auto from = shape_at(effect, setup, own, line.cycles - kRateReach),
               to = shape_at(effect, setup, own, line.cycles + kRateReach);
    if (!from || !to) continue;
    std::vector<double> axis;
    double value = std::min(*from, *to);
    const double last = std::max(*from, *to);
    for (Eigen::Index i = 0; value <= last && i < kMostShapes; ++i) {
      axis.push_back(value);
      double step = INFINITY;
      for (const Stations& each : stations)
        step = std::min(step, effect.resolution(0, value, each));
      if (!(step > 0.0)) break;
      value += step;
    }
    const bool is_known = std::ranges::any_of(out, [&](const ShapeLattice& other) {
      return axis.front() <= other.axes()[0].back() && axis.back() >= other.axes()[0].front();
    });
    if (!is_known) out.push_back(ShapeLattice({axis}));
  }
  return out;
}

}  // namespace slideway
