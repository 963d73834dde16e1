#pragma once

#include <functional>
#include <map>
#include <ostream>
#include <string>
#include <vector>

#include "slideway/base/random.hpp"
#include "slideway/identify/problem.hpp"

/// Problems whose truth is known, measured as often as one likes: for tests of what U holds.
namespace slideway::simulations {

/// Profiles as they are read once more; the noise is the stream's.
using Measure = std::function<std::vector<Profile>(RandomStream& random)>;

struct Simulation {
  std::string name;
  Problem problem;                      // without profiles
  std::map<std::string, double> truth;  // of every parameter, in its unit
  bool correlated = false;              // the noise along a profile
  std::size_t determined = 0;           // parameters and combinations that the data determine
  std::function<Measure()> prepare;     // cuts the faces
};

/// For GoogleTest.
inline void PrintTo(const Simulation& simulation, std::ostream* out) { *out << simulation.name; }

/// Faces of the turning process (spiral, feed marks, stylus).
std::vector<Simulation> of_faces();

/// Heights and slopes read along a slide.
std::vector<Simulation> of_slides();

}  // namespace slideway::simulations
