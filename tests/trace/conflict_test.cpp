// An effect the carriage's own polynomial imitates: one column on a face, a conflict between a face
// and a reading of the slide.

#include "trace/faces.hpp"

namespace slideway {
namespace {

using namespace faces;  // NOLINT(google-build-using-namespace)
using ::testing::HasSubstr;
using turning::ToolPoint;

turning::Hidden cup() {
  return {"cup", [](const ToolPoint& p) { return 0.5e-3 * p.r * p.r / 100.0; }};
}

TEST(Conflict, CupIsOneColumnWithTheStraightnessOfAFace) {
  const TraceResult result = close_loop(problem_of(), quarter_faces(cup(), 1, kBlunt, 2));
  SCOPED_TRACE(story(result));
  EXPECT_THAT(named(result), ::testing::IsEmpty());
  EXPECT_THAT(result.not_separable,
              ::testing::Contains(::testing::FieldsAre("cup", HasSubstr("straightness.b2"))));
}

// r³ cos 3θ is the same at 0°, 120° and 240°, and there b_3; 100° and 200° tell them apart. The
// faces have no lobes, and no grooves.
TEST(Conflict, ThreeLobesAreOneColumnWithTheStraightnessOfRadiiAtTheJaws) {
  const turning::Carriage carriage{{0.0, 0.0, 2e-7, -6e-9}, {}, turning::kFaceSquareness};
  const auto lobes = ::testing::FieldsAre("chucking_lobes", HasSubstr("straightness.b3"));
  Problem problem = problem_of();
  problem.low_band.level = 0;
  for (const double turn : {120.0, 100.0}) {
    std::vector<Profile> radii(3);
    for (std::size_t c = 0; c < radii.size(); ++c) {
      Profile& radius = radii[c];
      radius.name = "radius" + std::to_string(c);
      radius.free_tilt = false;
      RandomStream random(3, radius.name);
      for (int i = 0; i < 200; ++i) {
        ToolPoint point;
        point.r = point.x = radius.positions.emplace_back(0.2 + 0.2 * i);
        radius.values.push_back(turning::one_lever(carriage, point) + 1e-5 * random.normal());
      }
      auto& setup = radius.setup;
      setup.azimuth_deg = turn * static_cast<double>(c);
      setup.cut_radius_mm = 40.0;
      setup.first_mm = radius.positions.front();
      setup.last_mm = radius.positions.back();
    }
    const TraceResult result = close_loop(problem, radii);
    SCOPED_TRACE(story(result));
    EXPECT_EQ(::testing::Value(result.not_separable, ::testing::Contains(lobes)), turn == 120.0);
  }
}

/// The straightness of make_faces() as an autocollimator reads it on the slide, to 0.02 µrad; its
/// zero drifts steadily, by `drift` rad over the way.
Profile autocollimator(CutDirection direction, double drift = 0.0) {
  Profile profile;
  profile.name = direction == CutDirection::outward ? "there" : "back";
  profile.setup.kind = Kind::slide;
  profile.setup.quantity = Quantity::slope;
  profile.setup.cut_direction = direction;
  profile.setup.base_mm = 1.0;
  for (int i = 0; i <= 90; ++i) profile.positions.push_back(0.5 + 0.1 * i);
  profile.setup.first_mm = profile.positions.front();
  profile.setup.last_mm = profile.positions.back();
  profile.free_tilt = false;
  const turning::Carriage carriage{{0.0, 0.0, 2e-7, -6e-9}, {}, 0.0, 0.0, 0.0};
  turning::Pass pass;
  pass.zero = 3e-6;
  pass.noise.white = 2e-8;
  RandomStream random(2, profile.name);
  profile.values = turning::slide_slopes(
      [&](const ToolPoint& p) { return turning::polynomial(carriage.b, p.x); }, profile.positions,
      1.0, pass, random);
  const double sign = direction == CutDirection::outward ? 1.0 : -1.0;
  for (std::size_t i = 0; i < profile.values.size(); ++i)
    profile.values[i] += sign * drift * static_cast<double>(i) / 90.0;
  return profile;
}

/// Means of eight samples each, for a low band of level 0.
Profile in_means(Profile profile) {
  std::vector<double> positions, values;
  for (std::size_t i = 0; i + 8 <= profile.positions.size(); i += 8) {
    double position = 0.0, value = 0.0;
    for (std::size_t j = i; j < i + 8; ++j)
      position += profile.positions[j] / 8.0, value += profile.values[j] / 8.0;
    positions.push_back(position);
    values.push_back(value);
  }
  profile.positions = positions;
  profile.values = values;
  profile.setup.first_mm = positions.front();
  profile.setup.last_mm = positions.back();
  return profile;
}

/// Of a face beside readings of the slide.
TraceResult beside(const turning::Hidden& hidden, const std::vector<Profile>& readings) {
  Problem problem = problem_of();
  problem.low_band.level = 0;
  std::vector<Profile> profiles;
  for (Profile& face : quarter_faces(hidden, 1, kBlunt, 2))
    profiles.push_back(in_means(std::move(face)));
  profiles.insert(profiles.end(), readings.begin(), readings.end());
  return close_loop(problem, profiles);
}

TEST(Conflict, CupStandsOutAgainstReadingsOfTheSlideThereAndBack) {
  const TraceResult result =
      beside(cup(), {autocollimator(CutDirection::outward), autocollimator(CutDirection::inward)});
  SCOPED_TRACE(story(result));
  EXPECT_THAT(named(result), ::testing::ElementsAre("cup"));
  const TraceRound* round = round_of(result, "cup");
  ASSERT_NE(round, nullptr);
  EXPECT_THAT(round->ambiguous_with, ::testing::IsEmpty());
  expect_within_4u(round->parameters, "cup.sag_um", 0.5);
}

// On the lever r a cup c r² is a straightness -c x², which a zero that drifts by 2 c x makes as
// well: 100 µrad over 9 mm is a cup of 0.5 µm at 9 mm.
TEST(Conflict, CupIsTheDriftOfAReadingOneWayAsWell) {
  for (const bool is_cup : {true, false}) {
    const TraceResult result = beside(is_cup ? cup() : turning::Hidden{},
                                      {autocollimator(CutDirection::outward, is_cup ? 0.0 : 1e-4)});
    SCOPED_TRACE(story(result));
    EXPECT_NE(result.verdict, TraceVerdict::explained);
    const TraceRound* round = round_of(result, "cup");
    ASSERT_NE(round, nullptr);
    EXPECT_THAT(round->ambiguous_with, ::testing::Contains("zero_drift"));
  }
}

// The way has b_2 = 2e-7 /mm. A prior of 5e-6 /mm asks for a cup that takes the rest away again.
TEST(Conflict, EffectThatMeetsAPriorAloneIsNotNamedAlone) {
  Problem problem = problem_of();
  problem.effects.back().priors.push_back({"b2", 5e-6, 1e-8});
  const TraceResult result = close_loop(problem, quarter_faces({}, 1, kBlunt, 2));
  SCOPED_TRACE(story(result));
  for (const TraceRound& round : result.rounds)
    if (round.accepted != "feed_marks")
      EXPECT_THAT(round.ambiguous_with, ::testing::Contains(kUnnamedRival));
  EXPECT_NE(result.verdict, TraceVerdict::explained);
}

}  // namespace
}  // namespace slideway
