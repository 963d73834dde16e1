#include "slideway/identify/pooling.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "slideway/identify/identify.hpp"
#include "trace/faces.hpp"

namespace slideway {
namespace {

const std::string kSquarenessName = "squareness.dbeta_xz";

/// An item that knows one parameter: value and standard uncertainty.
PoolItem reading(const std::string& id, double value, double u) {
  return {id, {}, {{kSquarenessName}, {"rad"}, {{1.0 / u}}, {value / u}}};
}

const FittedParameter& parameter(const PooledMachine& machine, const std::string& name) {
  for (const FittedParameter& p : machine.parameters)
    if (p.name == name) return p;
  throw std::out_of_range(name);
}

// Closed form: weights 1/u².
TEST(Pool, OfReadingsIsTheirWeightedMean) {
  const PooledMachine pooled =
      pool("M", {reading("a", 10.0, 1.0), reading("b", 11.0, 2.0), reading("c", 9.0, 2.0)});
  EXPECT_NEAR(parameter(pooled, kSquarenessName).value.value(), (10.0 + 11.0 / 4 + 9.0 / 4) / 1.5,
              1e-12);
  EXPECT_NEAR(parameter(pooled, kSquarenessName).standard_uncertainty.value(), std::sqrt(1.0 / 1.5),
              1e-12);
}

// ISO 13528: E_n = |x - rest| / sqrt(U² + U_rest²), U = 2 u.
TEST(Pool, EnIsThatOfTheDifferenceFromTheRest) {
  const PooledMachine pooled =
      pool("M", {reading("a", 10.0, 1.0), reading("b", 11.0, 2.0), reading("c", 9.0, 2.0)});
  EXPECT_NEAR(*pooled.items[0].En, 0.0, 1e-12);
  const double rest = (10.0 + 9.0 / 4) / 1.25, u = std::sqrt(4.0 + 1.0 / 1.25);
  EXPECT_NEAR(*pooled.items[1].En, std::abs(11.0 - rest) / (2.0 * u), 1e-12);
  EXPECT_NEAR(*pooled.items[1].p_value, std::erfc(std::abs(11.0 - rest) / u / std::sqrt(2.0)),
              1e-12);
}

TEST(Pool, DeterminesTogetherWhatNoItemDoesAlone) {
  const std::vector<std::string> names{kSquarenessName, "vertical_straightness.c2", "thermal.a"},
      units{"rad", "mm^-1", "um"};
  // Sum and difference of the two; what is the item's own is free in each.
  const PoolItem sum{"sum", {}, {names, units, {{1.0, 1.0, 0.5}, {0.0, 0.0, 2.0}}, {8.0, 2.0}}};
  const PoolItem difference{
      "difference", {}, {names, units, {{1.0, -1.0, 3.0}, {0.0, 0.0, 1.0}}, {5.0, 1.0}}};
  EXPECT_FALSE(parameter(pool("M", {sum}), kSquarenessName).identifiable);
  const PooledMachine pooled = pool("M", {sum, difference});
  // 1.0 is the item's own of both: a + b = 7.5, a - b = 2.
  EXPECT_NEAR(parameter(pooled, kSquarenessName).value.value(), 4.75, 1e-12);
  EXPECT_NEAR(parameter(pooled, names[1]).value.value(), 2.75, 1e-12);
  EXPECT_EQ(pooled.parameters.size(), 2U);
  EXPECT_FALSE(pooled.items[0].En) << "the other says nothing of what this one says";
}

TEST(Pool, TwoThatDifferAreBothKept) {
  const PooledMachine pooled = pool("M", {reading("a", 10.0, 1.0), reading("b", 30.0, 1.0)});
  EXPECT_TRUE(pooled.items[0].fits && pooled.items[1].fits);
  EXPECT_NEAR(*pooled.items[0].En, 20.0 / (2.0 * std::sqrt(2.0)), 1e-12);
}

TEST(Pool, OneAmongThreeIsFlaggedAndLeftOut) {
  const PooledMachine pooled =
      pool("M", {reading("a", 10.0, 1.0), reading("b", 30.0, 1.0), reading("c", 10.5, 1.0)});
  EXPECT_TRUE(pooled.items[0].fits);
  EXPECT_FALSE(pooled.items[1].fits);
  EXPECT_TRUE(pooled.items[2].fits);
  EXPECT_NEAR(parameter(pooled, kSquarenessName).value.value(), 10.25, 1e-12);
  EXPECT_LT(*pooled.items[0].En, 1.0) << "held against what is left";
}

TEST(Pool, MoreScatterThanUncertaintyWidensEveryUncertainty) {
  RandomStream random(3, "pool");
  std::vector<PoolItem> items;
  for (int i = 0; i < 60; ++i)
    items.push_back(reading(std::to_string(i), 5.0 * random.normal(), 1.0));
  const PooledMachine pooled = pool("M", items);
  // The standard error of a scatter from the median of 60 is 15 %: three of them.
  EXPECT_NEAR(pooled.scatter, 5.0, 2.3);
  for (const PooledItem& item : pooled.items) EXPECT_TRUE(item.fits) << item.id;
  EXPECT_NEAR(parameter(pooled, kSquarenessName).standard_uncertainty.value(),
              pooled.scatter / std::sqrt(60.0), 1e-9);
}

TEST(Pool, ItemsOfAnotherModelAreLeftOut) {
  PoolItem other = reading("b", 10.0, 1.0);
  other.evidence.parameters = {"straightness.b2"};
  const PooledMachine pooled = pool("M", {reading("a", 10.0, 1.0), other});
  EXPECT_THAT(pooled.left_out, testing::ElementsAre("b"));
}

/// An item made by the process: two cuts of a face, with this much squareness beyond the usual.
PoolItem face_item(std::uint64_t seed, double more_squareness, bool with_prior = false) {
  const turning::Hidden hidden{"squareness",
                               [=](const turning::ToolPoint& p) { return -more_squareness * p.r; }};
  const std::vector<Profile> profiles = faces::quarter_faces(hidden, 2, faces::kBlunt, seed);
  Problem problem = faces::problem_of();
  if (with_prior) problem.effects[0].priors = {{kSquarenessName.substr(11), 1e-3, 1e-7}};
  PoolItem item{std::to_string(seed), {}, {}};
  const FittedModel declared = fit_declared(problem, profiles);
  item.evidence = evidence(declared.model, declared.fit);
  return item;
}

TEST(PooledFaces, GiveTheMachineItsTruth) {
  std::vector<PoolItem> items;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) items.push_back(face_item(seed, 0.0));
  const PooledMachine pooled = pool("M", items);
  const PooledMachine alone = pool("M", {items[0]});
  const FittedParameter& squareness = parameter(pooled, kSquarenessName);
  const double u = squareness.standard_uncertainty.value();
  // Of the truth three standard uncertainties; of eight like readings 1/sqrt(8), by half again.
  EXPECT_NEAR(squareness.value.value(), turning::kFaceSquareness, 3.0 * u);
  EXPECT_NEAR(u / parameter(alone, kSquarenessName).standard_uncertainty.value(),
              std::sqrt(1.0 / 8.0), 0.18);
  for (const PooledItem& item : pooled.items) EXPECT_TRUE(item.fits) << item.id;
}

TEST(PooledFaces, AreAJointFitOfAllProfiles) {
  std::vector<PoolItem> items;
  std::vector<Profile> all;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    items.push_back(face_item(seed, 0.0));
    for (Profile& profile : faces::quarter_faces({"none"}, 2, faces::kBlunt, seed)) {
      profile.name += "of" + std::to_string(seed);
      all.push_back(std::move(profile));
    }
  }
  const PooledMachine pooled = pool("M", items);
  const Result joint = identify(faces::problem_of(), all, Scope::fit);
  for (const FittedParameter& p : pooled.parameters) {
    const FittedParameter* const q = joint.final->find(p.name);
    ASSERT_EQ(p.identifiable, q->identifiable) << p.name;
    if (!p.identifiable) continue;
    // The noise of each profile is estimated anew in the joint fit: weights differ a little.
    EXPECT_NEAR(*p.value, *q->value, 0.5 * *q->standard_uncertainty) << p.name;
    EXPECT_NEAR(*p.standard_uncertainty / *q->standard_uncertainty, 1.0, 0.25) << p.name;
  }
}

