#include "slideway/identify/agreement.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "identify/cases.hpp"
#include "repeats.hpp"
#include "slideway/base/random.hpp"
#include "slideway/identify/held_out.hpp"
#include "slideway/identify/identify.hpp"
#include "slideway/identify/noise_model.hpp"

namespace slideway::agreement_test {
namespace {

constexpr std::size_t kReadings = 200;
constexpr double kNoise = 1e-4;    // mm
constexpr double kLength = 400.0;  // mm

/// Heights of a slide with a bow of `bow` mm at the end, white noise, levelling free.
Profile run(const std::string& name, double bow, unsigned seed, double step_mm = 0.0) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> noise(0.0, kNoise);
  const std::vector<double> x = cases::spaced(0.0, kLength, kReadings);
  std::vector<double> z;
  for (const double at : x)
    z.push_back(bow * std::pow(at / kLength, 2) + (at > 0.7 * kLength ? step_mm : 0.0) +
                noise(engine));
  return cases::profile(name, Kind::slide, x, z);
}

Problem straight() { return cases::problem(Lever::paper, 0, {cases::effect("straightness", 3)}); }

double bump_at(double mm, double place_mm) {
  return std::exp(-0.5 * std::pow((mm - place_mm) / 20.0, 2));
}

std::vector<ProfileCheck> checks_of(const std::vector<Profile>& profiles,
                                    const Problem& problem = straight()) {
  const FittedModel fitted = fit_declared(problem, profiles);
  return check_profiles(fitted.model, fitted.fit,
                        noise_of_each(fitted.fit.linear, fitted.fit.noise, fitted.model.gates));
}

TEST(ProfileCheck, ComparesEveryPair) {
  const auto checks = checks_of({run("a", 5e-3, 1), run("b", 5e-3, 2), run("c", 5e-3, 3)});
  ASSERT_EQ(checks.size(), 4U);  // each pair, and all at once
  EXPECT_THAT(checks[1].profiles, ::testing::ElementsAre("a", "c"));
  EXPECT_EQ(checks[1].what, "straightness");
  for (const ProfileCheck& check : checks) EXPECT_EQ(check.verdict, Consistency::consistent);
}

TEST(ProfileCheck, OneBowThatDiffersDisagreesWithBothOthers) {
  // The sags differ by 0.5 µm; u of one from 200 values is about 0.03 µm.
  const auto checks = checks_of({run("a", 5e-3, 1), run("b", 5e-3, 2), run("c", 7e-3, 3)});
  ASSERT_EQ(checks.size(), 4U);
  EXPECT_EQ(checks[0].verdict, Consistency::consistent);
  EXPECT_EQ(checks[1].verdict, Consistency::inconsistent);
  EXPECT_EQ(checks[2].verdict, Consistency::inconsistent);
  EXPECT_GT(*checks[1].En, 1.0);
  EXPECT_LT(*checks[1].p_value, 1e-3);
}

// What levelling takes of a column is its rounding, which says nothing of the profiles.
TEST(ProfileCheck, IsTheSameWhateverLevellingTakes) {
  std::vector<Profile> runs{run("a", 5e-3, 1), run("b", 5e-3, 2), run("c", 5e-3, 3)};
  const auto before = checks_of(runs);
  for (Profile& profile : runs)
    for (std::size_t i = 0; i < profile.values.size(); ++i)
      profile.values[i] += 0.1 + 1e-4 * profile.positions[i];
  const auto after = checks_of(runs);
  ASSERT_EQ(after.size(), before.size());
  // The heights have 0.1 mm and noise 1e-4 mm: rounding is 1e-13 of the noise.
  for (std::size_t c = 0; c < before.size(); ++c) {
    EXPECT_NEAR(*after[c].En, *before[c].En, 1e-6);
    EXPECT_NEAR(*after[c].chi2, *before[c].chi2, 1e-6);
  }
}

TEST(ProfileCheck, FalseAlarmsStayNearTheirShare) {
  // 4.55 % of 100 reports: 11 or more have a probability of 0.5 %.
  int alarms = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    const auto checks = checks_of(
        {run("a", 5e-3, 3 * seed + 1), run("b", 5e-3, 3 * seed + 2), run("c", 5e-3, 3 * seed + 3)});
    alarms += std::ranges::any_of(checks, [](const ProfileCheck& check) {
      return check.verdict == Consistency::inconsistent;
    });
  }
  EXPECT_LE(alarms, 10);
}

