// Noise with a long memory explains a structure in each face by itself, not in all of them at once.

#include "structure.hpp"

#include <random>

#include "identify/cases.hpp"
#include "slideway/identify/gates.hpp"
#include "trace/faces.hpp"

namespace slideway::shared_structure_test {
namespace {

/// Three cuts, with white noise of 0.15 µm and a random walk each, and a chirp in time of all of
/// them: a sine whose frequency grows fourfold.
std::vector<Profile> cuts(double chirp_mm, double walk_mm, unsigned seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal;
  std::vector<Profile> faces;
  for (const double feed : {32.0, 80.0, 40.0}) {
    const std::vector<double> x = cases::spaced(0.2, 127.0, 1500);
    const double step = walk_mm / std::sqrt(static_cast<double>(x.size())), slowest = 127.0 / 32.0;
    std::vector<double> z;
    double walk = 0.0;
    for (const double r : x) {
      const double minutes = (127.0 - r) / feed;
      walk += step * normal(engine);
      z.push_back(1e-5 * r + walk + 1.5e-4 * normal(engine) +
                  chirp_mm * std::sin(2.0 * kPi * minutes / 0.8 * (1.0 + 1.5 * minutes / slowest)));
    }
    faces.push_back(cases::face("cut" + std::to_string(faces.size() + 1), feed, x, z));
  }
  return faces;
}

Problem declared() {
  Problem out = cases::problem(Lever::paper, 3,
                               {cases::effect("squareness"), cases::effect("straightness", 3)});
  out.trace.candidates = {"thermal_drift", "step"};
  return out;
}

TEST(SharedStructure, IsNoMemoryOfTheNoise) {
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    const faces::Closed result = faces::closed(declared(), cuts(4.5e-4, 0.0, seed));
    EXPECT_EQ(result.verdict, TraceVerdict::unnamed) << faces::story(result);
  }
}

// The gate is passed by chance once in a thousand problems at most.
TEST(SharedStructure, WalksOfTheirOwnShareNone) {
  for (unsigned seed = 1; seed <= 20; ++seed)
    EXPECT_LT(shared_evidence(fit_declared(declared(), cuts(0.0, 1e-3, seed))),
              Gates{}.shared_evidence)
        << seed;
}

TEST(SharedStructure, TakesTwoFaces) {
  const std::vector<double> x = cases::spaced(0.2, 40.0, 400);
  std::mt19937_64 engine(1);
  std::normal_distribution<double> normal;
  std::vector<double> z;
  for (const double r : x) z.push_back(std::sin(r) + 0.1 * normal(engine));
  const Problem problem = cases::problem(Lever::paper, 1, {cases::effect("squareness")});
  EXPECT_EQ(shared_evidence(fit_declared(problem, {cases::face("cut", 4.0, x, z)})), 0.0);
}

}  // namespace
}  // namespace slideway::shared_structure_test
