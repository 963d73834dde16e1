#include "slideway/identify/ranking.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "base/temporary_folder.hpp"
#include "identify/cases.hpp"
#include "slideway/base/error.hpp"
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

TEST(Dominant, IsTheEffectWithTheLargestShare) {
  const ConeCase cone;
  const Dominant dominant = dominant_effects(cone.ranking, cone.summary);
  EXPECT_EQ(dominant.by_correlation, "squareness");
  EXPECT_EQ(dominant.by_fit, "squareness");
  EXPECT_EQ(dominant.agree, true);
}

TEST(Dominant, IsNoneWithoutEntriesAndDisagreesWhereTheTwoDo) {
  EXPECT_FALSE(dominant_effects({}, {}).by_correlation);
  EXPECT_FALSE(dominant_effects({}, {}).agree);
  RankingResult ranking;
  ranking.entries.resize(3);
  ranking.entries[0].effect = ranking.entries[1].effect = "cup";
  ranking.entries[0].low_band = 0.5;
  ranking.entries[1].low_band = -0.5;  // sizes add up: 1.0
  ranking.entries[2].effect = "squareness";
  ranking.entries[2].low_band = 0.9;
  for (Ranking& entry : ranking.entries) entry.profile = "a", entry.p_value = 0.01;
  ModelResult fit;
  fit.contributions = {{"cup", "a", 1.0, {}, 0.3}, {"squareness", "a", 2.0, {}, 0.7}};
  const Dominant dominant = dominant_effects(ranking, fit);
  EXPECT_EQ(dominant.by_correlation, "cup");
  EXPECT_EQ(dominant.by_fit, "squareness");
  EXPECT_EQ(dominant.agree, false);
  EXPECT_EQ(dominant.doubt, "");
}

/// Two effects on one profile: coefficients, shares, and what the data cannot tell apart.
Dominant dominant_of(std::array<double, 2> coefficients, std::array<double, 2> shares,
                     double p_value = 0.01, const Combination& untold = {}) {
  RankingResult ranking;
  ModelResult fit;
  const std::array<const char*, 2> names{"cup", "squareness"};
  for (std::size_t i = 0; i < 2; ++i) {
    ranking.entries.push_back({names[i], "a"});
    ranking.entries.back().low_band = coefficients[i];
    ranking.entries.back().p_value = p_value;
    fit.contributions.push_back({names[i], "a", 1.0, {}, shares[i]});
  }
  if (!untold.empty()) fit.identifiability.unidentifiable.push_back({untold, ""});
  return dominant_effects(ranking, fit);
}

TEST(Dominant, AgreesOnlyWithAClearLead) {
  EXPECT_EQ(dominant_of({0.9, 0.5}, {0.8, 0.2}).agree, true);
  const Dominant half = dominant_of({0.908, 0.909}, {0.497, 0.503});
  EXPECT_EQ(half.by_fit, "squareness");
  EXPECT_EQ(half.agree, false);
  EXPECT_EQ(half.doubt,
            "no clear lead, by correlation squareness 0.909 against cup 0.908, by fit squareness "
            "50 % against cup 50 %");
  EXPECT_EQ(dominant_of({0.9, 0.5}, {0.51, 0.49}).agree, false);
  EXPECT_EQ(dominant_of({0.9, 0.89}, {0.8, 0.2}).agree, false);
}

TEST(Dominant, IsDoubtedWhereItsShareIsAConvention) {
  const Dominant dominant =
      dominant_of({0.9, 0.5}, {0.8, 0.2}, 0.01, {{"cup.height", 0.7}, {"squareness.x", -0.7}});
  EXPECT_EQ(dominant.agree, false);
  EXPECT_THAT(dominant.doubt, ::testing::HasSubstr("do not tell cup from squareness"));
  // An offset that the reference line takes is shared with nothing.
  EXPECT_EQ(dominant_of({0.9, 0.5}, {0.8, 0.2}, 0.01, {{"cup.height", 1.0}}).agree, true);
}

TEST(Dominant, IsNoneWithoutASignificantCorrelationOrARival) {
  EXPECT_FALSE(dominant_of({0.9, 0.5}, {0.8, 0.2}, 0.2).by_correlation);
  EXPECT_FALSE(dominant_of({0.9, 0.5}, {0.8, 0.2}, 0.2).by_fit);
  RankingResult one;
  one.entries.push_back({"cup", "a"});
  one.entries.back().low_band = 1.0;
  one.entries.back().p_value = 0.0;
  ModelResult fit;
  fit.contributions = {{"cup", "a", 1.0, {}, 1.0}};
  EXPECT_FALSE(dominant_effects(one, fit).by_correlation);
}

}  // namespace
}  // namespace slideway