// Eight bows, every second one of a = 7 σ more: χ² of 14 degrees of freedom with a non-centrality
// of 8 (a/2)² n / (180 σ²) = 109. Of 29 comparisons each has 0.16 %, χ² > 34.7, which noise known
// to be white would exceed in all of 20; it is an estimate, and may have a memory.
TEST(ProfileCheck, SmallDifferencesOfManyAddUp) {
  const auto seen = [](double a) {
    std::pair<int, int> out;  // taken together, and in any pair
    for (unsigned seed = 0; seed < 20; ++seed) {
      std::vector<Profile> runs;
      for (unsigned i = 0; i < 8; ++i)
        runs.push_back(run("run" + std::to_string(i), 5e-3 + (i % 2) * a, 100 + 8 * seed + i));
      std::vector<ProfileCheck> checks = checks_of(runs);
      const ProfileCheck all = checks.back();
      checks.pop_back();
      EXPECT_EQ(all.what, "effects taken together");
      EXPECT_EQ(all.profiles.size(), 8U);
      out.first += all.verdict == Consistency::inconsistent;
      out.second += std::ranges::any_of(checks, [](const ProfileCheck& check) {
        return check.verdict == Consistency::inconsistent;
      });
    }
    return out;
  };
  EXPECT_LE(seen(0.0).first, 1);  // two of 20 have a probability of 0.05 %
  const auto [together, pairs] = seen(7.0 * kNoise);
  EXPECT_GE(together, 17);  // fewer of 20: 0.3 % if it is seen in 95 %
  EXPECT_GE(together, pairs);
}

/// Readings of a kinked slide by an instrument whose errors remember, the last with a bump of so
/// many of its standard deviations over a tenth of the travel; the form declared as a curve.
std::vector<ProfileCheck> checks_of_curves(double bump, unsigned seed) {
  std::vector<Profile> runs;
  for (const char* name : {"a", "b", "c"}) {
    RandomStream random(seed, name);
    const std::vector<double> x = cases::spaced(0.0, kLength, 81);
    std::vector<double> z;
    double error = random.normal();
    for (const double at : x) {
      z.push_back(20e-6 * std::max(at - 0.6 * kLength, 0.0) +
                  kNoise * std::sqrt(0.5) * (error + random.normal()));
      error = 0.7 * error + std::sqrt(0.51) * random.normal();
      if (*name == 'c') z.back() += bump * kNoise * bump_at(at, 0.4 * kLength);
    }
    runs.push_back(cases::profile(name, Kind::slide, x, z));
  }
  Problem problem = cases::problem(Lever::paper, 0, {cases::effect("straightness")});
  problem.effects.front().options.form = Form::curve;
  return checks_of(runs, problem);
}

// What two runs have from the prior of the curve is no noise of either, and no agreement.
TEST(ProfileCheck, OfCurvesIsAsTheirNoise) {
  // 4.55 % of 20 reports: 5 or more have a probability of 0.2 %.
  int alarms = 0;
  double mean = 0.0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const auto checks = checks_of_curves(0.0, seed);
    ASSERT_EQ(checks.size(), 4U);
    alarms += std::ranges::any_of(checks, [](const ProfileCheck& check) {
      return check.verdict == Consistency::inconsistent;
    });
    mean += *checks[0].chi2 / 20.0;
  }
  EXPECT_LE(alarms, 4);
  EXPECT_NEAR(mean, 1.0, 0.28);  // the noise is an estimate, too
  int seen = 0;                  // a bump of less may pass for a memory of the noise
  for (unsigned seed = 0; seed < 10; ++seed) {
    const auto checks = checks_of_curves(50.0, seed);
    seen += checks[1].verdict == Consistency::inconsistent &&
            checks[2].verdict == Consistency::inconsistent;
  }
  EXPECT_GE(seen, 9);
}

