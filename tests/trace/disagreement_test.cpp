// Profiles that should agree and do not: something is missing, whatever the residual of all says.

#include <array>
#include <random>

#include "identify/cases.hpp"
#include "slideway/effects/catalogue.hpp"
#include "time_blunder.hpp"
#include "trace/faces.hpp"

namespace slideway::disagreement_test {
namespace {

using namespace faces;  // NOLINT(google-build-using-namespace)
using ::testing::Contains;
using ::testing::HasSubstr;

constexpr double kLength = 1500.0;  // mm
constexpr double kNoise = 3e-6;     // rad

/// Readings of a level along a bed: slopes of a bow of 30 µm, and `more` rad more at the far end,
/// all of it from the middle on, growing as the square.
Profile run(const std::string& name, double more, unsigned seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> noise(0.0, kNoise);
  const std::vector<double> x = cases::spaced(0.0, kLength, 61);
  std::vector<double> slope;
  for (const double at : x)
    slope.push_back(8e-5 * (2.0 * at / kLength - 1.0) + more * std::pow(at / kLength, 2) +
                    noise(engine));
  Profile out = cases::profile(name, Kind::slide, x, slope);
  out.setup.quantity = Quantity::slope;
  return out;
}

Closed of_runs(const std::vector<Profile>& runs) {
  Problem problem = cases::problem(Lever::paper, 0, {cases::effect("straightness", 4)});
  problem.trace.candidates = effect_names();
  return closed(problem, runs);
}

// Nothing is claimed to be complete beside runs that disagree, and the one that does is told. Each
// of the runs has a smooth form of its own, which no noise of its own explains.
TEST(Disagreement, OneRunUnlikeItsSistersIsNotNothing) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const Closed result = of_runs({run("a", 0.0, 10 * seed), run("b", 0.0, 10 * seed + 1),
                                   run("c", 6e-5, 10 * seed + 2), run("d", 0.0, 10 * seed + 3)});
    SCOPED_TRACE(story(result));
    EXPECT_NE(result.verdict, TraceVerdict::nothing_missing);
    if (result.verdict == TraceVerdict::unnamed)
      EXPECT_THAT(result.advice, Contains(HasSubstr("profile c disagrees")));
    else
      EXPECT_THAT(named(result), Contains(HasSubstr("[c]")));
  }
}

// At disagreement_p = 1e-4 a false alarm among ten problems has a chance of one in a thousand.
TEST(Disagreement, RunsOfOneBedAgree) {
  for (unsigned seed = 100; seed < 110; ++seed) {
    const Closed result = of_runs(
        {run("a", 0.0, 10 * seed), run("b", 0.0, 10 * seed + 1), run("c", 0.0, 10 * seed + 2)});
    EXPECT_EQ(result.verdict, TraceVerdict::nothing_missing) << story(result);
  }
}

/// Three readings of one way of 1 m, noise of 0.3 µm; the second has a bump of its own.
std::vector<Profile> three_readings(double bump_mm, unsigned seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal(0.0, 0.3e-3);
  std::uniform_real_distribution<double> place(250.0, 750.0), width(60.0, 140.0);
  const double at = place(engine), sigma = width(engine);
  const std::vector<double> x = cases::spaced(0.0, 1000.0, 51);
  std::vector<Profile> out;
  for (const char* name : {"run1", "run2", "run3"}) {
    std::vector<double> height;
    for (const double each : x) {
      const double u = each / 1000.0, v = (each - at) / sigma;
      height.push_back(6e-3 * std::pow(std::sin(kPi * u), 2) + normal(engine) +
                       (out.size() == 1 ? bump_mm * std::exp(-0.5 * v * v) : 0.0));
    }
    out.push_back(cases::profile(name, Kind::slide, x, height));
    out.back().surface = "way";
    out.back().free_offset = out.back().free_tilt = true;
  }
  return out;
}

// The scatter of repeats is the noise, less what a hypothesis says one of them has of its own: with
// it in the noise the bump is found in none of these eight.
TEST(Disagreement, ABumpOfOneRepeatIsNoNoiseOfTheOthers) {
  int right = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    Problem problem = cases::problem(Lever::paper, 0, {cases::effect("straightness", 6)});
    problem.trace.candidates = effect_names();
    const Closed result = closed(problem, three_readings(2e-3, seed));
    SCOPED_TRACE(story(result));
    EXPECT_NE(result.verdict, TraceVerdict::nothing_missing);
    for (const TraceRound& round : result.rounds) {
      EXPECT_EQ(round.accepted, "local_form");
      EXPECT_EQ(round.profiles, std::vector<std::string>{"run2"});
      ++right;
    }
    EXPECT_THAT(named(closed(problem, three_readings(0.0, seed))), ::testing::IsEmpty());
  }
  EXPECT_GE(right, 5);
}

