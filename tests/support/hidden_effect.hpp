#pragma once

#include <functional>
#include <string>
#include <vector>

#include "slideway/identify/problem.hpp"
#include "support/turning.hpp"

/// Faces with an effect that the declared model lacks, made by the process: for tests and measures
/// of the closed loop.
namespace slideway::turning {

inline constexpr double kFaceNoise = 0.010e-3;       // mm: correlated part, over 0.1 mm
inline constexpr double kFaceWhiteNoise = 0.005e-3;  // mm
inline constexpr double kFaceSquareness = 2.0e-5;    // rad

/// Something the model does not know: an error of the tool, or of the instrument's datum.
struct Hidden {
  std::string name;
  Error tool = nullptr;
  std::function<double(double X, double m)> datum = nullptr;
  double shape = 0.0;  // its shape parameter in the unit of the catalogue, where it has one
};

/// An effect of the catalogue, or one of the shapes in no catalogue ("stretched_exponential",
/// "chirp", "double_bump", "switched_drift"), of size `amplitude_mm` and a shape of its own; any
/// other name: nothing.
Hidden make_hidden(const std::string& name, double amplitude_mm, RandomStream& random);

/// Squareness and a cubic straightness, lever "paper", all candidates.
Problem face_problem();

/// Diameter traces of 20 mm faces, 20000 samples each: 2 mm/min inward, 8 mm/min inward, 2 mm/min
/// outward, the first `cuts` of them, at 110 rpm.
std::vector<Profile> make_faces(const Hidden& hidden, int cuts, double nose_radius_mm,
                                std::uint64_t seed);

}  // namespace slideway::turning
