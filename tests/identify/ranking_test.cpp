#include "slideway/identify/ranking.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "base/temporary_folder.hpp"
#include "identify/cases.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/random.hpp"
#include "support/turning.hpp"

namespace slideway {
namespace {

class ColumnFile : public ::testing::Test {
 protected:
  ColumnFile() {
    // y with each candidate: 4/5 by hand (Σ xy = 8, Σ x² = Σ y² = 10 about the means), -1, 0.
    path_ = folder_.file("columns.csv",
                         "y,close,against,apart\n"
                         "1,2,-1,1\n2,1,-2,-2\n3,4,-3,2\n4,3,-4,-2\n5,5,-5,1\n");
  }

  TemporaryFolder folder_;
  std::filesystem::path path_;
};

TEST_F(ColumnFile, RanksColumnsByTheSizeOfPearsonsCoefficient) {
  LowBandOptions raw;
  raw.level = 0;
  const auto ranking = rank_columns(path_, "y", {"apart", "close", "against"}, raw);
  ASSERT_EQ(ranking.size(), 3u);
  EXPECT_EQ(ranking[0].candidate, "against");
  EXPECT_NEAR(ranking[0].low_band, -1.0, 1e-15);
  EXPECT_EQ(ranking[1].candidate, "close");
  EXPECT_NEAR(ranking[1].raw, 0.8, 1e-15);
  EXPECT_NEAR(ranking[1].low_band, 0.8, 1e-15);
  EXPECT_EQ(ranking[2].candidate, "apart");
  EXPECT_NEAR(ranking[2].raw, 0.0, 1e-15);
}

TEST_F(ColumnFile, NamesAColumnThatIsNotThere) {
  try {
    rank_columns(path_, "y", {"farther"}, {});
    FAIL() << "a missing column was ranked";
  } catch (const DataError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("farther"));
  }
}

/// A cone of 20 µrad with 1 nm of curvature under it, without feed marks or noise.
struct ConeCase {
  ModelResult summary;
  RankingResult ranking;
  std::optional<LeadByFit> lead;

  /// @param curvature  of the straightness's amplitudes in the ranking, against those of the fit
  explicit ConeCase(double curvature = 1.0) {
    const std::vector<double> radii = cases::spaced(0.0, 10.0, 640);
    std::vector<double> heights;
    for (const double r : radii) heights.push_back(-2e-5 * r - 1e-8 * r * r);
    const std::vector<Profile> profiles{cases::face("cone", 2.0, radii, heights)};
    const Model model =
        build_model(cases::problem(Lever::paper, 5,
                                   {cases::effect("straightness", 2), cases::effect("squareness")}),
                    profiles);
    Solution result = fit(model);
    const ModelTerm& straightness = model.terms.front();
    result.estimate.amplitudes.segment(straightness.first_amplitude,
                                       straightness.effect->amplitudes()) *= curvature;
    summary = summarise(model, result);
    ranking = rank_effects(model, result);
    lead = lead_by_fit(model, result);
  }