/// A face cut in one direction only, its noise of 10 nm, with what a saw-toothed temperature does.
std::vector<Profile> saw_toothed(double size, unsigned seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> noise(0.0, 1e-5);
  std::vector<Profile> out;
  for (const double feed : {2.0, 5.0, 3.0}) {
    const std::vector<double> x = cases::spaced(0.0, 40.0, 600);
    std::vector<double> z;
    for (const double at : x) {
      const double minutes = (40.0 - at) / feed, teeth = minutes / 1.9;
      z.push_back(2e-5 * at + size * (teeth - std::floor(teeth)) + noise(engine));
    }
    Profile& face =
        out.emplace_back(cases::profile("cut" + std::to_string(out.size() + 1), Kind::face, x, z));
    face.setup.feed_mm_per_min = feed;
    face.setup.spindle_rpm = 400.0;
    face.setup.cut_direction = CutDirection::inward;
    face.setup.cut_radius_mm = 40.0;
  }
  return out;
}

// The harmonics of a wave that is no sine are not effects beside it: time and turns are one
// variable at one speed, and "spindle" and "temperature" would be two names of one thing.
TEST(Harmonic, OfAWaveIsNoSecondEffect) {
  for (const unsigned seed : {1U, 2U}) {
    Problem problem = cases::problem(
        Lever::paper, 1, {cases::effect("squareness"), cases::effect("straightness", 3)});
    problem.trace.candidates = effect_names();
    const Closed result = closed(problem, saw_toothed(2e-4, seed));
    SCOPED_TRACE(story(result));
    EXPECT_NE(result.verdict, TraceVerdict::nothing_missing);
    EXPECT_NE(result.verdict, TraceVerdict::explained);
    EXPECT_LE(named(result).size(), 1U);
  }
}

/// From the start of a cut of 40 mm until the tool is at r.
double minutes_at(double r, double feed, CutDirection direction) {
  return (direction == CutDirection::inward ? 40.0 - r : r) / feed;
}

/// Three cuts that warm up with a time constant of three minutes, noise of 10 nm; one of them, if
/// any, with the wrong direction in its problem file.
std::vector<Profile> warmed(std::optional<std::size_t> swapped, unsigned seed,
                            double rise_mm = 3e-4) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> noise(0.0, 1e-5);
  const std::array<std::pair<double, CutDirection>, 3> cuts{
      {{2.0, CutDirection::inward}, {5.0, CutDirection::inward}, {3.0, CutDirection::outward}}};
  std::vector<Profile> out;
  for (const auto& [feed, direction] : cuts) {
    const std::vector<double> x = cases::spaced(0.2, 40.0, 600);
    std::vector<double> z;
    for (const double r : x) {
      const double minutes = minutes_at(r, feed, direction);
      z.push_back(2e-5 * r + rise_mm * (1.0 - std::exp(-minutes / 3.0)) + noise(engine));
    }
    Profile& face =
        out.emplace_back(cases::profile("cut" + std::to_string(out.size() + 1), Kind::face, x, z));
    face.setup.feed_mm_per_min = feed;
    face.setup.spindle_rpm = 400.0;
    face.setup.cut_direction = direction;
    face.setup.cut_radius_mm = 40.0;
  }
  if (swapped) swap_direction(out[*swapped]);
  return out;
}

/// Adds a function of r to the heights of a face.
template <typename Of>
void add(Profile& face, const Of& of) {
  for (std::size_t i = 0; i < face.values.size(); ++i) face.values[i] += of(face.positions[i]);
}

/// The carriages alone, every effect of the catalogue a candidate.
Problem of_carriages() {
  Problem problem = cases::problem(Lever::paper, 1,
                                   {cases::effect("squareness"), cases::effect("straightness", 3)});
  problem.trace.candidates = effect_names();
  return problem;
}

