// What one session of a level or a straightedge has in common: a zero that drifts while station
// after station is read, and a form that a reversal turns over. The way and the readings follow the
// process: stations are read one after another, at an uneven pace.
#include <cmath>

#include "slideway/identify/identify.hpp"
#include "trace/faces.hpp"

namespace slideway {
namespace {

using namespace faces;  // NOLINT(google-build-using-namespace)
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::IsEmpty;

constexpr double kTravel = 1000.0, kBase = 200.0, kStep = 25.0;  // mm
constexpr double kZeroRate = 1.0;                                // µrad/min
constexpr double kZero = 30e-6;                                  // rad
constexpr double kNoise = 0.3e-6;                                // rad
constexpr double kBow = 20e-3;                                   // mm, over the travel

/// A way that is bent, and more so in one half.
double way(const turning::ToolPoint& tool) {
  const double u = tool.x / kTravel;
  return kBow * (4.0 * u * (u - 1.0) + 0.3 * u * u * u);
}

/// A level that is moved station by station, up the way or down; somebody had to wait once.
struct Session {
  double rate_rad_per_s = kZeroRate * 1e-6 / 60.0;
  double zero = kZero;
  double noise = kNoise;
  double settling_s = INFINITY;  // time constant: the drift comes to rest
  double rest_s = 60.0;          // of the one who had to wait
  double lean = 0.0;             // rad: by what a reading back differs where the way begins

  [[nodiscard]] Profile read(const std::string& name, bool outward, double start_s, double sign,
                             std::uint64_t seed) const {
    Profile out;
    out.name = name;
    out.setup.kind = Kind::slide;
    out.setup.quantity = Quantity::slope;
    out.setup.base_mm = kBase;
    out.setup.reversed = sign < 0.0;
    for (double x = kBase / 2.0; x <= kTravel - kBase / 2.0; x += kStep) out.positions.push_back(x);
    RandomStream random(seed, name);
    out.values =
        turning::slide_slopes(way, out.positions, kBase, {.noise = {.white = noise}}, random);
    ReadingTimes times{out.positions, {}};
    const std::size_t n = out.positions.size();
    for (std::size_t i = 0; i < n; ++i) {
      const double turn = static_cast<double>(outward ? i : n - 1 - i);
      times.times_s.push_back(start_s + 18.0 * turn + (turn > 12.0 ? rest_s : 0.0));
      out.values[i] += sign * (zero + drift(times.times_s.back()));
      out.values[i] += (outward ? -0.5 : 0.5) * lean * (1.0 - out.positions[i] / kTravel);
    }
    out.setup.first_mm = out.positions.front();
    out.setup.last_mm = out.positions.back();
    out.setup.reading_times = std::make_shared<const ReadingTimes>(std::move(times));
    return out;
  }

