#include <algorithm>
#include <string>
#include <vector>

#include "slideway/report/picture.hpp"
#include "text_parts.hpp"

namespace slideway {
namespace {

double mean_square(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return sum / static_cast<double>(std::max<std::size_t>(values.size(), 1));
}

/// By how much the loop has lowered the mean square of a fitted profile's residual.
double fall(const ProfileCurves& curves) {
  if (curves.role != Role::fit || curves.residual_after.empty()) return 0.0;
  return mean_square(curves.residual_before) - mean_square(curves.residual_after);
}

}  // namespace

const ProfileCurves& profile_to_show(const Curves& curves) {
  return *std::ranges::max_element(curves.profiles, {}, [](const auto& p) { return fall(p); });
}

std::string residual_pictures(const Curves& curves) {
  if (curves.profiles.empty()) return "";
  const ProfileCurves& most = profile_to_show(curves);
  if (!(fall(most) > 0.0)) return "";
  const auto [low, high] = std::ranges::minmax(most.residual_before);
  const PictureFrame frame{4, low, high};
  return heading("Residual of " + most.profile + " in the low band, " +
                 (most.unit == MicroUnit::urad ? "µrad" : "µm") +
                 ", over the trace in mm, before") +
         picture(most.position_mm, most.residual_before, frame) + "and after, on the same scale\n" +
         picture(most.position_mm, most.residual_after, frame);
}

}  // namespace slideway