// No effect of time is declared: only what the other cuts show of one tells the direction.
TEST(Disagreement, AWrongDirectionOfOneCutIsNamedWithItsCut) {
  const Problem problem = of_carriages();
  for (const std::size_t swapped : {0U, 1U, 2U}) {
    const Closed result = closed(problem, warmed(swapped, 7));
    SCOPED_TRACE(story(result));
    ASSERT_FALSE(result.blunders.empty());
    EXPECT_EQ(result.blunders.front().profile, "cut" + std::to_string(swapped + 1));
    EXPECT_EQ(result.blunders.front().what, BlunderKind::cut_direction);
  }
  const Closed right = closed(problem, warmed(std::nullopt, 7));
  SCOPED_TRACE(story(right));
  EXPECT_TRUE(right.blunders.empty());
  EXPECT_THAT(named(right), Contains("thermal_drift"));
}

// With the right sign or unit the cuts still differ, by what the warm-up makes of their feeds.
TEST(Disagreement, AWrongSignOrUnitBesideAWarmUpIsNamedWithItsCut) {
  const Problem problem = of_carriages();
  const std::array<std::pair<double, BlunderKind>, 4> slips{{{-1.0, BlunderKind::sign},
                                                             {25.4, BlunderKind::per_inch},
                                                             {1e-3, BlunderKind::metre},
                                                             {1e3, BlunderKind::per_metre}}};
  for (const auto& [factor, kind] : slips)
    for (const std::size_t wrong : {0U, 1U, 2U}) {
      std::vector<Profile> cuts = warmed(std::nullopt, 7, 6e-4);
      for (double& value : cuts[wrong].values) value *= factor;
      const Closed result = closed(problem, cuts);
      SCOPED_TRACE(story(result));
      ASSERT_FALSE(result.blunders.empty()) << factor << " in " << cuts[wrong].name;
      EXPECT_EQ(result.blunders.front().profile, cuts[wrong].name);
      EXPECT_EQ(result.blunders.front().what, kind);
    }
}

/// What is said in the place of a turned sign of one cut.
Blunder instead_of_sign(const std::string& turned, const std::vector<Profile>& cuts) {
  const Problem problem = of_carriages();
  const FittedModel declared = fit_declared(problem, cuts);
  const TimeLimit limit(std::nullopt);
  const std::vector<ShownEffect> shown;
  ModelExtender extender(problem, cuts, declared, limit, {});
  return held_against_time({{turned, BlunderKind::sign, -100.0, 0.05}}, problem, extender, shown)
      .front();
}

// A drift turns with the direction of the cut, so with a wrong start of one cut the sign of another
// may look turned.
TEST(Disagreement, AStartThatExplainsAllIsSaidInsteadOfASign) {
  std::vector<Profile> cuts = warmed(std::nullopt, 7);
  cuts[0].setup.start_s = 600.0;
  const Blunder found = instead_of_sign("cut3", cuts);
  EXPECT_EQ(found.what, BlunderKind::clock);
  EXPECT_EQ(found.profile, "cut1");
}

// The shares of a cut that are tried first are halves and quarters: 6.2 of 13 minutes is none.
TEST(Disagreement, AStartNobodyWouldGuessIsNamedWithItsCut) {
  const Problem problem = of_carriages();
  std::vector<Profile> cuts = warmed(std::nullopt, 7);
  cuts[2].setup.start_s = 372.0;
  const Closed result = closed(problem, cuts);
  SCOPED_TRACE(story(result));
  ASSERT_FALSE(result.blunders.empty());
  EXPECT_EQ(result.blunders.front().profile, "cut3");
  EXPECT_EQ(result.blunders.front().what, BlunderKind::clock);
  EXPECT_THAT(named(result), ::testing::IsEmpty());
}

// 36 s of a cut of 8 minutes: a share of it that is tried leaves more than a tenth of how the cut
// differs, before it is moved.
TEST(Disagreement, AStartBetweenThoseTriedFirstIsNamed) {
  const Problem problem = of_carriages();
  std::vector<Profile> cuts = warmed(std::nullopt, 7, 3e-3);
  add(cuts[1], [](double r) {  // the slide had been warming for 36 s
    const double minutes = minutes_at(r, 5.0, CutDirection::inward);
    return 3e-3 * (std::exp(-minutes / 3.0) - std::exp(-(minutes + 0.6) / 3.0));
  });
  const Closed result = closed(problem, cuts);
  SCOPED_TRACE(story(result));
  ASSERT_FALSE(result.blunders.empty());
  EXPECT_EQ(result.blunders.front().profile, "cut2");
  EXPECT_EQ(result.blunders.front().what, BlunderKind::clock);
}

