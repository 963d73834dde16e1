#include "slideway/profile/closure.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Dense>

#include "closure_net.hpp"
#include "outlier_level.hpp"
#include "slideway/base/distribution.hpp"
#include "slideway/base/statistics.hpp"

namespace slideway {
namespace {

constexpr std::size_t kShortLine = 200;  // stations; shorter lines are pooled
constexpr std::size_t kFewest = 8;       // second differences that tell a scatter
constexpr double kEffective = 0.2;  // degrees of freedom of a MAD of second differences, of each
constexpr double kKnown = 1e6;      // degrees of freedom
constexpr std::size_t kFar = 8;
constexpr double kGrows = 1.19;  // scatter from next to far; 1 if white, √8 of a random walk
constexpr double kEqual = 1e-6;
constexpr double kUnchecked = 1e-6;  // share of an error that shows

// Errors of one line's readings, mm.
struct Noise {
  double white = 0.0;    // of each station
  double walk = 0.0;     // that each station adds
  double bend = 0.0;     // of a station less the middle of its neighbours
  double freedom = 0.0;  // 0: not known
};

// How stations miss the middle of their neighbours: absolute values about each line's median.
struct Scatter {
  std::vector<double> near, far;  // of the next ones, and of those kFar stations away
  double smallest = INFINITY;     // that is not 0: what rounding makes
  double largest = 0.0;           // value
};

void append_bends(const std::vector<double>& z, std::size_t lag, std::vector<double>& all) {
  std::vector<double> own = bends(z, lag);
  if (own.empty()) return;
  const double middle = median(own);
  for (const double each : own) all.push_back(std::abs(each - middle));
}

void add_scatter(const std::vector<double>& z, Scatter& scatter) {
  append_bends(z, 1, scatter.near);
  append_bends(z, kFar, scatter.far);
  for (const double value : z) scatter.largest = std::max(scatter.largest, std::abs(value));
  for (const double bend : scatter.near)
    if (bend > 0.0) scatter.smallest = std::min(scatter.smallest, bend);
}

double scale_of(const Scatter& scatter) {
  std::vector<double> near = scatter.near;
  const double rounding = std::isfinite(scatter.smallest) ? scatter.smallest : 0.0;
  return std::max({kMad * median(near), rounding, 1e-9 * scatter.largest, 1e-12});
}

Noise noise_of(const HeightLine& line, const Scatter& scatter) {
  const Profile& profile = *line.profile;
  const bool slope = profile.setup.quantity == Quantity::slope;
  const double station = slope ? line.step * (profile.setup.last_mm - profile.setup.first_mm +
                                              profile.setup.base_mm.value_or(0.0))
                               : 1.0;
  Noise out;
  if (profile.standard_uncertainty) {
    (slope ? out.walk : out.white) = station * *profile.standard_uncertainty;
    out.bend = slope ? out.walk * std::sqrt(0.5) : out.white * std::sqrt(1.5);
    out.freedom = kKnown;
    return out;
  }
  if (scatter.near.size() < kFewest) return {0.0, 1.0, 1.0, 0.0};
  const double scale = scale_of(scatter);
  out.freedom = kEffective * static_cast<double>(scatter.near.size());
  if (slope) {
    out.walk = station * scale / std::sqrt(1.5);
    out.bend = out.walk * std::sqrt(0.5);
    return out;
  }
  out.bend = scale;
  std::vector<double> far = scatter.far;
  if (profile.values.size() < kShortLine || kMad * median(far) > kGrows * scale)
    out.walk = std::sqrt(2.0) * scale;
  else
    out.white = scale / std::sqrt(1.5);
  return out;
}

std::vector<Noise> noises_of(const std::vector<HeightLine>& lines) {
  std::map<Quantity, Scatter> pooled;
  for (const HeightLine& line : lines)
    if (line.profile->values.size() < kShortLine)
      add_scatter(line.profile->values, pooled[line.profile->setup.quantity]);
  std::vector<Noise> out;
  for (const HeightLine& line : lines) {
    if (line.profile->values.size() < kShortLine) {
      out.push_back(noise_of(line, pooled[line.profile->setup.quantity]));
      continue;
    }
    Scatter own;
    add_scatter(line.profile->values, own);
    out.push_back(noise_of(line, own));
  }
  return out;
}

struct Adjusted {
  std::size_t redundancy = 0;
  Eigen::VectorXd size, uncertainty;  // by reading; NaN where nothing checks it
  [[nodiscard]] double largest() const {
    double out = 0.0;
    for (Eigen::Index i = 0; i < size.size(); ++i)
      if (std::isfinite(size[i])) out = std::max(out, std::abs(size[i]) / uncertainty[i]);
    return out;
  }
};

class Adjustment {
 public:
  Adjustment(const ClosureNet& net, const std::vector<Noise>& noises)
      : net_(&net), whitening_(Eigen::MatrixXd::Zero(count(), count())), variance_(count()) {
    for (std::size_t line = 0; line < net.lines.size(); ++line) whiten(line, noises[line]);
  }

