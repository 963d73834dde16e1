#include <algorithm>
#include <cmath>
#include <optional>

#include "closure_net.hpp"
#include "slideway/base/distribution.hpp"

namespace slideway {
namespace {

constexpr std::size_t kFewestStations = 6;  // stations

struct Differences {
  std::vector<double> t, size;  // share of the line; mm
};

bool is_near(const Point& a, const Point& b, double mm) { return length(between(a, b)) <= mm; }

// Of b from a at the stations of a; none unless both have the same ends.
std::optional<Differences> differences(const HeightLine& a, const HeightLine& b) {
  const Line &one = *a.profile->line, &other = *b.profile->line;
  const double near = std::min(a.half_station_mm(), b.half_station_mm());
  const bool same =
      is_near(one.from_mm, other.from_mm, near) && is_near(one.to_mm, other.to_mm, near);
  const bool reversed =
      is_near(one.from_mm, other.to_mm, near) && is_near(one.to_mm, other.from_mm, near);
  if ((!same && !reversed) || a.profile->setup.z_mm != b.profile->setup.z_mm) return std::nullopt;
  Differences out;
  for (std::size_t i = 0; i < a.at.size(); ++i)
    if (const auto height = b.height(same ? a.at[i] : 1.0 - a.at[i], false)) {
      out.t.push_back(a.at[i]);
      out.size.push_back(height->value - a.heights[i]);
    }
  return out;
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

// The station whose deleted residual about a straight line is the largest of its uncertainties.
void find_worst(const HeightLine& a, const Differences& all, Repeat& out) {
  const double n = static_cast<double>(all.t.size()), t0 = mean(all.t), z0 = mean(all.size);
  double tt = 0.0, tz = 0.0, largest = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < all.t.size(); ++i) {
    tt += (all.t[i] - t0) * (all.t[i] - t0);
    tz += (all.t[i] - t0) * (all.size[i] - z0);
    largest = std::max({largest, std::abs(all.size[i]), std::abs(a.heights[i])});
  }
  const auto residual = [&](std::size_t i) { return all.size[i] - z0 - tz / tt * (all.t[i] - t0); };
  for (std::size_t i = 0; i < all.t.size(); ++i) squares += residual(i) * residual(i);
  const double rounding = 1e-12 * largest;
  double worst = -1.0;
  for (std::size_t i = 0; i < all.t.size(); ++i) {
    const double own = 1.0 - 1.0 / n - (all.t[i] - t0) * (all.t[i] - t0) / tt;
    const double others = std::max(0.0, squares - residual(i) * residual(i) / own) / (n - 3.0);
    const double deleted = residual(i) / own;
    const double uncertainty = (std::sqrt(others) + rounding) / std::sqrt(own);
    if (!(uncertainty > 0.0) || std::abs(deleted) / uncertainty <= worst) continue;
    worst = std::abs(deleted) / uncertainty;
    out.place = a.place(all.t[i]);
    out.difference = deleted;
    out.standard_uncertainty = uncertainty;
  }
  out.limit = student_limit(n - 3.0, 0.5 * kClosureFalseAlarm / n);
}

}  // namespace

std::vector<Repeat> repeats(const ClosureNet& net) {
  std::vector<Repeat> out;
  for (std::size_t i = 0; i < net.lines.size(); ++i)
    for (std::size_t j = i + 1; j < net.lines.size(); ++j) {
      const bool first_is_coarser = net.lines[i].at.size() <= net.lines[j].at.size();
      const HeightLine& a = net.lines[first_is_coarser ? i : j];
      const HeightLine& b = net.lines[first_is_coarser ? j : i];
      const std::optional<Differences> all = differences(a, b);
      if (!all || all->t.size() < kFewestStations) continue;
      Repeat repeat{a.index, b.index, all->t.size()};
      find_worst(a, *all, repeat);
      out.push_back(repeat);
    }
  return out;
}

}  // namespace slideway