// Heat that bends the bed tilts the slide as well, so it shows in each cut in another way. A wrong
// start of one cut, or a tool that runs in, can come near that: neither is said alone.
TEST(Disagreement, HeatThatTiltsTheSlideIsNoWrongStart) {
  const Problem problem = of_carriages();
  const std::array<std::array<double, 4>, 4> heat{// rise, tilt at the rim, µm; their times, min
                                                  {{0.3, 0.25, 3.0, 8.0},
                                                   {0.3, -0.3, 6.0, 4.0},
                                                   {-0.1, 0.4, 2.0, 12.0},
                                                   {0.4, 0.1, 15.0, 3.0}}};
  for (const auto& [rise, tilt, lifts, tilts] : heat) {
    std::vector<Profile> cuts = warmed(std::nullopt, 7, 0.0);
    for (Profile& cut : cuts)
      add(cut, [&, rise = rise, tilt = tilt, lifts = lifts, tilts = tilts](double r) {
        const double minutes = minutes_at(r, *cut.setup.feed_mm_per_min, *cut.setup.cut_direction);
        return -1e-3 * (rise * std::expm1(-minutes / lifts) +
                        tilt * r / 40.0 * std::expm1(-minutes / tilts));
      });
    const Closed result = closed(problem, cuts);
    SCOPED_TRACE(story(result));
    EXPECT_TRUE(result.blunders.empty());
    for (const TraceRound& round : result.rounds)
      EXPECT_FALSE(round.ambiguous_with.empty()) << round.accepted;
  }
}

// Divided by 25.4 a cut that warmed up by 0.6 µm would be as flat as the others; but its noise is
// as theirs as it stands.
TEST(Disagreement, ACutUnlikeItsSistersWithNoiseLikeTheirsIsInNoOtherUnit) {
  const Problem problem = of_carriages();
  for (const unsigned seed : {7U, 8U, 9U}) {
    std::vector<Profile> cuts = warmed(std::nullopt, seed, 0.0);
    add(cuts[1], [](double r) {
      return -6e-4 * std::expm1(-minutes_at(r, 5.0, CutDirection::inward) / 1.5);
    });
    const Closed result = closed(problem, cuts);
    SCOPED_TRACE(story(result));
    EXPECT_TRUE(result.blunders.empty());
    EXPECT_NE(result.verdict, TraceVerdict::nothing_missing);
  }
}

/// Three cuts without heat, with a bow of 1.6 µm.
std::vector<Profile> bowed() {
  std::vector<Profile> out = warmed(std::nullopt, 7, 0.0);
  for (Profile& profile : out) add(profile, [](double r) { return 1e-6 * r * r; });
  return out;
}

// One cut has a crater of its own, too: more than noise is left and the cuts disagree once the sign
// of another is right, but nothing else turns a bow upside down.
TEST(Disagreement, ASignBeyondDoubtStandsBesideAnotherFault) {
  std::vector<Profile> cuts = bowed();
  add(cuts[0], [](double r) { return 5e-5 * std::exp(-std::pow((r - 20.0) / 3.0, 2)); });
  for (double& value : cuts[2].values) value = -value;
  const Problem problem = of_carriages();
  const Closed result = closed(problem, cuts);
  SCOPED_TRACE(story(result));
  ASSERT_FALSE(result.blunders.empty());
  EXPECT_EQ(result.blunders.front().profile, "cut3");
  EXPECT_EQ(result.blunders.front().what, BlunderKind::sign);
}

// Metres declared as millimetres: the whole bow lies within 40 µm of the axis, where a narrow form
// of all cuts would hide it.
TEST(Disagreement, NoEffectOutweighsAnotherUnitOfThePositions) {
  const Problem problem = of_carriages();
  std::vector<Profile> cuts = bowed();
  for (double& position : cuts[1].positions) position /= 1000.0;
  cuts[1].setup.first_mm /= 1000.0;
  cuts[1].setup.last_mm /= 1000.0;
  const Closed result = closed(problem, cuts);
  SCOPED_TRACE(story(result));
  ASSERT_FALSE(result.blunders.empty());
  EXPECT_EQ(result.blunders.front().profile, "cut2");
  EXPECT_EQ(result.blunders.front().what, BlunderKind::position_metre);
}

TEST(Disagreement, ASignThatExplainsAllStands) {
  std::vector<Profile> cuts = warmed(std::nullopt, 7, 0.0);
  for (double& value : cuts[2].values) value = -value;
  EXPECT_EQ(instead_of_sign("cut3", cuts).what, BlunderKind::sign);
}

}  // namespace
}  // namespace slideway::disagreement_test
