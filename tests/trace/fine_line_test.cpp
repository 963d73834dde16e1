// Waves of a way with fewer than four readings a cycle.

#include "fine_line.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "identify/cases.hpp"
#include "slideway/base/random.hpp"
#include "trace/faces.hpp"

namespace slideway::fine_line_test {
namespace {

constexpr double kNoise = 1e-4;  // mm

/// A parabola with white noise, and a wave of so many readings a cycle.
Profile reading(std::size_t count, double per_cycle, double amplitude, std::uint64_t seed) {
  RandomStream noise(seed, "noise");
  const std::vector<double> x = cases::spaced(0.0, 600.0, count);
  const double phase = 2.0 * kPi * noise.uniform();
  std::vector<double> z;
  for (std::size_t i = 0; i < count; ++i)
    z.push_back(1e-8 * x[i] * x[i] + kNoise * noise.normal() +
                amplitude * std::sin(2.0 * kPi * static_cast<double>(i) / per_cycle + phase));
  return cases::profile("way", Kind::slide, x, z);
}

Problem declared() { return cases::problem(Lever::paper, 0, {cases::effect("straightness", 4)}); }

std::optional<FineLine> line_in(const std::vector<Profile>& profiles) {
  const FittedModel fitted = fit_declared(declared(), profiles);
  return fine_line(fitted.fit.linear, fitted.fit.noise, Gates{});
}

TEST(FineLine, IsSeenWithItsPeriod) {
  for (const std::size_t count : {61U, 121U, 300U})
    for (const double per_cycle : {2.4, 2.6, 3.1, 3.6}) {
      const std::vector<Profile> way{reading(count, per_cycle, 4.0 * kNoise, count)};
      const auto line = line_in(way);
      ASSERT_TRUE(line) << count << ", " << per_cycle;
      const double step = 600.0 / static_cast<double>(count - 1), n = static_cast<double>(count);
      // To half a cycle of the trace.
      EXPECT_NEAR(line->period_mm, per_cycle * step, 0.5 * per_cycle * per_cycle * step / n * 1.2);
    }
}

// Gates::lack_of_fit_p is a thousandth: 0.3 are expected in 300.
TEST(FineLine, IsNotSeenInNoise) {
  int seen = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed)
    seen += line_in({reading(61 + seed % 40, 3.0, 0.0, 1000 + seed)}) ? 1 : 0;
  EXPECT_LE(seen, 2);
}

TEST(FineLine, IsSomethingThatHasNoName) {
  const faces::Closed result = faces::closed(declared(), {reading(61, 2.6, 4.0 * kNoise, 7)});
  EXPECT_EQ(result.verdict, TraceVerdict::unnamed) << faces::story(result);
}

}  // namespace
}  // namespace slideway::fine_line_test
