#include "local_trend.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "slideway/base/distribution.hpp"
#include "slideway/base/statistics.hpp"

namespace slideway {
namespace {

constexpr double kDiffuse = 1e8;  // variance of the start and of a shift, in those of a reading
constexpr int kLevels[] = {-4, 4}, kSlopes[] = {-11, 3};  // decades of the ratios
constexpr int kMostScans = 6;
constexpr double kFalseJump = 0.01;     // chance of one in a log without any
constexpr double kPlain = 6.0;          // standard deviations of most steps
constexpr double kBesidePlain = 0.25;   // of a plain jump: the steps beside it
constexpr std::size_t kMostJumps = 32;  // whose own errors are kept
constexpr int kJumpScans = 5;

/// Level and slope with their covariance, in variances of a reading.
struct State {
  Eigen::Vector2d mean{0.0, 0.0};
  Eigen::Matrix2d covariance{{kDiffuse, 0.0}, {0.0, kDiffuse}};
};

Eigen::Matrix2d transition(double step) { return Eigen::Matrix2d{{1.0, step}, {0.0, 1.0}}; }

/// Variance that shifts add between two places.
double shifted(const std::vector<LocalTrend::Jump>& shifts, double from, double to) {
  double out = 0.0;
  for (auto shift = std::ranges::upper_bound(shifts, from, {}, &LocalTrend::Jump::to);
       shift != shifts.end() && shift->from < to; ++shift)
    out += kDiffuse * (std::min(to, shift->to) - std::max(from, shift->from)) /
           (shift->to - shift->from);
  return out;
}

/// Whether what comes behind says nothing of what was before.
bool is_diffuse(const LocalTrend& trend, double from, double to) {
  return shifted(trend.jumps, from, to) > 0.0 || shifted(trend.kinks, from, to) > 0.0;
}

/// What walks and shifts add between two places.
Eigen::Matrix2d walked(const LocalTrend& trend, double from, double to) {
  const double step = (to - from) / trend.spacing,
               slope = trend.slope * step + shifted(trend.kinks, from, to);
  return Eigen::Matrix2d{
      {trend.level * step + slope * step * step / 3.0 + shifted(trend.jumps, from, to),
       slope * step / 2.0},
      {slope * step / 2.0, slope}};
}

State predicted(const LocalTrend& trend, const State& before, double from, double to) {
  const Eigen::Matrix2d f = transition((to - from) / trend.spacing);
  return {f * before.mean, f * before.covariance * f.transpose() + walked(trend, from, to)};
}

/// Of a reading before it is known: its error and the variance of that.
struct Innovation {
  double error = 0.0, variance = 1.0;
};

Innovation update(State& state, double reading) {
  const Innovation out{reading - state.mean[0], state.covariance(0, 0) + 1.0};
  const Eigen::Vector2d gain = state.covariance.col(0) / out.variance;
  state.mean += gain * out.error;
  state.covariance -= out.variance * gain * gain.transpose();
  return out;
}

/// Minus twice the restricted log likelihood, and the noise at its best.
struct Deviance {
  double value = INFINITY, noise = 0.0;
};

Deviance deviance_of(const LocalTrend& trend, std::span<const double> at,
                     std::span<const double> readings) {
  State state;
  state.mean[0] = readings[0];
  double squares = 0.0, logs = 0.0, freedom = 0.0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (i > 0) state = predicted(trend, state, at[i - 1], at[i]);
    const Innovation innovation = update(state, readings[i]);
    if (i < 2 || is_diffuse(trend, at[i - 1], at[i])) continue;
    ++freedom;
    squares += innovation.error * innovation.error / innovation.variance;
    logs += std::log(innovation.variance);
  }
  const double variance = squares / freedom;
  if (!(variance > 0.0)) return {-INFINITY, 0.0};
  return {freedom * std::log(variance) + logs, std::sqrt(variance)};
}

/// How large the shift between a reading and the one before it would have to be, in its standard
/// deviation: of the level, and of the slope.
struct Shift {
  double level = 0.0, slope = 0.0;
};

std::vector<Shift> shifts_of(const LocalTrend& trend, std::span<const double> at,
                             std::span<const double> readings) {
  const std::size_t n = at.size();
  struct Step {
    Innovation innovation;
    Eigen::Vector2d gain{0.0, 0.0};
  };
  std::vector<Step> steps(n);
  State state;
  state.mean[0] = readings[0];
  for (std::size_t i = 0; i < n; ++i) {
    if (i > 0) state = predicted(trend, state, at[i - 1], at[i]);
    const Eigen::Vector2d covariance = state.covariance.col(0);
    steps[i].innovation = update(state, readings[i]);
    steps[i].gain = covariance / steps[i].innovation.variance;
  }
  std::vector<Shift> out(n);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();  // of the innovations from here on, weighted
  Eigen::Matrix2d variance = Eigen::Matrix2d::Zero();
  for (std::size_t i = n; i-- > 1;) {
    Eigen::Matrix2d keep = Eigen::Matrix2d::Identity();  // what the reading leaves of the state
    keep.col(0) -= steps[i].gain;
    const Innovation& innovation = steps[i].innovation;
    sum = keep.transpose() * sum + Eigen::Vector2d(innovation.error / innovation.variance, 0.0);
    variance = (keep.transpose() * variance * keep).eval();
    variance(0, 0) += 1.0 / innovation.variance;
    out[i] = {sum[0] / (trend.noise * std::sqrt(variance(0, 0))),
              variance(1, 1) > 0.0 ? sum[1] / (trend.noise * std::sqrt(variance(1, 1))) : 0.0};
    const Eigen::Matrix2d f = transition((at[i] - at[i - 1]) / trend.spacing);
    sum = f.transpose() * sum;
    variance = (f.transpose() * variance * f).eval();
  }
  return out;
}

/// The ratios of most likelihood on a grid of decades, then of half ones, one ratio at a time.
class Search {
 public:
  Search(std::span<const double> at, std::span<const double> readings)
      : at_(at), readings_(readings) {
    best_.spacing = (at.back() - at.front()) / static_cast<double>(at.size() - 1);
    best_.jumps = plain_jumps(at, readings);
  }

