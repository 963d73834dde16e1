// A line faster than the low band can show is folded by it to a slow one.

#include <cmath>
#include <numbers>

#include "slideway/base/random.hpp"
#include "slideway/base/units.hpp"
#include "trace/faces.hpp"

namespace slideway {
namespace {

using namespace faces;  // NOLINT(google-build-using-namespace)

constexpr double kSpacing = 0.25;  // mm
constexpr double kTurn = 2.0 * std::numbers::pi;

/// Three readings of bowed slides with noise of 20 nm and a line of 0.15 µm, a third of a turn
/// apart: no two of them have it in common.
std::vector<Profile> with_line(double period_mm, std::uint64_t seed) {
  std::vector<Profile> out;
  for (const char* name : {"run1", "run2", "run3"}) {
    RandomStream random(seed, name);
    Profile& profile = out.emplace_back();
    profile.name = name;
    profile.surface = name;
    profile.setup.kind = Kind::slide;
    const double phase = kTurn / 3.0 * static_cast<double>(out.size());
    for (int i = 0; i < 1200; ++i) {
      const double x = 5.0 + kSpacing * i, u = (x - 155.0) / 150.0;
      profile.positions.push_back(x);
      profile.values.push_back(kMicrometre * (0.5 * u * u - 0.2 * u * u * u +
                                              0.15 * std::cos(kTurn * x / period_mm + phase) +
                                              0.02 * random.normal()));
    }
    profile.setup.first_mm = profile.positions.front();
    profile.setup.last_mm = profile.positions.back();
  }
  return out;
}

// The line is there in each sample, at 0.23 to 0.28 cycles a sample. db1 of level 3 keeps one value
// of eight and lets a hundredth of it through, at another rate.
TEST(FoldedLine, IsNoEffect) {
  Problem problem = problem_of({"slide_periodic", "step", "local_form"});
  problem.effects = {{"straightness", {std::nullopt, 3, std::nullopt}, {}}};
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const double period_mm = kSpacing / (0.23 + 0.01 * static_cast<double>(seed - 1));
    const Closed result = closed(problem, with_line(period_mm, seed));
    SCOPED_TRACE(story(result));
    for (const TraceRound& round : result.rounds) {
      ASSERT_EQ(round.accepted, "slide_periodic");
      // Half a cycle over the trace of 300 mm is the resolution of its spectrum.
      EXPECT_NEAR(300.0 / *find(round.parameters, "slide_periodic.period_mm")->value,
                  300.0 / period_mm, 0.5);
    }
  }
}

}  // namespace
}  // namespace slideway
