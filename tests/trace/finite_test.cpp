#include <gmock/gmock.h>

#include <cmath>

#include "slideway/trace/analysis.hpp"

namespace slideway::finite_test {
namespace {

using ::testing::ElementsAre;
using ::testing::SizeIs;

// 7 digits of a place and 5 of a curve, as record.hpp and the fields have it; all of other numbers.
TEST(RoundDrawn, LeavesTheDigitsThatAreWrittenAndAllOfWhatIsNotDrawn) {
  Analysis analysis;
  StraightnessCurve& curve = analysis.result.declared.emplace().straightness.emplace().curve;
  curve.position_mm = {12.3456789, 0.0};
  curve.deviation_um = {-0.123456789, 1e-12};
  std::vector<double>& raw = analysis.result.ranking.entries.emplace_back().running.raw;
  raw = {0.123456789};
  round_drawn(analysis);
  EXPECT_THAT(curve.position_mm, ElementsAre(12.34568, 0.0));
  EXPECT_THAT(curve.deviation_um, ElementsAre(-0.12346, 1e-12));
  EXPECT_THAT(raw, ElementsAre(0.123456789));
}

TEST(LeaveOutNonFinite, NamesEachPlaceOnce) {
  Analysis analysis;
  StraightnessCurve& curve = analysis.result.declared.emplace().straightness.emplace().curve;
  curve.position_mm = {INFINITY, 1.0, -INFINITY};
  curve.deviation_um = {2.0};
  leave_out_non_finite(analysis);
  EXPECT_TRUE(std::isnan(curve.position_mm[0]) && std::isnan(curve.position_mm[2]));
  EXPECT_EQ(curve.position_mm[1], 1.0);
  EXPECT_THAT(analysis.result.declared->notes, SizeIs(1));
}

}  // namespace
}  // namespace slideway::finite_test
