#include "closure_net.hpp"

#include <algorithm>
#include <cmath>

#include "outlier_level.hpp"
#include "slideway/base/statistics.hpp"
#include "slideway/base/text.hpp"
#include "slideway/signal/low_band.hpp"

namespace slideway {
namespace {

constexpr double kParallel = 0.02;    // sine of the angle
constexpr double kSameHeight = 1e-9;  // of the largest
constexpr std::size_t kMostReadings = 1000;

double cross(const Point& a, const Point& b) { return a[0] * b[1] - a[1] * b[0]; }

double median_step(const std::vector<double>& at) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < at.size(); ++i) steps.push_back(at[i] - at[i - 1]);
  return median(steps);
}

double largest_step(const std::vector<double>& at) {
  double largest = 0.0;
  for (std::size_t i = 1; i < at.size(); ++i) largest = std::max(largest, at[i] - at[i - 1]);
  return largest;
}

// Slopes hold halfway to the next ones, at the ends to the feet of the base.
void integrate(const Profile& profile, std::vector<double>& positions,
               std::vector<double>& heights) {
  const double foot = 0.5 * profile.setup.base_mm.value_or(0.0);
  const std::vector<double>& centres = profile.positions;
  positions.push_back(centres.front() - foot);
  for (std::size_t i = 1; i < centres.size(); ++i)
    positions.push_back(0.5 * (centres[i - 1] + centres[i]));
  positions.push_back(centres.back() + foot);
  heights.push_back(0.0);
  for (std::size_t i = 0; i < centres.size(); ++i)
    heights.push_back(heights.back() + profile.values[i] * (positions[i + 1] - positions[i]));
}

HeightLine height_line(const Profile& profile, std::size_t index) {
  const Line& line = *profile.line;
  HeightLine out{&profile, index, between(line.from_mm, line.to_mm), {}, {}, 0.0, 0.0};
  double first = line.first_mm, last = line.last_mm;
  if (profile.setup.quantity == Quantity::slope) {
    integrate(profile, out.at, out.heights);
    first -= 0.5 * profile.setup.base_mm.value_or(0.0);
    last += 0.5 * profile.setup.base_mm.value_or(0.0);
  } else {
    out.at = profile.positions;
    out.heights = profile.values;
  }
  for (double& at : out.at) at = (at - first) / (last - first);
  out.step = median_step(out.at);
  std::vector<double> own = bends(out.heights, 1);
  if (!own.empty()) out.bend = median(own);
  return out;
}

// Where lines a and b meet.
std::optional<Point> meeting(const HeightLine& a, const HeightLine& b) {
  if (a.profile->setup.z_mm != b.profile->setup.z_mm) return std::nullopt;
  const double sine = cross(a.along, b.along);
  if (std::abs(sine) <= kParallel * length(a.along) * length(b.along)) return std::nullopt;
  const Point apart = between(a.profile->line->from_mm, b.profile->line->from_mm);
  const double on_a = cross(apart, b.along) / sine, on_b = cross(apart, a.along) / sine;
  const auto on = [](const HeightLine& line, double t) {
    return t >= -0.5 * line.step && t <= 1.0 + 0.5 * line.step;
  };
  if (!on(a, on_a) || !on(b, on_b)) return std::nullopt;
  return a.place(on_a);
}

// Lines that meet within half a station of one another meet at one place.
class Places {
 public:
  explicit Places(ClosureNet& net) : net_(&net) {}

  void add(std::size_t a, std::size_t b, const Point& place) {
    const std::vector<HeightLine>& lines = net_->lines;
    const double near = std::max(lines[a].half_station_mm(), lines[b].half_station_mm());
    std::size_t at = 0;
    while (at < net_->places.size() &&
           (length(between(net_->places[at], place)) > near || surface_[at] != surface(a)))
      ++at;
    if (at == net_->places.size()) {
      net_->places.push_back(place);
      surface_.push_back(surface(a));
      met_.emplace_back();
    }
    for (const std::size_t line : {a, b})
      if (std::ranges::find(met_[at], line) == met_[at].end()) met_[at].push_back(line);
  }

  void read(bool beside) {
    net_->readings.clear();
    for (std::size_t place = 0; place < met_.size(); ++place) {
      std::vector<Reading> here;
      for (const std::size_t index : met_[place]) {
        const HeightLine& line = net_->lines[index];
        const Point from = between(line.profile->line->from_mm, net_->places[place]);
        const double size = length(line.along);
        const double t = std::clamp(
            (from[0] * line.along[0] + from[1] * line.along[1]) / (size * size), 0.0, 1.0);
        if (const auto height = line.height(t, beside)) here.push_back({index, place, t, *height});
      }
      if (here.size() > 1) net_->readings.insert(net_->readings.end(), here.begin(), here.end());
    }
  }