  LocalTrend best() {
    least_ = deviance_of(best_, at_, readings_);
    scan(&LocalTrend::slope, kSlopes);
    const LocalTrend smooth = best_;
    const Deviance of_smooth = least_;
    best_.slope = 0.0;
    least_ = deviance_of(best_, at_, readings_);
    scan(&LocalTrend::level, kLevels);
    if (of_smooth.value <= least_.value) best_ = smooth, least_ = of_smooth;
    for (int i = 0; i < kMostScans; ++i) {
      const double before = least_.value;
      scan(&LocalTrend::level, kLevels);
      scan(&LocalTrend::slope, kSlopes);
      if (!(least_.value < before)) break;
    }
    for (double LocalTrend::*ratio : {&LocalTrend::level, &LocalTrend::slope})
      for (const double factor : {std::sqrt(0.1), std::sqrt(10.0)}) {
        LocalTrend tried = best_;
        tried.*ratio *= factor;
        try_out(tried.level, tried.slope);
      }
    best_.noise = least_.noise;
    return best_;
  }

  /// Jumps and kinks; whether there were any to add.
  bool adds_shifts() {
    if (!(best_.noise > 0.0)) return false;
    const std::vector<Shift> shifts = shifts_of(best_, at_, readings_);
    const bool jumps = add(best_.jumps, shifts, &Shift::level, &Shift::slope);
    const bool kinks = add(best_.kinks, shifts, &Shift::slope, &Shift::level);
    return jumps || kinks;
  }

 private:
  /// Where one is too large and larger than the other, the largest of neighbours that are.
  bool add(std::vector<LocalTrend::Jump>& to, const std::vector<Shift>& shifts, double Shift::*of,
           double Shift::*other) const {
    const double large =
        std::sqrt(chi_squared_quantile(1.0, 1.0 - kFalseJump / static_cast<double>(at_.size())));
    const std::size_t before = to.size();
    const auto size = [&](std::size_t i) {
      const bool counts = i < shifts.size() && std::abs(shifts[i].*of) > large &&
                          std::abs(shifts[i].*of) > std::abs(shifts[i].*other) &&
                          !is_diffuse(best_, at_[i - 1], at_[i]);
      return counts ? std::abs(shifts[i].*of) : 0.0;
    };
    for (std::size_t i = 1; i < shifts.size() && to.size() < kMostJumps;) {
      std::size_t largest = i, next = i;
      for (; size(next) > 0.0; ++next)
        if (size(next) > size(largest)) largest = next;
      if (next > i) to.push_back({at_[largest - 1], at_[largest]});
      i = std::max(next, i + 1);
    }
    std::ranges::sort(to, {}, &LocalTrend::Jump::from);
    return to.size() > before;
  }