  [[nodiscard]] double drift(double time_s) const {
    if (std::isinf(settling_s)) return rate_rad_per_s * time_s;
    return rate_rad_per_s * settling_s * -std::expm1(-time_s / settling_s);
  }
};

/// Twice there and back, without a rest.
std::vector<Profile> there_and_back(const Session& session, std::uint64_t seed) {
  return {session.read("there", true, 0.0, 1.0, seed),
          session.read("back", false, 700.0, 1.0, seed),
          session.read("there again", true, 1400.0, 1.0, seed),
          session.read("back again", false, 2100.0, 1.0, seed)};
}

Problem bed(std::vector<DeclaredEffect> more = {}) {
  Problem problem;
  problem.bodies = Machine::paper_lathe();
  problem.low_band.level = 0;
  problem.trace.candidates = turning::face_problem().trace.candidates;
  problem.effects = {{"straightness", {.degree = 4}, {}}};
  problem.effects.insert(problem.effects.end(), more.begin(), more.end());
  return problem;
}

TEST(ZeroDrift, ThatGoesOnThereAndBackIsNamedWithItsRate) {
  const Closed result = closed(bed(), there_and_back({}, 4));
  SCOPED_TRACE(story(result));
  EXPECT_THAT(named(result), ElementsAre("zero_drift"));
  const TraceRound* round = round_of(result, "zero_drift");
  ASSERT_NE(round, nullptr);
  expect_within_4u(round->parameters, "zero_drift.rate_per_min", kZeroRate);
}

// Each reading differs from the mean of all by its part of the drift, which is no noise of theirs.
TEST(ZeroDrift, ThatGoesOnThereAndBackIsFoundBesideACurve) {
  Problem problem = bed();
  problem.effects[0].options = {.form = Form::curve};
  const Closed result = closed(problem, there_and_back({}, 4));
  SCOPED_TRACE(story(result));
  const TraceRound* round = round_of(result, "zero_drift");
  ASSERT_NE(round, nullptr);
  expect_within_4u(round->parameters, "zero_drift.rate_per_min", kZeroRate);
  EXPECT_THAT(named(closed(problem, there_and_back({.rate_rad_per_s = 0.0}, 4))), IsEmpty());
}

// Once there and once back: of one reading alone twice the drift, and a bow that takes the rest,
// explain as much. One instrument errs alike in both, so its drift stands, and E_ZX of a drift that
// is a line for certain is not as uncertain as that bow: 10.6 µrad in the 10.6 minutes of a
// reading, over 1 m 1.3 µm.
TEST(ZeroDrift, ThatGoesOnOnceThereAndBackIsThatOfBoth) {
  Problem problem = bed();
  problem.trace.gates.drift_bend = 0.0;
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    std::vector<Profile> runs = there_and_back({}, seed);
    runs.resize(2);
    const Closed result = closed(problem, runs);
    SCOPED_TRACE(story(result));
    ASSERT_THAT(named(result), ElementsAre("zero_drift"));
    EXPECT_THAT(result.rounds[0].profiles, IsEmpty());
    EXPECT_THAT(result.rounds[0].ambiguous_with, IsEmpty());
    expect_within_4u(result.final.parameters, "zero_drift.rate_per_min", kZeroRate);
    ASSERT_TRUE(result.final.straightness && result.final.straightness->expanded_uncertainty_um);
    EXPECT_LT(*result.final.straightness->expanded_uncertainty_um, 0.65);  // half of that bow
  }
}

/// Peak to valley of the way about the line through its ends, µm.
double form_of_way() {
  double low = 0.0, high = 0.0;
  for (double x = 0.0; x <= kTravel; x += 1.0) {
    const double from_line =
        way({.x = x}) - std::lerp(way({.x = 0.0}), way({.x = kTravel}), x / kTravel);
    low = std::min(low, from_line);
    high = std::max(high, from_line);
  }
  return (high - low) / kMicrometre;
}

// The bend of a drift that comes to rest is even about the turn of a session there and back, as the
// form of the way is: no reading shows it, and it bends the form. A session of 23 minutes is 0.8 to
// 3 time constants long.
TEST(ZeroDrift, ThatComesToRestLeavesTheFormOfTheWayWithinItsU) {
  for (const double settling_s : {1700.0, 850.0, 450.0})
    for (const std::uint64_t seed : {1, 2, 3, 4}) {
      std::vector<Profile> runs = there_and_back(
          {.rate_rad_per_s = 3.0 * kZeroRate * 1e-6 / 60.0, .settling_s = settling_s}, seed);
      runs.resize(2);
      const Closed result = closed(bed(), runs);
      SCOPED_TRACE(story(result));
      const ModelResult& fitted = result.final;
      ASSERT_TRUE(fitted.straightness && !fitted.straightness->errors.empty());
      const StraightnessError& error = fitted.straightness->errors.front();
      EXPECT_EQ(error.line, ReferenceLineKind::end_point);
      EXPECT_NEAR(*error.value, form_of_way(), *error.expanded_uncertainty)
          << settling_s << " " << seed;
    }
}

// A session twice as long at the same rate bends twice as much, a quarter of that in each half.
TEST(ZeroDrift, MayBendLessWhereTheWayIsReadTwiceThereAndBack) {
  const auto reach = [](std::size_t readings) {
    std::vector<Profile> runs = there_and_back({}, 1);
    runs.resize(readings);
    const Problem problem = bed({{"zero_drift", {}, {}}});
    return *identify(problem, runs, Scope::fit)
                .declared->straightness->errors.front()
                .expanded_uncertainty;
  };
  EXPECT_LT(reach(4), 0.6 * reach(2));
}

// There the drift rises with x, back it falls, and so does a lean of the carriage that depends on
// which way it goes: at one pace nothing tells them apart, and the form of the way is that of both.
TEST(Hysteresis, OfASlideIsARivalOfADriftAtOnePace) {
  const Session drifts{.rest_s = 0.0}, leans{.rate_rad_per_s = 0.0, .rest_s = 0.0, .lean = 20e-6};
  for (const Session& session : {drifts, leans})
    for (const std::uint64_t seed : {1, 2, 3}) {
      const Closed result = closed(bed(), there_and_back(session, seed));
      SCOPED_TRACE(story(result));
      ASSERT_EQ(result.rounds.size(), 1U);
      std::vector<std::string> names = result.rounds[0].ambiguous_with;
      names.push_back(result.rounds[0].accepted);
      EXPECT_THAT(names, Contains("zero_drift"));
      EXPECT_THAT(names, Contains("hysteresis"));
      ASSERT_TRUE(result.final.straightness);
      const StraightnessError& error = result.final.straightness->errors.front();
      EXPECT_NEAR(*error.value, form_of_way(), *error.expanded_uncertainty);
    }
}

// A rest within each reading is a step of the drift in it.
TEST(Hysteresis, OfASlideIsNamedWhereThePaceTellsItFromADrift) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Closed result = closed(
        bed(), there_and_back({.rate_rad_per_s = 0.0, .rest_s = 300.0, .lean = 20e-6}, seed));
    SCOPED_TRACE(story(result));
    EXPECT_THAT(named(result), ElementsAre("hysteresis"));
  }
}