 private:
  [[nodiscard]] double surface(std::size_t line) const {
    return net_->lines[line].profile->setup.z_mm;
  }

  ClosureNet* net_;
  std::vector<double> surface_;
  std::vector<std::vector<std::size_t>> met_;  // lines of a place
};

// Whether heights alone meet, the same wherever they do.
bool is_tied(const ClosureNet& net) {
  double largest = 0.0;
  for (const Reading& reading : net.readings) {
    if (net.lines[reading.line].profile->setup.quantity == Quantity::slope) return false;
    largest = std::max(largest, std::abs(reading.height.value));
  }
  for (std::size_t i = 1; i < net.readings.size(); ++i) {
    const Reading &a = net.readings[i - 1], &b = net.readings[i];
    if (a.place == b.place && std::abs(a.height.value - b.height.value) > kSameHeight * largest)
      return false;
  }
  return !net.readings.empty();
}

void note_length(const HeightLine& line, ClosureNet& net) {
  constexpr double kTolerance = 0.1;
  const Line& ends = *line.profile->line;
  const Setup& setup = line.profile->setup;
  const double base = setup.quantity == Quantity::slope ? setup.base_mm.value_or(0.0) : 0.0;
  const double span = ends.last_mm - ends.first_mm + base, size = length(line.along);
  if (std::abs(size - span) > kTolerance * span)
    net.notes.push_back("'" + line.profile->name + "': from_mm and to_mm are " +
                        significant(size, 5) + " mm apart, its positions " + significant(span, 5) +
                        " mm: are both right?");
}

void add_lines(const std::vector<Profile>& profiles, ClosureNet& net) {
  for (std::size_t i = 0; i < profiles.size(); ++i) {
    if (!profiles[i].line) continue;
    HeightLine line = height_line(profiles[i], i);
    note_length(line, net);
    if (profiles[i].setup.quantity == Quantity::slope &&
        largest_step(profiles[i].positions) > kGapSteps * median_step(profiles[i].positions))
      net.notes.push_back("'" + profiles[i].name +
                          "' is not closed: heights cannot be summed over a gap in its slopes");
    else
      net.lines.push_back(std::move(line));
  }
}

}  // namespace

std::vector<double> bends(const std::vector<double>& z, std::size_t lag) {
  std::vector<double> out;
  for (std::size_t i = lag; i + lag < z.size(); ++i)
    out.push_back(z[i] - 0.5 * (z[i - lag] + z[i + lag]));
  return out;
}

Point HeightLine::place(double t) const {
  const Point& from = profile->line->from_mm;
  return {from[0] + t * along[0], from[1] + t * along[1]};
}

double HeightLine::half_station_mm() const { return 0.5 * step * length(along); }

std::optional<HeightLine::Height> HeightLine::height(double t, bool beside) const {
  const double apart = beside ? 0.5 * step : 0.0;  // from what is no longer there
  auto right = std::ranges::lower_bound(at, t + apart) - at.begin();
  auto left = std::ranges::upper_bound(at, t - apart) - at.begin() - 1;
  const auto count = std::ssize(at);
  if (left == right) return Height{heights[right], 0.0};
  if (left < 0) left = right++;
  if (right >= count) right = left--;
  if (left < 0 || right >= count) return std::nullopt;
  const double gap = at[right] - at[left], share = (t - at[left]) / gap;
  const double nearest = std::min(std::abs(t - at[left]), std::abs(at[right] - t));
  if (nearest > kGapSteps * step || gap > 2.0 * kGapSteps * step) return std::nullopt;
  const double off = share * (1.0 - share) * (gap / step) * (gap / step);
  return Height{(1.0 - share) * heights[left] + share * heights[right] + bend * off, std::abs(off)};
}

ClosureNet closure_net(const std::vector<Profile>& profiles) {
  ClosureNet net;
  add_lines(profiles, net);
  Places places(net);
  for (std::size_t a = 0; a < net.lines.size(); ++a)
    for (std::size_t b = a + 1; b < net.lines.size(); ++b)
      if (const auto place = meeting(net.lines[a], net.lines[b])) places.add(a, b, *place);
  places.read(false);
  net.tied = is_tied(net);
  if (net.tied) places.read(true);
  if (net.readings.size() > kMostReadings) {
    net.notes.push_back("the lines meet more than " + std::to_string(kMostReadings) +
                        " times: not closed");
    net.readings.clear();
  }
  return net;
}

}  // namespace slideway