/// Two faces of one squareness, and what is compared of them under a model with one effect more.
std::vector<std::string> compared_beside(const std::string& effect,
                                         const std::vector<std::string>& in) {
  std::vector<Profile> faces;
  for (const std::string name : {"a", "b"}) {
    RandomStream random(9, name);
    const std::vector<double> r = cases::spaced(0.0, 20.0, kReadings);
    std::vector<double> z;
    for (const double at : r) z.push_back(-1e-5 * at + kNoise * random.normal());
    faces.push_back(cases::face(name, 2.0, r, z));
  }
  Problem problem = cases::problem(Lever::paper, 0, {cases::effect("squareness")});
  problem.effects.push_back(cases::effect(effect));
  problem.effects.back().options.profiles = in;
  std::vector<std::string> out;
  for (const ProfileCheck& check : checks_of(faces, problem)) out.push_back(check.what);
  return out;
}

TEST(ProfileCheck, ComparesNothingThatEachCutHasOrOneProfileAlone) {
  EXPECT_THAT(compared_beside("cup", {}), ::testing::ElementsAre("squareness", "cup"));
  EXPECT_THAT(compared_beside("cup", {"b"}), ::testing::ElementsAre("squareness"));
  EXPECT_THAT(compared_beside("feed_marks", {}), ::testing::ElementsAre("squareness"));
}

// The nose of the tool takes off the crests of a wave that is finer than the low band, more of them
// in some cuts than in others. Of 200 values the low band shows 50 cycles.
TEST(ProfileCheck, AFineWaveMayHaveAnotherSizeInEachCut) {
  const auto disagree = [](double period_mm) {
    std::vector<Profile> faces;
    for (const auto& [name, share] : {std::pair{"a", 1.0}, {"b", 0.6}, {"c", 0.3}}) {
      RandomStream random(9, name);
      const std::vector<double> r = cases::spaced(0.0, 20.0, kReadings);
      std::vector<double> z;
      for (const double at : r)
        z.push_back(-1e-5 * at + kNoise * random.normal() +
                    5.0 * share * kNoise * std::sin(2.0 * std::numbers::pi * at / period_mm));
      faces.push_back(cases::face(name, 2.0, r, z));
    }
    Problem problem = cases::problem(Lever::paper, 0, {cases::effect("squareness")});
    problem.effects.push_back(cases::effect("slide_periodic"));
    const auto checks = checks_of(faces, problem);
    EXPECT_FALSE(checks.empty());
    return std::ranges::any_of(checks, [](const ProfileCheck& check) {
      return check.verdict == Consistency::inconsistent;
    });
  };
  EXPECT_FALSE(disagree(0.3));
  EXPECT_TRUE(disagree(4.0));
}

// Of three profiles of equal weight one is off by d: the estimates without one each are d/3 above
// their mean once, d/6 below it twice, so u = sqrt(2/3 (1/9 + 2/36)) d = d/3, as much as the joint
// estimate is off.
TEST(ScatterOfProfiles, OfOneUnlikeOfThreeIsAThirdOfItsDifference) {
  constexpr double kMore = 1e-6;  // mm of sag: too little to move the weights
  std::vector<Profile> profiles{run("a", 5e-3, 1), run("b", 5e-3, 1), run("c", 5e-3 + kMore, 1)};
  for (Profile& profile : profiles) profile.standard_uncertainty = kNoise;
  const FittedModel fitted = fit_declared(straight(), profiles);
  const Eigen::RowVectorXd b2 = fitted.fit.parameters.jacobian.row(2);
  const double expected = kMore / (kLength * kLength) / 3.0;
  // 1e-4: of numbers a thousand times as large.
  EXPECT_NEAR((b2 * scatter_of_profiles(fitted.fit, fitted.model.gates)).norm(), expected,
              1e-4 * expected);
}

