#pragma once

#include <string>
#include <utility>
#include <vector>

#include "effects/effect_cases.hpp"

/// Heights of effects on a face of R = 10 mm, cut at 110 rpm.
namespace slideway::testing_support {

inline Case face(std::vector<double> positions, double feed = 2.0,
                 CutDirection direction = CutDirection::inward) {
  Case profile{"face", setup_of(Kind::face, Quantity::height, 0, 10), std::move(positions)};
  profile.setup.feed_mm_per_min = feed;
  profile.setup.cut_direction = direction;
  return profile;
}

inline Eigen::VectorXd values(std::initializer_list<double> list) {
  Eigen::VectorXd result(static_cast<Eigen::Index>(list.size()));
  std::copy(list.begin(), list.end(), result.data());
  return result;
}

// Height in µm.
inline Eigen::VectorXd height_um(const std::string& name, const Case& profile,
                                 std::initializer_list<double> parameters) {
  return signal(*make(name), profile, values(parameters)) / kMicrometre;
}

}  // namespace slideway::testing_support