TEST(PooledFaces, ANewToolPostIsFlaggedAmongTheOthers) {
  std::vector<PoolItem> items;
  for (std::uint64_t seed = 1; seed <= 7; ++seed)
    items.push_back(face_item(seed, seed == 4 ? 3e-6 : 0.0));
  const PooledMachine pooled = pool("M", items);
  for (const PooledItem& item : pooled.items) {
    EXPECT_EQ(item.fits, item.id != "4") << item.id;
    if (item.id == "4") {
      EXPECT_GT(*item.En, 1.0);
    }
  }
}

TEST(PooledFaces, ShowTheTrend) {
  constexpr double kRate = 3e-7;  // rad a day; over all eight ten times what one face knows
  std::vector<PoolItem> items;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const double day = 10.0 * static_cast<double>(seed);
    items.push_back(face_item(seed, kRate * day));
    items.back().time = 20000.0 + day;
  }
  const PooledMachine pooled = pool("M", items);
  for (const PooledItem& item : pooled.items) EXPECT_TRUE(item.fits) << item.id;
  for (const Trend& trend : pooled.trends)
    if (trend.parameter == kSquarenessName) {
      EXPECT_NEAR(trend.rate, kRate, 1.5 * trend.expanded_uncertainty);
      EXPECT_LT(trend.p_value, 0.01);
      return;
    }
  ADD_FAILURE() << "no trend of the squareness";
}

// A prior is one piece of knowledge, however many items hold it.
TEST(PooledFaces, TakeNoPriorIn) {
  const PoolItem without = face_item(1, 0.0), with = face_item(1, 0.0, true);
  const PooledMachine a = pool("M", {without}), b = pool("M", {with});
  // The prior is wrong by 500 times the face's own uncertainty, and is in the residual that the
  // noise is estimated from; the value is not moved.
  const double u = parameter(b, kSquarenessName).standard_uncertainty.value();
  EXPECT_NEAR(parameter(a, kSquarenessName).value.value(),
              parameter(b, kSquarenessName).value.value(), u);
}

}  // namespace
}  // namespace slideway