  // `without` one line, or with all if there is none of that number.
  [[nodiscard]] Adjusted solve(std::size_t without) const {
    const Eigen::Index n = count();
    const auto places = static_cast<Eigen::Index>(net_->places.size());
    const auto lines = static_cast<Eigen::Index>(net_->lines.size());
    Eigen::MatrixXd design = Eigen::MatrixXd::Zero(n, places + 2 * lines);
    Eigen::VectorXd heights(n), kept = Eigen::VectorXd::Ones(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Reading& reading = net_->readings[i];
      const auto line = static_cast<Eigen::Index>(reading.line);
      heights[i] = reading.height.value;
      if (reading.line == without) {
        kept[i] = 0.0;
        continue;
      }
      design(i, static_cast<Eigen::Index>(reading.place)) = 1.0;
      design(i, places + 2 * line) = 1.0;
      design(i, places + 2 * line + 1) = 2.0 * reading.t - 1.0;
    }
    const Eigen::MatrixXd whitening = kept.asDiagonal() * whitening_;
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(whitening * design);
    qr.setThreshold(1e-9);
    const Eigen::MatrixXd all = qr.householderQ();
    const Eigen::MatrixXd known = all.leftCols(qr.rank()).transpose() * whitening;
    const Eigen::MatrixXd weights = whitening.transpose() * whitening - known.transpose() * known;
    Adjusted out;
    out.redundancy = static_cast<std::size_t>(kept.sum()) - static_cast<std::size_t>(qr.rank());
    out.uncertainty = out.size = Eigen::VectorXd::Constant(n, NAN);
    const Eigen::VectorXd misfit = weights * heights;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (kept[i] == 0.0 || weights(i, i) * variance_[i] <= kUnchecked) continue;
      out.size[i] = misfit[i] / weights(i, i);
      out.uncertainty[i] = 1.0 / std::sqrt(weights(i, i));
    }
    return out;
  }

 private:
  [[nodiscard]] Eigen::Index count() const {
    return static_cast<Eigen::Index>(net_->readings.size());
  }

  void whiten(std::size_t line, const Noise& noise) {
    std::vector<Eigen::Index> rows;
    for (Eigen::Index i = 0; i < count(); ++i)
      if (net_->readings[i].line == line) rows.push_back(i);
    const auto n = std::ssize(rows);
    if (n == 0) return;
    Eigen::MatrixXd covariance(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j) {
        const Reading &a = net_->readings[rows[i]], &b = net_->readings[rows[j]];
        const double stations = 1.0 + std::min(a.t, b.t) / net_->lines[line].step;
        covariance(i, j) = noise.walk * noise.walk * stations;
        if (i == j)
          covariance(i, i) += std::pow(noise.white, 2) + std::pow(a.height.bends * noise.bend, 2);
      }
    for (Eigen::Index i = 0; i < n; ++i) variance_[rows[i]] = covariance(i, i);
    const Eigen::MatrixXd inverse =
        covariance.llt().matrixL().solve(Eigen::MatrixXd::Identity(n, n));
    whitening_(rows, rows) = inverse;
  }