  [[nodiscard]] const Ranking& of(const std::string& effect) const {
    return *std::find_if(ranking.entries.begin(), ranking.entries.end(),
                         [&](const Ranking& entry) { return entry.effect == effect; });
  }
};

TEST(Ranking, OfAConeIsPerfectForTheCone) {
  const ConeCase cone;
  ASSERT_EQ(cone.ranking.entries.size(), 2u);
  // 1 nm of r² beside 200 nm of r leaves 1 - 1e-6: the part of r² that is no line is 0.07 of it.
  EXPECT_GT(cone.of("squareness").raw, 0.99999);
  EXPECT_GT(cone.of("squareness").low_band, 0.99999);
  EXPECT_EQ(cone.of("squareness").running.raw.size(), 200u);
}

TEST(Ranking, CanNotTellConeFromParabolaOverARadius) {
  // Pearson of r and r² on [0, 1]: (1/4 - 1/6) / sqrt(1/12 · 4/45) = sqrt(15)/4 = 0.968.
  const ConeCase cone;
  ASSERT_EQ(cone.ranking.among_candidates.size(), 1u);
  // Sums over 20 low-band values instead of integrals: second order in 1/20.
  EXPECT_NEAR(std::abs(cone.ranking.among_candidates[0].coefficient), std::sqrt(15.0) / 4.0, 2e-3);
}

TEST(Ranking, OfASignalThatIsOnlyRoundingIsZero) {
  EXPECT_GT(std::abs(ConeCase(1e-3).of("straightness").low_band), 0.9);
  EXPECT_EQ(ConeCase(1e-12).of("straightness").low_band, 0.0);
}

/// Pearson's coefficient of two columns as textbooks have it, in long double.
double plain_pearson(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<long double>(x.size());
  long double mx = 0, my = 0, xx = 0, yy = 0, xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) mx += x[i] / n, my += y[i] / n;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mx) * (x[i] - mx);
    yy += (y[i] - my) * (y[i] - my);
    xy += (x[i] - mx) * (y[i] - my);
  }
  return static_cast<double>(xy / std::sqrt(xx * yy));
}

/// A cone of 20 µrad over a diameter of 20 mm, traced with a tilt of 100 µrad and, where asked, a
/// roughness that no effect of the model makes.
struct TiltedCone {
  std::vector<double> positions = cases::spaced(-10.0, 10.0, 1280), heights;
  RankingResult ranking;

  explicit TiltedCone(bool tilt_is_free) {
    for (const double s : positions)
      heights.push_back(1e-4 * s - 2e-5 * std::abs(s) + 2e-6 * std::sin(40.0 * s));
    std::vector<Profile> profiles{cases::face("cone", 2.0, positions, heights)};
    profiles[0].free_tilt = tilt_is_free;
    const FittedModel fitted = fit_declared(
        cases::problem(Lever::paper, 4, {cases::effect("squareness"), cases::effect("cup")}),
        profiles);
    ranking = rank_effects(fitted.model, fitted.fit);
  }
};

// Of a line of slope a and a cone of slope c over [-R, R] the variances are a² R²/3 and c² R²/12:
// Pearson's coefficient of the cone with their sum is 1 / sqrt(1 + 4 a²/c²) = 0.0995.
TEST(Ranking, TakesAFreeTiltOutOfProfileAndEffect) {
  const TiltedCone free(true);
  EXPECT_GT(free.ranking.entries[0].low_band, 0.999);
  EXPECT_GT(free.ranking.entries[0].raw, 0.999);
  const TiltedCone fixed(false);
  const double alone = 1.0 / std::sqrt(1.0 + 4.0 * 25.0);
  EXPECT_NEAR(fixed.ranking.entries[0].raw, alone, 1e-3);  // 1280 samples instead of an integral
  EXPECT_NEAR(fixed.ranking.entries[0].low_band, alone, 5e-3);  // 80 values, 2 at the axis left out
}

TEST(Ranking, IsThePapersCoefficientWhereNoTiltIsFree) {
  const TiltedCone fixed(false);
  std::vector<double> cone;
  for (const double s : fixed.positions) cone.push_back(-std::abs(s));
  // The last digits of sums over 1280 samples.
  EXPECT_NEAR(fixed.ranking.entries[0].raw, plain_pearson(fixed.heights, cone), 1e-12);
}

TEST(Ranking, RunsAlongPositionsInMillimetres) {
  const TiltedCone cone(true);
  const RunningSeries& running = cone.ranking.entries[0].running;
  ASSERT_EQ(running.position_mm.size(), running.raw.size());
  ASSERT_EQ(running.low_band_position_mm.size(), running.low_band.size());
  EXPECT_EQ(running.position_mm.back(), 10.0);
  EXPECT_EQ(running.low_band.size(), 80U);
  // The last of 80 means of 16 samples, 20 mm / 1279 apart, stands 7.5 samples before the end.
  EXPECT_NEAR(running.low_band_position_mm.back(), 10.0 - 7.5 * 20.0 / 1279.0, 1e-9);
  EXPECT_EQ(running.raw.back(), cone.ranking.entries[0].raw);
  EXPECT_NEAR(running.low_band.back(), cone.ranking.entries[0].low_band, 1e-12);  // sums' order
}

