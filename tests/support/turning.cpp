#include "support/turning.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

namespace slideway::turning {
namespace {

constexpr double kTurn = 6.283185307179586;  // 2π

/// Ornstein-Uhlenbeck sequence of unit variance.
class Correlated {
 public:
  double next(double position, double length, RandomStream& random) {
    const double kept =
        started_ && length > 0.0 ? std::exp(-std::abs(position - last_position_) / length) : 0.0;
    value_ = kept * value_ + std::sqrt(1.0 - kept * kept) * random.normal();
    last_position_ = position;
    started_ = true;
    return value_;
  }

 private:
  double value_ = 0.0;
  double last_position_ = 0.0;
  bool started_ = false;
};

/// Adds the noise of a reading to its values and rounds them.
void disturb(std::span<const double> positions, const Noise& noise, RandomStream& random,
             std::vector<double>& values) {
  Correlated correlated;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (noise.white > 0.0) values[i] += noise.white * random.normal();
    if (noise.correlated > 0.0) {
      values[i] += noise.correlated * correlated.next(positions[i], noise.correlation_mm, random);
    }
    if (noise.quantum > 0.0) values[i] = noise.quantum * std::round(values[i] / noise.quantum);
  }
}

/// Where the tool is q revolutions after the cut started.
ToolPoint spiral(const Cut& cut, double feed_mm, double q) {
  ToolPoint tool;
  tool.r = cut.inward ? cut.radius_mm - feed_mm * q : feed_mm * q;
  tool.x = cut.spindle_position_mm + tool.r;
  tool.t = cut.start_s + std::max(q, 0.0) * 60.0 / cut.spindle_rpm;
  tool.k = tool.t * cut.spindle_rpm / 60.0;
  const double disc = tool.r * std::abs(tool.r);
  const double cut_area = cut.inward ? cut.radius_mm * cut.radius_mm - disc : disc;
  tool.s = std::max(0.0, cut_area * kTurn / (2.0 * feed_mm));
  return tool;
}

/// The carriage in a pass along the slide, when its reference stands at `position`.
ToolPoint along_slide(const Pass& pass, std::span<const double> positions, double position) {
  ToolPoint tool;
  tool.r = tool.x = position;
  const double run = pass.outward ? position - positions.front() : positions.back() - position;
  tool.t = pass.start_s + run * 60.0 / pass.feed_mm_per_min;
  tool.k = tool.t * pass.spindle_rpm / 60.0;
  return tool;
}

}  // namespace

double polynomial(std::span<const double> a, double u) {
  double value = 0.0;
  for (std::size_t k = a.size(); k-- > 0;) value = value * u + a[k];
  return value;
}

double derivative(std::span<const double> a, double u) {
  double value = 0.0;
  for (std::size_t k = a.size(); k-- > 1;) value = value * u + static_cast<double>(k) * a[k];
  return value;
}

double one_lever(const Carriage& carriage, const ToolPoint& tool) {
  const double pitch = derivative(carriage.b, tool.x) + derivative(carriage.c, carriage.z_mm);
  return polynomial(carriage.b, tool.x) - (pitch + carriage.squareness) * tool.r;
}

double two_levers(const Carriage& carriage, const ToolPoint& tool) {
  const double pitch = derivative(carriage.b, tool.x) + derivative(carriage.c, carriage.z_mm);
  return polynomial(carriage.b, tool.x) - pitch * carriage.overhang_mm -
         carriage.squareness * tool.r;
}

Error forced_vibration(double amplitude_mm, double hz, double phase) {
  return
      [=](const ToolPoint& tool) { return amplitude_mm * std::cos(kTurn * hz * tool.t + phase); };
}

Error random_vibration(double standard_deviation_mm, double correlation_s, std::uint64_t seed) {
  struct State {
    RandomStream random;
    Correlated correlated;
  };
  auto state = std::make_shared<State>(State{RandomStream(seed, "vibration"), {}});
  return [=](const ToolPoint& tool) {
    return standard_deviation_mm * state->correlated.next(tool.t, correlation_s, state->random);
  };
}