TEST(ProfileCheck, NothingIsComparedThatOneProfileCannotTell) {
  EXPECT_TRUE(checks_of({run("a", 5e-3, 1)}).empty());
}

TEST(ProfileCheck, OddIsTheOneInEveryPair) {
  EXPECT_EQ(odd_profile({}), "");
  EXPECT_EQ(odd_profile({{"a", "b"}}), "");
  EXPECT_EQ(odd_profile({{"a", "b"}, {"b", "c"}}), "b");
  EXPECT_EQ(odd_profile({{"a", "b"}, {"b", "c"}, {"a", "c"}}), "");
  EXPECT_EQ(odd_profile({{"a", "all others"}}), "a");
  EXPECT_EQ(odd_profile({{"a", "all others"}, {"b", "all others"}}), "");
  EXPECT_EQ(odd_profile({{"a", "b"}, {"a", "b", "c"}, {"b", "c"}}), "b");
}

TEST(ProfileCheck, DisagreementIsNegative) {
  Result result;
  EXPECT_FALSE(is_negative(result));
  result.crosscheck.profiles = {
      {{"a", "b"}, "straightness", 1.2, Consistency::inconsistent, {}, {}}};
  EXPECT_TRUE(is_negative(result));
}

std::vector<HeldOutCheck> held_out(Profile last, std::optional<double> declared = std::nullopt) {
  last.role = Role::holdout;
  std::vector<Profile> profiles{run("a", 5e-3, 1), run("b", 5e-3, 2), std::move(last)};
  for (Profile& profile : profiles) profile.standard_uncertainty = declared;
  const FittedModel fitted = fit_declared(straight(), profiles);
  return check_held_out(fitted.model, fitted.fit,
                        noise_of_each(fitted.fit.linear, fitted.fit.noise, fitted.model.gates));
}

TEST(HeldOutCheck, FitsWhatItRepeats) {
  const auto checks = held_out(run("c", 5e-3, 3));
  ASSERT_EQ(checks.size(), 1U);
  EXPECT_EQ(checks[0].verdict, HeldOutVerdict::fits);
  EXPECT_NEAR(checks[0].chi2, 1.0, 0.4);  // of 198 degrees of freedom: four standard deviations
}

TEST(HeldOutCheck, DoesNotFitWhereItHasAStep) {
  const auto checks = held_out(run("c", 5e-3, 3, 10.0 * kNoise));
  ASSERT_EQ(checks.size(), 1U);
  EXPECT_EQ(checks[0].verdict, HeldOutVerdict::does_not_fit);
  EXPECT_NEAR(checks[0].at_mm, 0.7 * kLength, 0.05 * kLength);  // the levelled step peaks there
  EXPECT_GT(std::abs(*checks[0].largest_um), 3.0 * kNoise / kMicrometre);
}

// At held_out_p = 0.01 five or more of 60 have a chance of 4e-4. 198 squares of 1.5 times the noise
// are 12 standard deviations above their mean.
TEST(HeldOutCheck, UnderADeclaredNoiseHasItsShareOfFalseAlarms) {
  int alarms = 0;
  for (unsigned seed = 3; seed < 63; ++seed)
    alarms += held_out(run("c", 5e-3, seed), kNoise)[0].verdict == HeldOutVerdict::does_not_fit;
  EXPECT_LE(alarms, 4);
  Profile loud = run("c", 5e-3, 3);
  std::mt19937_64 engine(77);
  std::normal_distribution<double> more(0.0, std::sqrt(1.25) * kNoise);
  for (double& value : loud.values) value += more(engine);
  EXPECT_EQ(held_out(loud, kNoise)[0].verdict, HeldOutVerdict::does_not_fit);
}