// A tilt that is free takes a cone over a radius with it: nothing is left to correlate.
TEST(Ranking, OfAnEffectThatLevellingTakesAwayIsZero) {
  const std::vector<double> radii = cases::spaced(0.0, 10.0, 640);
  std::vector<double> heights;
  for (const double r : radii) heights.push_back(-2e-5 * r - 1e-7 * r * r);
  std::vector<Profile> profiles{cases::face("cone", 2.0, radii, heights)};
  profiles[0].free_tilt = true;
  const FittedModel fitted = fit_declared(
      cases::problem(Lever::paper, 4, {cases::effect("squareness"), cases::effect("cup")}),
      profiles);
  const RankingResult ranking = rank_effects(fitted.model, fitted.fit);
  EXPECT_EQ(ranking.entries[0].low_band, 0.0);
  EXPECT_EQ(ranking.entries[0].raw, 0.0);
  EXPECT_GT(std::abs(ranking.entries[1].low_band), 0.999);
}

TEST(Dominant, IsTheEffectWithTheLargestShare) {
  const ConeCase cone;
  const Dominant dominant = dominant_effects(cone.ranking, cone.lead, cone.summary.identifiability);
  EXPECT_EQ(dominant.by_correlation, "squareness");
  EXPECT_EQ(dominant.by_fit, "squareness");
  EXPECT_EQ(dominant.agree, true);
}

/// Two effects on one profile: coefficients and shares.
RankingResult ranked(std::array<double, 2> coefficients, double p_value = 0.01) {
  RankingResult ranking;
  const std::array<const char*, 2> names{"cup", "squareness"};
  for (std::size_t i = 0; i < 2; ++i) {
    ranking.entries.push_back({names[i], "a"});
    ranking.entries.back().low_band = coefficients[i];
    ranking.entries.back().p_value = p_value;
  }
  return ranking;
}

LeadByFit cup_leads(double share, double uncertainty) {
  return {"cup", "squareness", share, 1.0 - share, uncertainty};
}

TEST(Dominant, DisagreesWhereCorrelationAndFitNameTwo) {
  const Dominant dominant = dominant_effects(ranked({0.5, -0.9}), cup_leads(0.7, 0.1), {});
  EXPECT_EQ(dominant.by_correlation, "squareness");
  EXPECT_EQ(dominant.by_fit, "cup");
  EXPECT_EQ(dominant.agree, false);
  EXPECT_EQ(dominant.doubt, "");
}

TEST(Dominant, AddsTheSizesOfCoefficientsOfAllProfiles) {
  RankingResult ranking = ranked({0.5, 0.6});
  for (const Ranking& entry : ranked({-0.99, 0.6}).entries) ranking.entries.push_back(entry);
  ranking.entries[2].profile = ranking.entries[3].profile = "b";
  EXPECT_EQ(dominant_effects(ranking, {}, {}).by_correlation, "cup");  // 0.745 against 0.6
}

// A reading of the slide sees no squareness, so it cannot say which of the two leads.
TEST(Dominant, AsksNoProfileThatSeesOneEffectOnly) {
  RankingResult ranking = ranked({0.2, 0.6});
  ranking.entries.push_back({"cup", "slide"});
  ranking.entries.back().low_band = 1.0;
  ranking.entries.back().p_value = 0.0;
  EXPECT_EQ(dominant_effects(ranking, {}, {}).by_correlation, "squareness");
}