Error sum(std::vector<Error> errors) {
  return [errors = std::move(errors)](const ToolPoint& tool) {
    double total = 0.0;
    for (const Error& error : errors) total += error(tool);
    return total;
  };
}

Face::Face(const Cut& cut, const Error& tool_error)
    : feed_mm_(cut.feed_mm_per_min / cut.spindle_rpm), nose_radius_mm_(cut.nose_radius_mm) {
  const int last = static_cast<int>(std::ceil(cut.radius_mm / feed_mm_)) + 1;
  lowest_ = std::numeric_limits<double>::infinity();
  for (int j = -1; j <= last; ++j) {
    for (const int h : {0, 1}) {
      const ToolPoint tool = spiral(cut, feed_mm_, j + 0.5 * h);
      const double height = tool_error(tool);
      halves_[h].heights.push_back(height);
      if (cut.inward || j == -1) halves_[h].first_r = tool.r;
      lowest_ = std::min(lowest_, height);
    }
  }
  if (cut.inward) {
    for (Half& half : halves_) std::reverse(half.heights.begin(), half.heights.end());
  }
}

double Face::height(double X) const {
  const Half& half = halves_[X < 0.0 ? 1 : 0];
  const double place = (std::abs(X) - half.first_r) / feed_mm_;  // in grooves
  const auto count = static_cast<int>(half.heights.size());
  const int nearest = std::clamp(static_cast<int>(std::lround(place)), 0, count - 1);
  const auto groove = [&](int j) {
    const double d = (place - j) * feed_mm_;
    return d * d / (2.0 * nose_radius_mm_);
  };
  double best = std::numeric_limits<double>::infinity();
  // Grooves further out can win only as long as their flank is below the best by less than the
  // deepest groove of the face.
  for (int j = nearest; j >= 0 && groove(j) + lowest_ < best; --j) {
    best = std::min(best, half.heights[j] + groove(j));
  }
  for (int j = nearest + 1; j < count && groove(j) + lowest_ < best; ++j) {
    best = std::min(best, half.heights[j] + groove(j));
  }
  return best;
}

std::vector<double> trace(const Face& face, std::span<const double> positions, const Stylus& stylus,
                          RandomStream& random) {
  std::vector<double> values;
  values.reserve(positions.size());
  for (const double position : positions) {
    const double X = position - stylus.center_mm;
    const double m = (position - positions.front()) / stylus.traverse_mm_per_s;
    const double datum = stylus.datum ? stylus.datum(X, m) : 0.0;
    values.push_back(face.height(X) + stylus.offset_mm + stylus.tilt * X + datum);
  }
  disturb(positions, stylus.noise, random, values);
  return values;
}

std::vector<double> slide_heights(const Error& error, std::span<const double> positions,
                                  const Pass& pass, RandomStream& random) {
  std::vector<double> values;
  values.reserve(positions.size());
  for (const double position : positions) {
    values.push_back(error(along_slide(pass, positions, position)) + pass.zero +
                     pass.tilt * position);
  }
  disturb(positions, pass.noise, random, values);
  return values;
}

std::vector<double> slide_slopes(const Error& error, std::span<const double> positions,
                                 double base_mm, const Pass& pass, RandomStream& random) {
  std::vector<double> values;
  values.reserve(positions.size());
  for (const double position : positions) {
    ToolPoint back = along_slide(pass, positions, position);
    ToolPoint front = back;
    back.r = back.x = position - 0.5 * base_mm;
    front.r = front.x = position + 0.5 * base_mm;
    values.push_back((error(front) - error(back)) / base_mm + pass.zero);
  }
  disturb(positions, pass.noise, random, values);
  return values;
}

}  // namespace slideway::turning