// Its own low band has half as many values, whose noise is no fitted profile's.
TEST(HeldOutCheck, OfAnotherLowBandHasANoiseOfItsOwn) {
  std::vector<Profile> profiles;
  for (const std::string name : {"a", "b", "c"}) {
    RandomStream random(4, name);
    Profile& one = profiles.emplace_back(run(name, 5e-3, 1));
    double error = 0.0;
    for (std::size_t i = 0; i < one.values.size(); ++i) {
      error = 0.9 * error + random.normal();
      one.values[i] = 5e-3 * std::pow(one.positions[i] / kLength, 2) + kNoise * error;
    }
  }
  profiles[2].role = Role::holdout;
  profiles[2].low_band = LowBandOptions{};
  profiles[2].low_band->level = 1;
  const FittedModel fitted = fit_declared(straight(), profiles);
  const auto checks =
      check_held_out(fitted.model, fitted.fit,
                     noise_of_each(fitted.fit.linear, fitted.fit.noise, fitted.model.gates));
  ASSERT_EQ(checks.size(), 1U);
  EXPECT_EQ(checks[0].verdict, HeldOutVerdict::fits);
  EXPECT_NEAR(checks[0].chi2, 1.0, 0.5);  // of some 97, under a noise estimated from as many
}

TEST(Repeats, AreToldByStationsNotByEqualDoubles) {
  Profile a = run("a", 5e-3, 1), b = run("b", 5e-3, 2), c = run("c", 5e-3, 3);
  for (double& at : b.positions) at += 8e-6;  // as the files of two mirrors differ
  for (double& at : c.positions) at += 1.0;   // half a station
  const std::vector<Profile> profiles{a, b, c};
  const FittedModel fitted = fit_declared(straight(), profiles);
  EXPECT_THAT(repeat_groups(fitted.fit.linear, Gates{}),
              ::testing::ElementsAre(::testing::ElementsAre(0U, 1U)));
}

TEST(Repeats, WhatTheyShareAndTheModelLacksIsLackOfFit) {
  const auto verdict = [](double amplitude) {
    std::vector<Profile> profiles{run("a", 5e-3, 1), run("b", 5e-3, 2)};
    for (Profile& each : profiles)
      for (std::size_t i = 0; i < each.values.size(); ++i)
        each.values[i] += amplitude * std::sin(6.0 * kPi * each.positions[i] / kLength);
    const FittedModel fitted = fit_declared(straight(), profiles);
    const auto checks = check_repeats(fitted.fit.linear, Gates{});
    return checks.at(0).verdict;
  };
  EXPECT_EQ(verdict(0.0), RepeatFit::fits);
  EXPECT_EQ(verdict(kNoise), RepeatFit::lack_of_fit);  // three waves, of 200 values
}

// A texture of four lengths, 1 to 10 of 200 values (autoregressive processes of one size), repeats.
// Lack of fit is asked for at 1 %: four of forty surfaces have it by chance once in 1400 times.
TEST(Repeats, ATextureOfSeveralLengthsIsNoLackOfFit) {
  int lacks = 0;
  for (unsigned surface = 0; surface < 40; ++surface) {
    std::vector<Profile> profiles{run("a", 5e-3, 2 * surface + 1), run("b", 5e-3, 2 * surface + 2)};
    RandomStream random(surface, "texture");
    for (const double length : {1.0, 2.0, 5.0, 10.0}) {
      const double keep = std::exp(-1.0 / length);
      double texture = kNoise * random.normal();
      for (std::size_t i = 0; i < profiles.front().values.size(); ++i) {
        for (Profile& each : profiles) each.values[i] += texture;
        texture = keep * texture + std::sqrt(1.0 - keep * keep) * kNoise * random.normal();
      }
    }
    const FittedModel fitted = fit_declared(straight(), profiles);
    const auto checks = check_repeats(fitted.fit.linear, Gates{});
    lacks += checks.at(0).verdict == RepeatFit::lack_of_fit ? 1 : 0;
  }
  EXPECT_LE(lacks, 3);
}

