// What one cut alone has is named with the cut it is in.

#include "slideway/base/units.hpp"
#include "trace/faces.hpp"

namespace slideway {
namespace {

using namespace faces;  // NOLINT(google-build-using-namespace)
using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(OneCut, AStepInItIsNamedWithTheCut) {
  constexpr double kPlace = 4.3717, kHeight = 0.1e-3;  // mm; the noise has 0.011 µm
  std::vector<Profile> profiles = quarter_faces({}, 3, kBlunt, 3);
  Profile& cut = profiles[2];
  for (std::size_t i = 0; i < cut.values.size(); ++i)
    if (std::abs(cut.positions[i] - cut.setup.center_mm) < kPlace) cut.values[i] += kHeight;
  const Closed result = closed(problem_of(), profiles);
  SCOPED_TRACE(story(result));
  EXPECT_THAT(named(result), ElementsAre("step"));
  const TraceRound* round = round_of(result, "step");
  ASSERT_NE(round, nullptr);
  EXPECT_THAT(round->profiles, ElementsAre(cut.name));
  EXPECT_THAT(round->ambiguous_with, IsEmpty());
  expect_within_4u(round->parameters, "step[cut3].height_um", kHeight / kMicrometre);
  const FittedParameter* position = find(round->parameters, "step[cut3].position_mm");
  ASSERT_NE(position, nullptr);
  EXPECT_NEAR(*position->value, kPlace, 2.0 / 110.0 + 0.032);  // a groove, a low-band value
}

TEST(OneCut, WhatAllHaveIsNamedWithoutACut) {
  constexpr double kPlace = 4.3717;
  const turning::Hidden step{
      "step", [](const turning::ToolPoint& p) { return p.r < kPlace ? 0.1e-3 : 0.0; }};
  const Closed result = closed(problem_of(), quarter_faces(step, 3, kBlunt, 3));
  SCOPED_TRACE(story(result));
  const TraceRound* round = round_of(result, "step");
  ASSERT_NE(round, nullptr);
  EXPECT_THAT(round->profiles, IsEmpty());
}

}  // namespace
}  // namespace slideway