TEST(Dominant, IsNamedByFitWhereItLeadsByMoreThanItsUncertainty) {
  // Alike to three digits, and one share is larger by 0.10 ± 0.09.
  const Dominant named = dominant_effects(ranked({0.968, 0.967}), cup_leads(0.55, 0.09), {});
  EXPECT_EQ(named.by_fit, "cup");
  EXPECT_FALSE(named.by_correlation);
  EXPECT_FALSE(named.agree);
  EXPECT_EQ(named.doubt, "");
  const Dominant none = dominant_effects(ranked({0.968, 0.967}), cup_leads(0.55, 0.11), {});
  EXPECT_FALSE(none.by_fit);
  EXPECT_EQ(none.doubt,
            "no clear lead, by fit cup 55 % against squareness 45 %, uncertainty of the difference "
            "11 %");
}

TEST(Dominant, IsNoneWhereItsShareIsAConvention) {
  Identifiability untold;
  untold.unidentifiable.push_back({{{"cup.height", 0.7}, {"squareness.x", -0.7}}, ""});
  const Dominant dominant = dominant_effects(ranked({0.9, 0.5}), cup_leads(0.8, 0.01), untold);
  EXPECT_FALSE(dominant.by_fit);
  EXPECT_THAT(dominant.doubt, ::testing::HasSubstr("do not tell cup from squareness"));
  // An offset that the reference line takes is shared with nothing.
  untold.unidentifiable[0].combination = {{"cup.height", 1.0}};
  EXPECT_EQ(dominant_effects(ranked({0.9, 0.5}), cup_leads(0.8, 0.01), untold).agree, true);
}

TEST(Dominant, IsNoneByCorrelationWithoutASignificantOneOrARival) {
  EXPECT_FALSE(dominant_effects(ranked({0.9, 0.5}, 0.2), {}, {}).by_correlation);
  EXPECT_FALSE(dominant_effects({}, {}, {}).by_correlation);
  EXPECT_FALSE(dominant_effects({}, {}, {}).agree);
  RankingResult one = ranked({1.0, 0.0});
  one.entries.pop_back();
  EXPECT_FALSE(dominant_effects(one, {}, {}).by_correlation);
}

/// What is left of a cone and a cup of one size over a radius (Pearson's r 0.97), with noise that
/// tells them apart, and with noise that does not. One profile, level 0, Gaussian noise.
std::optional<LeadByFit> lead_of_cone(double cup_mm, double noise_mm) {
  const std::vector<double> radii = cases::spaced(0.0, 10.0, 400);
  std::vector<double> heights;
  RandomStream random(5, "lead");
  for (const double r : radii)
    heights.push_back(-2e-5 * r + cup_mm * r * r / 100.0 + noise_mm * random.normal());
  const std::vector<Profile> profiles{cases::face("face", 2.0, radii, heights)};
  const FittedModel fitted = fit_declared(
      cases::problem(Lever::paper, 0, {cases::effect("squareness"), cases::effect("cup")}),
      profiles);
  return lead_by_fit(fitted.model, fitted.fit);
}

// A cone of 200 nm and a cup of 100 nm: mean squares (1/12) 200² and (4/45) 100² give shares of
// 0.789 and 0.211.
TEST(LeadByFit, IsOfMeanSquaresWithAnUncertaintyThatGrowsWithTheNoise) {
  const double cone = 4.0 / 12.0, cup = 4.0 / 45.0;
  const auto clear = lead_of_cone(1e-4, 1e-6);
  ASSERT_TRUE(clear);
  EXPECT_EQ(clear->first, "squareness");
  EXPECT_NEAR(clear->share, cone / (cone + cup), 2.0 * clear->expanded_uncertainty);
  EXPECT_LT(clear->expanded_uncertainty, 0.05);
  const auto drowned = lead_of_cone(1.9e-4, 3e-4);  // noise three times the difference
  ASSERT_TRUE(drowned);
  EXPECT_GT(drowned->expanded_uncertainty, drowned->share - drowned->next);
}

}  // namespace
}  // namespace slideway
