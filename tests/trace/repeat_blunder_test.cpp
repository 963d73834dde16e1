// Readings of one way, one of them in another unit. A curve follows whichever has the least noise,
// so the readings have to say by themselves which of them is wrong.

#include <gtest/gtest.h>

#include "blunder.hpp"
#include "identify/cases.hpp"
#include "slideway/base/random.hpp"

namespace slideway::repeat_blunder_test {
namespace {

struct Slip {
  double factor;
  BlunderKind kind;
  Quantity quantity = Quantity::height;
};

/// Three or four readings of a sagging way with a kink, of 10 µm or 40 µrad, noise a thirtieth of
/// that; one of them times the factor.
std::vector<Profile> readings(const Slip& slip, std::size_t wrong, std::size_t count,
                              std::uint64_t seed) {
  const bool is_slope = slip.quantity == Quantity::slope;
  std::vector<Profile> out;
  for (std::size_t run = 0; run < count; ++run) {
    RandomStream noise(seed, "run" + std::to_string(run));
    const double factor = run == wrong ? slip.factor : 1.0;
    const std::vector<double> x = cases::spaced(0.0, 1000.0, 21);
    std::vector<double> values;
    for (const double at : x) {
      const double height = 1e-2 * (1.0 - std::pow(at / 500.0 - 1.0, 2)) -
                            1e-5 * std::max(0.0, at - 700.0) + 3e-4 * noise.normal();
      const double slope =
          4e-5 * (1.0 - at / 500.0) - (at > 700.0 ? 1e-5 : 0.0) + 1.3e-6 * noise.normal();
      values.push_back(factor * (is_slope ? slope : height));
    }
    out.push_back(cases::profile("r" + std::to_string(run), Kind::slide, x, values));
    out.back().setup.quantity = slip.quantity;
    if (is_slope) out.back().setup.base_mm = 50.0;
  }
  return out;
}

std::vector<Blunder> found(const std::vector<Profile>& profiles) {
  DeclaredEffect curve = cases::effect("straightness");
  curve.options.form = Form::curve;
  curve.options.resolution_mm = 50.0;
  return find_blunders(fit_declared(cases::problem(Lever::paper, 0, {curve}), profiles));
}

class RepeatBlunder : public ::testing::TestWithParam<Slip> {};

TEST_P(RepeatBlunder, IsNamedWithItsReading) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const std::size_t count = 3 + seed % 2, wrong = seed % count;
    const std::vector<Blunder> blunders = found(readings(GetParam(), wrong, count, seed));
    ASSERT_EQ(blunders.size(), 1U) << "seed " << seed;
    EXPECT_EQ(blunders[0].profile, "r" + std::to_string(wrong)) << seed;
    EXPECT_EQ(blunders[0].what, GetParam().kind) << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Factors, RepeatBlunder,
    ::testing::Values(Slip{-1.0, BlunderKind::sign}, Slip{25.4, BlunderKind::per_inch},
                      Slip{1 / 25.4, BlunderKind::inch}, Slip{1e3, BlunderKind::per_metre},
                      Slip{1e-3, BlunderKind::metre},
                      Slip{-1.0, BlunderKind::sign, Quantity::slope},
                      Slip{1 / 25.4, BlunderKind::inch, Quantity::slope},
                      Slip{1e3, BlunderKind::per_metre, Quantity::slope},
                      // 1 arcsec is 4.848 µrad.
                      Slip{1 / 4.84814, BlunderKind::arcsecond, Quantity::slope},
                      Slip{4.84814, BlunderKind::per_arcsecond, Quantity::slope}));

// A difference in BIC of 20 is one of e^10 in likelihood: no false alarm is expected in 40.
TEST(RepeatBlunders, NoneIsSeenInReadingsThatAgree) {
  for (std::uint64_t seed = 0; seed < 40; ++seed)
    EXPECT_TRUE(found(readings({1.0, BlunderKind::sign}, 0, 3, 100 + seed)).empty()) << seed;
}

TEST(RepeatBlunders, ANoisyReadingHasNone) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    std::vector<Profile> runs = readings({1.0, BlunderKind::sign}, 0, 3, 200 + seed);
    RandomStream noise(seed, "more");
    for (double& each : runs[1].values) each += 3e-3 * noise.normal();
    EXPECT_TRUE(found(runs).empty()) << seed;
  }
}

}  // namespace
}  // namespace slideway::repeat_blunder_test
