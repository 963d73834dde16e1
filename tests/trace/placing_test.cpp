// What the place of a trace on the workpiece decides: lobes between azimuths, a centre that is not
// where center_mm says.

#include <algorithm>
#include <cmath>

#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"
#include "trace/faces.hpp"

namespace slideway {
namespace {

using namespace faces;  // NOLINT(google-build-using-namespace)
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr double kPlacedRadius = 10.0;

/// Three traces over the diameter with a form added that depends on X and the azimuth.
template <typename Form>
std::vector<Profile> at_azimuths(Form&& form, std::uint64_t seed) {
  std::vector<Profile> out = quarter_faces({}, 3, kBlunt, seed);
  for (std::size_t c = 0; c < out.size(); ++c) {
    Setup& setup = out[c].setup;
    setup.azimuth_deg = 50.0 * static_cast<double>(c);
    for (std::size_t i = 0; i < out[c].values.size(); ++i)
      out[c].values[i] +=
          form(out[c].positions[i] - setup.center_mm, setup.azimuth_deg * kPi / 180.0);
  }
  return out;
}

// Two jaws: 0.5 µm (r/R)² cos 2(θ - 20°), 50 times the noise.
TEST(Placing, LobesBetweenAzimuthsAreNamed) {
  constexpr double kSize = 0.5e-3, kTurned = 20.0 * kPi / 180.0;
  const auto lobes = [](double x, double azimuth) {
    return kSize * (x / kPlacedRadius) * (x / kPlacedRadius) * std::cos(2.0 * (azimuth - kTurned));
  };
  const Closed result = closed(problem_of(), at_azimuths(lobes, 5));
  SCOPED_TRACE(story(result));
  EXPECT_THAT(named(result), ElementsAre("chucking_lobes"));
  const TraceRound* round = round_of(result, "chucking_lobes");
  ASSERT_NE(round, nullptr);
  EXPECT_THAT(round->profiles, IsEmpty());
  expect_within_4u(round->parameters, "chucking_lobes.cos2_um",
                   kSize / kMicrometre * std::cos(2.0 * kTurned));
  expect_within_4u(round->parameters, "chucking_lobes.sin2_um",
                   kSize / kMicrometre * std::sin(2.0 * kTurned));
}

// Three jaws, two discs clamped at different angles: 0.5 µm (r/R)³ cos 3(θ - φ) with φ = 20° and
// 75°.
TEST(Placing, LobesOfEachClampingAreNamed) {
  constexpr double kSize = 0.5e-3;
  std::vector<Profile> profiles;
  const std::vector<std::pair<std::string, double>> clampings{{"first", 20.0}, {"second", 75.0}};
  for (const auto& clamping : clampings) {
    const double turned = clamping.second * kPi / 180.0;
    const auto lobes = [=](double x, double azimuth) {
      return kSize * std::pow(x / kPlacedRadius, 3) * std::cos(3.0 * (azimuth - turned));
    };
    for (Profile& profile : at_azimuths(lobes, profiles.size() + 5)) {
      profile.surface = clamping.first;
      profile.name = clamping.first + profile.name;
      profiles.push_back(std::move(profile));
    }
  }
  const Closed result =
      closed(problem_of({"chucking_lobes", "traverse_datum", "cup", "linear_drift"}), profiles);
  SCOPED_TRACE(story(result));
  ASSERT_THAT(named(result), ElementsAre("chucking_lobes", "chucking_lobes"));
  for (const TraceRound& round : result.rounds) {
    ASSERT_EQ(round.profiles.size(), 3U);
    const std::string term = "chucking_lobes[" + joined(round.profiles, ",") + "]";
    const double turned = round.profiles[0].starts_with("first") ? 20.0 : 75.0;
    expect_within_4u(round.parameters, term + ".cos3_um",
                     kSize / kMicrometre * std::cos(3.0 * turned * kPi / 180.0));
    expect_within_4u(round.parameters, term + ".sin3_um",
                     kSize / kMicrometre * std::sin(3.0 * turned * kPi / 180.0));
  }
}

/// Two discs, three traces each, the discs in turn; the first has a form of X and the azimuth.
template <typename Form>
std::vector<Profile> two_discs(Form&& form) {
  std::vector<Profile> first = at_azimuths(form, 5);
  std::vector<Profile> second = at_azimuths([](double, double) { return 0.0; }, 8);
  std::vector<Profile> out;
  for (std::size_t c = 0; c < first.size(); ++c)
    for (std::vector<Profile>* disc : {&first, &second}) {
      Profile& trace = out.emplace_back(std::move((*disc)[c]));
      trace.surface = disc == &first ? "first" : "second";
      trace.name = *trace.surface + trace.name;
    }
  return out;
}

std::vector<std::string> traces_of(const std::vector<Profile>& profiles, const std::string& disc) {
  std::vector<std::string> out;
  for (const Profile& each : profiles)
    if (each.surface == disc) out.push_back(each.name);
  return out;
}

// Two lobes that the traces at 0° and 50° show alike, 0.5 µm cos 2(θ - 25°): beside a b_2 that all
// have, the third trace alone is cupped. No face is cupped along one diameter only.
TEST(Placing, ACupOfOneTraceOfASurfaceIsALobe) {
  constexpr double kSize = 0.5e-3, kTurned = 25.0 * kPi / 180.0;
  const std::vector<Profile> profiles = two_discs([](double x, double azimuth) {
    return kSize * std::pow(x / kPlacedRadius, 2) * std::cos(2.0 * (azimuth - kTurned));
  });
  const Closed result = closed(problem_of(), profiles);
  SCOPED_TRACE(story(result));
  ASSERT_THAT(named(result), ElementsAre("chucking_lobes"));
  EXPECT_EQ(result.rounds[0].profiles, traces_of(profiles, "first"));
  EXPECT_THAT(result.rounds[0].ambiguous_with, IsEmpty());
}

// A step of 0.2 µm at r = 4 mm of one of two discs.
TEST(Placing, AStepOfASurfaceIsInAllItsTraces) {
  constexpr double kDiscStep = 0.2e-3, kDiscRadius = 4.0;
  const std::vector<Profile> profiles = two_discs(
      [](double x, double /*azimuth*/) { return std::abs(x) < kDiscRadius ? kDiscStep : 0.0; });
  const Closed result = closed(problem_of(), profiles);
  SCOPED_TRACE(story(result));
  ASSERT_THAT(named(result), ElementsAre("step"));
  const std::vector<std::string> traces = traces_of(profiles, "first");
  EXPECT_EQ(result.rounds[0].profiles, traces);
  expect_within_4u(result.rounds[0].parameters, "step[" + joined(traces, ",") + "].height_um",
                   kDiscStep / kMicrometre);
}

TEST(Placing, LobesNeedSeveralAzimuths) {
  const Closed result = closed(problem_of({"chucking_lobes"}), quarter_faces({}, 3, kBlunt, 5));
  ASSERT_EQ(result.not_testable.size(), 1U);
  EXPECT_EQ(result.not_testable[0].effect, "chucking_lobes");
  EXPECT_EQ(result.not_testable[0].needs,
            "azimuth_deg of at least three traces in three directions");
}

/// Traces of a cone of 200 µrad, their centre off by so much.
Closed off_centre(double off) {
  std::vector<Profile> profiles =
      at_azimuths([](double x, double /*azimuth*/) { return 2e-4 * std::abs(x); }, 6);
  for (Profile& profile : profiles) profile.setup.center_mm -= off;
  return closed(problem_of({"centre_step", "centring", "traverse_datum", "linear_drift"}),
                profiles);
}

TEST(Placing, ATraceFarOffTheCentreIsNamed) {
  const Closed result = off_centre(0.4);
  SCOPED_TRACE(story(result));
  EXPECT_THAT(named(result), ElementsAre("centring"));
  const TraceRound* round = round_of(result, "centring");
  ASSERT_NE(round, nullptr);
  EXPECT_THAT(round->ambiguous_with, IsEmpty());
  expect_within_4u(round->parameters, "centring.offset_mm", 0.4);
  // The squareness takes 20 µrad from the slope, the straightness bends it.
  const FittedParameter* height = find(round->parameters, "centring.height_um");
  ASSERT_NE(height, nullptr);
  EXPECT_NEAR(*height->value, -0.18 * 0.4, 0.1 * 0.18 * 0.4);
}

// The whole face is off the centre that is declared: of z = Σ b_k r^k the odd part is -X0 z'(r)
// sgn X, the slope of the face, which is no step of the spindle.
TEST(Placing, ACurvedFaceOffTheCentreIsNoStepOfTheSpindle) {
  constexpr double kOff = 0.4;  // mm
  Problem problem = problem_of({"centre_step", "centring", "linear_drift"});
  std::vector<Profile> profiles = quarter_faces({}, 3, kBlunt, 6);
  for (Profile& profile : profiles) {
    for (std::size_t i = 0; i < profile.values.size(); ++i) {
      const double r = std::abs(profile.positions[i] - profile.setup.center_mm);
      profile.values[i] += 1e-6 * r * r * r;  // 1 µm at the rim, with a slope of 300 µm/m
    }
    profile.setup.center_mm -= kOff;
  }
  const Closed result = closed(problem, profiles);
  SCOPED_TRACE(story(result));
  EXPECT_THAT(named(result), ElementsAre("centring"));
  const TraceRound* round = round_of(result, "centring");
  ASSERT_NE(round, nullptr);
  EXPECT_THAT(round->ambiguous_with, Not(Contains("centre_step")));
}

// One offset for all serves best and predicts the others worse; so each cut has its own.
TEST(Placing, EachCutMayBeOffItsCentreByAnother) {
  std::vector<Profile> profiles =
      at_azimuths([](double x, double /*azimuth*/) { return 4e-4 * std::abs(x); }, 6);
  const std::vector<double> off{0.3, -0.5, 0.4};
  for (std::size_t i = 0; i < off.size(); ++i) profiles[i].setup.center_mm -= off[i];
  const Closed result =
      closed(problem_of({"centre_step", "centring", "traverse_periodic"}), profiles);
  SCOPED_TRACE(story(result));
  const std::vector<std::string> names = named(result);
  EXPECT_EQ(std::ranges::count(names, "centring") + std::ranges::count(names, "centre_step"), 3);
  EXPECT_EQ(names.size(), 3U);
}

// A cone of 200 µrad, each trace beside the axis by a distance of its own: it is what the height of
// its form and the slope of the face make it.
TEST(Placing, EachTraceMayPassBesideTheAxisByAnother) {
  const std::vector<double> beside{0.3, 0.7, 0.5};
  const Closed result =
      closed(problem_of({"chord", "step", "linear_drift"}),
             at_azimuths(
                 [&](double x, double azimuth) {
                   const auto trace = std::lround(azimuth * 180.0 / kPi / 50.0);
                   return 2e-4 * std::hypot(x, beside[static_cast<std::size_t>(trace)]);
                 },
                 6));
  SCOPED_TRACE(story(result));
  ASSERT_THAT(named(result), ElementsAre("chord", "chord", "chord"));
  for (const TraceRound& round : result.rounds) {
    ASSERT_EQ(round.profiles.size(), 1U);
    const std::size_t trace = round.profiles[0].back() - '1';
    expect_within_4u(round.parameters, "chord[" + round.profiles[0] + "].distance_mm",
                     beside[trace]);
  }
}

// 0.05 mm is little beside the others, and whether it is a step or off its centre does not show. It
// is there all the same, and the others are not said to be off by it.
TEST(Placing, ATraceLittleOffBesideTwoThatAreFarOffIsSeen) {
  std::vector<Profile> profiles =
      at_azimuths([](double x, double /*azimuth*/) { return 4e-4 * std::abs(x); }, 6);
  const std::vector<double> off{0.5, 0.55, 0.05};
  for (std::size_t i = 0; i < off.size(); ++i) profiles[i].setup.center_mm -= off[i];
  const Closed result =
      closed(problem_of({"centre_step", "centring", "traverse_periodic"}), profiles);
  SCOPED_TRACE(story(result));
  ASSERT_EQ(result.rounds.size(), 3U);
  for (const TraceRound& round : result.rounds) {
    ASSERT_EQ(round.profiles.size(), 1U);
    const std::string& profile = round.profiles[0];
    if (profile == "cut3") {
      std::vector<std::string> set = round.ambiguous_with;
      set.push_back(term_name(round.accepted, round.profiles));
      EXPECT_THAT(set, ::testing::IsSupersetOf({"centring[cut3]", "centre_step[cut3]"}));
    } else {
      expect_within_4u(round.parameters, "centring[" + profile + "].offset_mm",
                       profile == "cut1" ? 0.5 : 0.55);
    }
  }
}

// The last groove leaves a nub of 3 µm where the trace passes the axis, not where center_mm says.
TEST(Placing, TheNubOfAFaceOffTheCentreIsLeftOut) {
  std::vector<Profile> profiles = at_azimuths(
      [](double x, double /*azimuth*/) {
        return 4e-4 * std::abs(x) + 3e-3 * std::max(0.0, 1.0 - std::abs(x) / 0.05);
      },
      6);
  const std::vector<double> off{0.5, -0.7, 0.6};
  for (std::size_t i = 0; i < off.size(); ++i) profiles[i].setup.center_mm -= off[i];
  const Closed result = closed(problem_of({"centre_step", "centring", "linear_drift"}), profiles);
  SCOPED_TRACE(story(result));
  EXPECT_THAT(result.notes, Contains(::testing::StartsWith("the halves differ as where a trace")));
  EXPECT_NE(result.verdict, TraceVerdict::nothing_missing);
  EXPECT_NE(result.verdict, TraceVerdict::explained);  // as a step of the spindle would be
}

// 0.1 mm: lower on one side of the axis and higher on the other, as is a step of the spindle.
TEST(Placing, ATraceALittleOffTheCentreIsNoStepOfTheSpindleAlone) {
  const Closed result = off_centre(0.1);
  SCOPED_TRACE(story(result));
  ASSERT_FALSE(result.rounds.empty());
  std::vector<std::string> names = result.rounds[0].ambiguous_with;
  names.push_back(result.rounds[0].accepted);
  EXPECT_THAT(names, Contains("centring"));
}

// A shoulder beside the face falls by 5 µm over a millimetre. The trace runs 0.4 mm past the rim at
// one end; nothing past the rim is an edge that the cut has rolled off.
TEST(Placing, ATraceThatRunsPastTheRimIsLeftOutThere) {
  std::vector<Profile> profiles = at_azimuths(
      [](double x, double /*azimuth*/) {
        const double r = std::abs(x - 0.4);
        return 2e-4 * r - 5e-3 * std::max(r - kPlacedRadius, 0.0);
      },
      6);
  const Closed result = closed(problem_of({"centre_step", "centring", "edge_roll_off"}), profiles);
  SCOPED_TRACE(story(result));
  EXPECT_THAT(named(result), ElementsAre("centring"));
  EXPECT_THAT(result.notes, Contains(::testing::StartsWith("at the rim the two ends of 'cut1'")));
}

TEST(Placing, AnEdgeThatBothEndsShowIsNotLeftOut) {
  const Closed result = closed(problem_of({"centring", "edge_roll_off"}),
                               at_azimuths(
                                   [](double x, double /*azimuth*/) {
                                     return -1e-3 * std::exp((std::abs(x) - kPlacedRadius) / 0.3);
                                   },
                                   6));
  SCOPED_TRACE(story(result));
  EXPECT_THAT(named(result), ElementsAre("edge_roll_off"));
  EXPECT_THAT(result.notes, Not(Contains(::testing::StartsWith("at the rim"))));
}

}  // namespace
}  // namespace slideway
