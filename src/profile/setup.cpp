#include "slideway/profile/setup.hpp"

#include <algorithm>
#include <functional>

#include "slideway/base/units.hpp"

namespace slideway {

std::optional<double> largest_feed_mark(const Setup& setup, int harmonic) {
  const std::optional<double> feed = setup.feed_per_revolution();
  if (!feed || !setup.nose_radius_mm) return std::nullopt;
  const double height = *feed * *feed / (8.0 * *setup.nose_radius_mm);
  return harmonic == 1 ? height / 2.0 : 8.0 * height / (kPi * kPi * harmonic * harmonic);
}

std::string_view symbol(IndependentVariable variable) {
  switch (variable) {
    case IndependentVariable::radius:
      return "r";
    case IndependentVariable::slide:
      return "x";
    case IndependentVariable::time:
      return "t";
    case IndependentVariable::revolution:
      return "k";
    case IndependentVariable::distance:
      return "s";
    case IndependentVariable::trace:
      return "X";
    case IndependentVariable::measuring_time:
      return "m";
    case IndependentVariable::reading_time:
      return "t_read";
  }
  return "";
}

std::optional<CutDirection> travel_direction(const Setup& setup) {
  if (setup.cut_direction || setup.kind != Kind::slide || !setup.reading_times)
    return setup.cut_direction;
  const std::vector<double>& times = setup.reading_times->times_s;
  if (std::ranges::is_sorted(times)) return CutDirection::outward;
  if (std::ranges::is_sorted(times, std::greater())) return CutDirection::inward;
  return std::nullopt;
}

std::vector<std::string> missing_for(IndependentVariable variable, const Setup& setup) {
  std::vector<std::string> missing;
  const bool turning =
      variable == IndependentVariable::revolution || variable == IndependentVariable::distance;
  if ((variable == IndependentVariable::radius || variable == IndependentVariable::distance) &&
      setup.kind != Kind::face)
    missing.emplace_back("kind = \"face\"");
  if (turning || variable == IndependentVariable::time) {
    if (!setup.feed_mm_per_min) missing.emplace_back("feed_mm_per_min");
    if (!setup.cut_direction) missing.emplace_back("cut_direction");
  }
  if (turning && !setup.spindle_rpm) missing.emplace_back("spindle_rpm");
  if (variable == IndependentVariable::measuring_time && !setup.traverse_mm_per_s)
    missing.emplace_back("traverse_mm_per_s");
  if (variable == IndependentVariable::reading_time && !setup.reading_times)
    missing.emplace_back("time_column");
  return missing;
}

double ReadingTimes::at(double position_mm) const {
  const auto next = std::ranges::lower_bound(positions_mm, position_mm) - positions_mm.begin();
  if (next == std::ssize(positions_mm)) return times_s.back();
  const auto after = static_cast<std::size_t>(next);
  if (next == 0 || positions_mm[after] == position_mm) return times_s[after];
  const double share =
      (position_mm - positions_mm[after - 1]) / (positions_mm[after] - positions_mm[after - 1]);
  return times_s[after - 1] + share * (times_s[after] - times_s[after - 1]);
}

double Stations::time(Eigen::Index i) const {
  const bool inward = setup_->cut_direction == CutDirection::inward;
  double path = 0.0;  // what the tool has travelled since the cut started
  if (setup_->kind == Kind::face)
    path = inward ? *setup_->cut_radius_mm - radius(i) : radius(i);
  else
    path = inward ? setup_->last_mm - positions_[i] : positions_[i] - setup_->first_mm;
  return setup_->start_s + path / *setup_->feed_mm_per_min * kMinute;
}

double Stations::distance(Eigen::Index i) const {
  const double r = radius(i);
  const double feed = *setup_->feed_per_revolution();
  if (setup_->cut_direction == CutDirection::outward) return kPi * r * r / feed;
  const double outer = *setup_->cut_radius_mm;
  return kPi * (outer - r) * (outer + r) / feed;
}

}  // namespace slideway
