#pragma once

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "identify/cases.hpp"

/// Reference datasets of NIST as profiles along the slide, and how answers compare.
namespace slideway::nist {

/// Readings y by position x, without levelling. A profile has no position twice: the j-th reading
/// at a position goes to the j-th profile.
inline std::vector<Profile> profiles(const std::multimap<double, double>& points) {
  std::vector<std::vector<double>> x, y;
  std::size_t repeat = 0;
  for (auto point = points.begin(); point != points.end(); ++point) {
    repeat = point != points.begin() && std::prev(point)->first == point->first ? repeat + 1 : 0;
    x.resize(std::max(x.size(), repeat + 1));
    y.resize(x.size());
    x[repeat].push_back(point->first);
    y[repeat].push_back(point->second);
  }
  std::vector<Profile> out;
  for (std::size_t i = 0; i < x.size(); ++i) {
    out.push_back(cases::profile("repeat" + std::to_string(i), Kind::slide, x[i], y[i]));
    out.back().free_offset = out.back().free_tilt = false;
  }
  return out;
}

/// Digits in which a number agrees with the certified one.
inline double digits(double found, double certified) {
  return found == certified ? 15.0 : -std::log10(std::abs(found / certified - 1.0));
}

}  // namespace slideway::nist