/// Runs of white noise, the last with a bump of so many deviations over a tenth of the travel.
std::vector<OddRepeat> odd_of(std::size_t count, double bump, unsigned seed) {
  std::vector<Profile> profiles;
  for (unsigned k = 0; k < count; ++k)
    profiles.push_back(run(std::string(1, static_cast<char>('a' + k)), 5e-3, 10 * seed + k));
  Profile& last = profiles.back();
  for (std::size_t i = 0; i < last.values.size(); ++i)
    last.values[i] += bump * kNoise * bump_at(last.positions[i], 0.6 * kLength);
  return odd_repeats(fit_declared(straight(), profiles).fit.linear, Gates{});
}

TEST(Repeats, TheOneWithABumpIsOdd) {
  for (const std::size_t count : {3U, 4U, 6U})
    for (unsigned seed = 1; seed <= 5; ++seed) {
      const std::vector<OddRepeat> odd = odd_of(count, 8.0, seed);
      ASSERT_EQ(odd.size(), 1U) << count << " runs, seed " << seed;
      EXPECT_EQ(odd.front().profile, count - 1);
      EXPECT_LT(odd.front().p_value, Gates{}.disagreement_p);
    }
}

/// Three runs under white noise or, of the same size, a random walk; the last with a bump.
double probability_of_last(bool walks, double bump, unsigned seed) {
  std::vector<Profile> profiles;
  for (const char* name : {"a", "b", "c"}) {
    RandomStream random(seed, name);
    Profile& one = profiles.emplace_back(run(name, 0.0, 1));
    double error = 0.0;
    for (std::size_t i = 0; i < one.values.size(); ++i) {
      error = walks ? error + random.normal() / std::sqrt(kReadings / 6.0) : random.normal();
      one.values[i] = kNoise * error;
      if (*name == 'c') one.values[i] += bump * kNoise * bump_at(one.positions[i], 0.6 * kLength);
    }
  }
  return probability_beside_repeats(fit_declared(straight(), profiles).fit.linear, 2, Gates{});
}

// A probability of 5 % is found 10 times in 200: 19 or more have a chance of 0.5 %.
TEST(Repeats, ProbabilityBesideThemIsOneUnderAnyNoise) {
  for (const bool walks : {false, true}) {
    int below = 0;
    for (unsigned seed = 1; seed <= 200; ++seed)
      below += probability_of_last(walks, 0.0, seed) < 0.05;
    EXPECT_LE(below, 18) << walks;
  }
  for (unsigned seed = 1; seed <= 10; ++seed)
    EXPECT_LT(probability_of_last(false, 8.0, seed), Gates{}.held_out_p);
}

TEST(Repeats, ThatAreTheSameToTheLastDigitAreNotOdd) {
  std::vector<Profile> profiles(3, run("a", 0.0, 1));
  for (Profile& each : profiles) std::ranges::fill(each.values, 0.0);
  profiles[1].name = "b", profiles[2].name = "c";
  const FittedModel fitted = fit_declared(straight(), profiles);
  EXPECT_EQ(probability_beside_repeats(fitted.fit.linear, 0, Gates{}), 1.0);
}

// Of two, either may be the odd one.
TEST(Repeats, OfTwoNoneIsOdd) { EXPECT_TRUE(odd_of(2, 50.0, 1).empty()); }

// At disagreement_p = 1e-4 a false alarm in a hundred problems has a chance of one in a hundred.
TEST(Repeats, WhiteNoiseMakesNoneOdd) {
  for (unsigned seed = 1; seed <= 50; ++seed)
    for (const std::size_t count : {3U, 5U})
      EXPECT_TRUE(odd_of(count, 0.0, seed).empty()) << count << " runs, seed " << seed;
}

}  // namespace
}  // namespace slideway::agreement_test