TEST(ZeroDrift, IsNotNamedInASessionWithoutOne) {
  const Closed result = closed(bed(), there_and_back({.rate_rad_per_s = 0.0}, 4));
  SCOPED_TRACE(story(result));
  EXPECT_THAT(named(result), IsEmpty());
  EXPECT_THAT(result.detection_limits, Contains(Field(&DetectionLimit::effect, "zero_drift")));
}

// Nobody wrote the times down: the readings disagree, and no cause is made up.
TEST(ZeroDrift, WithoutTimesIsADisagreementOfRepeatsWithoutAName) {
  std::vector<Profile> profiles = there_and_back({}, 4);
  for (Profile& profile : profiles) profile.setup.reading_times.reset();
  const Closed result = closed(bed(), profiles);
  SCOPED_TRACE(story(result));
  EXPECT_THAT(named(result), IsEmpty());
  EXPECT_THAT(result.not_testable, Contains(Field(&NotTestable::effect, "zero_drift")));
  const Result fitted = identify(bed(), profiles, Scope::identify);
  EXPECT_THAT(fitted.crosscheck.profiles,
              Contains(Field(&ProfileCheck::verdict, Consistency::inconsistent)));
}

// Even pace, one direction: b_2 of a slope over a base is a straight line, and so is the drift.
TEST(ZeroDrift, OfOneReadingAtAnEvenPaceIsNotIdentifiableBesideABow) {
  Profile one = Session{}.read("there", true, 0.0, 1.0, 5);
  ReadingTimes times{one.positions, {}};
  for (const double x : one.positions) times.times_s.push_back(18.0 * x / kStep);
  one.setup.reading_times = std::make_shared<const ReadingTimes>(times);
  const Result result = identify(bed({{"zero_drift", {}, {}}}), {one}, Scope::fit);
  ASSERT_TRUE(result.declared);
  for (const FittedParameter& parameter : result.declared->parameters)
    if (parameter.name == "zero_drift.rate_per_min") {
      EXPECT_FALSE(parameter.identifiable);
    }
}

// One zero for all lines of a session, and one of them read again with the level turned: the
// inclination of the way comes out against gravity.
TEST(Reversal, OfALevelGivesItsZeroAndTheInclinationOfTheWay) {
  const Session session{};
  std::vector<Profile> profiles{session.read("line", true, 0.0, 1.0, 6),
                                session.read("turned", false, 900.0, -1.0, 6)};
  for (Profile& profile : profiles) profile.free_offset = profile.free_tilt = false;
  const Result result =
      identify(bed({{"instrument_zero", {}, {}}, {"zero_drift", {}, {}}}), profiles, Scope::fit);
  ASSERT_TRUE(result.declared);
  expect_within_4u(result.declared->parameters, "instrument_zero.zero", kZero * 1e6);
  expect_within_4u(result.declared->parameters, "zero_drift.rate_per_min", kZeroRate);
  expect_within_4u(result.declared->parameters, "straightness.b1", -4.0 * kBow / kTravel);
}