  void try_out(double level, double slope) {
    LocalTrend tried = best_;
    tried.level = level;
    tried.slope = slope;
    const Deviance found = deviance_of(tried, at_, readings_);
    if (found.value < least_.value) best_ = tried, least_ = found;
  }

  void scan(double LocalTrend::*ratio, const int (&decades)[2]) {
    LocalTrend tried = best_;
    for (int decade = decades[0] - 1; decade <= decades[1]; ++decade) {
      tried.*ratio = decade < decades[0] ? 0.0 : std::pow(10.0, decade);
      try_out(tried.level, tried.slope);
    }
  }

  std::span<const double> at_, readings_;
  LocalTrend best_;
  Deviance least_;
};

}  // namespace

std::vector<LocalTrend::Jump> plain_jumps(std::span<const double> at,
                                          std::span<const double> readings) {
  std::vector<double> steps(readings.size() + 1, 0.0);  // none before the first and after the last
  for (std::size_t i = 1; i < readings.size(); ++i)
    steps[i] = std::abs(readings[i] - readings[i - 1]);
  const double large = kPlain * deviation_of_most(std::span(steps).subspan(1, readings.size() - 1));
  std::vector<LocalTrend::Jump> out;
  for (std::size_t i = 1; i < readings.size() && out.size() < kMostJumps; ++i)
    if (steps[i] > large && std::max(steps[i - 1], steps[i + 1]) < kBesidePlain * steps[i])
      out.push_back({at[i - 1], at[i]});
  return out;
}

LocalTrend LocalTrend::of(std::span<const double> at, std::span<const double> readings) {
  Search search(at, readings);
  LocalTrend out = search.best();
  for (int i = 0; i < kJumpScans && search.adds_shifts(); ++i) out = search.best();
  return out;
}

std::vector<double> LocalTrend::smoothed(std::span<const double> at,
                                         std::span<const double> readings) const {
  const std::size_t n = at.size();
  std::vector<State> before(n), after(n);  // the reading
  for (std::size_t i = 0; i < n; ++i) {
    if (i > 0) before[i] = predicted(*this, after[i - 1], at[i - 1], at[i]);
    after[i] = before[i];
    if (std::isfinite(readings[i])) update(after[i], readings[i]);
  }
  std::vector<double> out(n);
  Eigen::Vector2d mean = after.back().mean;
  out.back() = mean[0];
  for (std::size_t i = n - 1; i-- > 0;) {
    const Eigen::Matrix2d f = transition((at[i + 1] - at[i]) / spacing);
    mean = after[i].mean + after[i].covariance * f.transpose() *
                               before[i + 1].covariance.inverse() * (mean - before[i + 1].mean);
    out[i] = mean[0];
  }
  return out;
}

std::vector<double> LocalTrend::error(std::span<const double> at, std::span<const double> readings,
                                      RandomStream& random) const {
  std::vector<double> truth(at.size()), drawn(at.size(), NAN);
  Eigen::Vector2d state = Eigen::Vector2d::Zero();  // whatever it is: the start is diffuse
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (i > 0) {
      const double step = (at[i] - at[i - 1]) / spacing, u = random.normal(), v = random.normal();
      const double of_slope = noise * std::sqrt(slope * step);
      // ∫ of a walk: its half of the end, and what is independent of that.
      state = transition(step) * state;
      state[0] += noise * std::sqrt(level * step) * random.normal() +
                  of_slope * step * (u / 2.0 + v / std::sqrt(12.0));
      state[1] += of_slope * u;
    }
    truth[i] = state[0];
    const double read = noise * random.normal();
    if (std::isfinite(readings[i])) drawn[i] = truth[i] + read;
  }
  std::vector<double> out = smoothed(at, drawn);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] -= truth[i];
  return out;
}

}  // namespace slideway