  const ClosureNet* net_;
  Eigen::MatrixXd whitening_;
  Eigen::VectorXd variance_;
};

// What the largest of so many correlated ratios reaches by chance: Bonferroni's bound, or Scheffé's
// for all combinations of the closures, which is less where few readings are independent.
double limit_of(double readings, double redundancy, double freedom) {
  const double each = student_limit(freedom, 0.5 * kClosureFalseAlarm / readings);
  const double all = fisher_limit(redundancy, freedom, kClosureFalseAlarm);
  return std::min(each, std::sqrt(redundancy * all));
}

// Each reading less the mean of the others at its place, where all are heights.
std::optional<double> difference(const ClosureNet& net, std::size_t reading) {
  if (net.tied) return 0.0;
  double sum = 0.0, others = 0.0;
  for (std::size_t i = 0; i < net.readings.size(); ++i) {
    const Reading& other = net.readings[i];
    if (other.place != net.readings[reading].place) continue;
    if (net.lines[other.line].profile->setup.quantity == Quantity::slope) return std::nullopt;
    if (i == reading) continue;
    sum += other.height.value;
    others += 1.0;
  }
  return net.readings[reading].height.value - sum / others;
}

void judge(const ClosureNet& net, const std::vector<Noise>& noises, Closure& out) {
  const Adjustment adjustment(net, noises);
  const Adjusted all = adjustment.solve(net.lines.size());
  out.redundancy = all.redundancy;
  if (all.redundancy == 0) return;
  double freedom = kKnown;
  for (const Noise& noise : noises) freedom = std::min(freedom, noise.freedom);
  for (std::size_t i = 0; i < net.readings.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    if (!std::isfinite(all.size[at])) continue;
    out.readings[i].size = all.size[at];
    if (freedom > 0.0) out.readings[i].standard_uncertainty = all.uncertainty[at];
  }
  if (freedom == 0.0) return;
  const auto readings = static_cast<double>(net.readings.size());
  out.limit = limit_of(readings, static_cast<double>(all.redundancy), freedom);
  if (all.largest() <= *out.limit) return;
  for (std::size_t i = 0; i < net.readings.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const bool largest =
        std::abs(all.size[at]) >= (1.0 - kEqual) * all.largest() * all.uncertainty[at];
    if (largest &&
        (!out.worst || all.uncertainty[at] <
                           (1.0 - kEqual) * all.uncertainty[static_cast<Eigen::Index>(*out.worst)]))
      out.worst = i;
  }
  for (std::size_t line = 0; line < net.lines.size(); ++line)
    if (adjustment.solve(line).largest() <= *out.limit)
      out.suspects.push_back(net.lines[line].index);
}

}  // namespace

std::optional<Closure> close_lines(const std::vector<Profile>& profiles) {
  const auto lies = [](const Profile& profile) { return profile.line.has_value(); };
  if (std::ranges::count_if(profiles, lies) < 2) return std::nullopt;
  const ClosureNet net = closure_net(profiles);
  Closure out;
  out.lines = net.lines.size();
  out.tied = net.tied;
  out.notes = net.notes;
  for (std::size_t i = 0; i < net.readings.size(); ++i) {
    const Reading& reading = net.readings[i];
    out.places += i == 0 || reading.place != net.readings[i - 1].place ? 1 : 0;
    out.readings.push_back({net.lines[reading.line].index, net.places[reading.place],
                            difference(net, i), std::nullopt, std::nullopt});
  }
  out.repeats = repeats(net);
  if (!net.readings.empty()) judge(net, noises_of(net.lines), out);
  return out;
}

}  // namespace slideway