// The zero is known by the turned line alone: U allows for a bend of the drift, a share of its
// size, which is no doubt that there is one.
TEST(Reversal, OfALevelNamesTheDriftOfItsZero) {
  for (const double rate : {1.0, 6.0}) {
    const Session session{.rate_rad_per_s = rate * 1e-6 / 60.0};
    std::vector<Profile> profiles{session.read("line", true, 0.0, 1.0, 6),
                                  session.read("back", false, 700.0, 1.0, 6),
                                  session.read("turned", true, 1400.0, -1.0, 6)};
    for (Profile& profile : profiles) profile.free_offset = profile.free_tilt = false;
    const Closed result = closed(bed({{"instrument_zero", {}, {}}}), profiles);
    SCOPED_TRACE(story(result));
    EXPECT_THAT(named(result), ElementsAre("zero_drift"));
    const TraceRound* round = round_of(result, "zero_drift");
    ASSERT_NE(round, nullptr);
    expect_within_4u(round->parameters, "zero_drift.rate_per_min", rate);
  }
}

/// An indicator on the carriage along a straightedge; the edge is turned over for the second line.
std::vector<Profile> straightedge(std::uint64_t seed) {
  std::vector<Profile> out;
  for (const double sign : {1.0, -1.0}) {
    Profile& profile = out.emplace_back();
    profile.name = sign > 0.0 ? "edge up" : "edge down";
    profile.setup.kind = Kind::slide;
    profile.setup.reversed = sign < 0.0;
    for (double x = 0.0; x <= kTravel; x += kStep) profile.positions.push_back(x);
    RandomStream random(seed, profile.name);
    profile.values =
        turning::slide_heights(way, profile.positions, {.noise = {.white = 0.1e-3}}, random);
    for (std::size_t i = 0; i < profile.positions.size(); ++i) {
      const double u = 2.0 * profile.positions[i] / kTravel - 1.0;
      profile.values[i] += sign * 1e-3 * (-0.8 * u * u + 0.3 * u * u * u) + 5e-6 * (1.0 + u);
    }
    profile.setup.first_mm = profile.positions.front();
    profile.setup.last_mm = profile.positions.back();
  }
  return out;
}

// u² = (2 P_2 + 1) / 3, u³ = (2 P_3 + 3 P_1) / 5; the way is 4 u (u - 1) + 0.3 u³ over its travel.
TEST(Reversal, OfAStraightedgeTellsItsFormFromThatOfTheWay) {
  const Problem problem = bed({{"artefact_form", {.degree = 4}, {}}});
  const Result result = identify(problem, straightedge(7), Scope::identify);
  ASSERT_TRUE(result.declared);
  const std::vector<FittedParameter>& found = result.declared->parameters;
  expect_within_4u(found, "artefact_form.a2_um", -0.8 * 2.0 / 3.0);
  expect_within_4u(found, "artefact_form.a3_um", 0.3 * 2.0 / 5.0);
  expect_within_4u(found, "artefact_form.a4_um", 0.0);
  expect_within_4u(found, "straightness.b2", 4.0 * kBow / std::pow(kTravel, 2));
  expect_within_4u(found, "straightness.b3", 0.3 * kBow / std::pow(kTravel, 3));
}

TEST(Reversal, ThatIsNotSaidLeavesTheTwoLinesInDisagreement) {
  std::vector<Profile> profiles = straightedge(7);
  for (Profile& profile : profiles) profile.setup.reversed = false;
  const Result result = identify(bed(), profiles, Scope::identify);
  EXPECT_THAT(result.crosscheck.profiles,
              Contains(Field(&ProfileCheck::verdict, Consistency::inconsistent)));
}

TEST(Reversal, NamesTheFormOfTheArtefactThatNobodyDeclared) {
  const Closed result = closed(bed(), straightedge(7));
  SCOPED_TRACE(story(result));
  EXPECT_THAT(named(result), ElementsAre("artefact_form"));
}

// Without a reversal the two forms are one column: said before any fit.
TEST(Reversal, IsAskedForWhereTheFormOfAnArtefactIsLookedFor) {
  std::vector<Profile> profiles = straightedge(7);
  profiles.pop_back();
  const Closed result = closed(bed(), profiles);
  SCOPED_TRACE(story(result));
  EXPECT_THAT(result.not_testable, Contains(Field(&NotTestable::effect, "artefact_form")));
}

}  // namespace
}  // namespace slideway
