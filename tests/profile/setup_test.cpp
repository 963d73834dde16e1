#include "slideway/profile/setup.hpp"

#include <gmock/gmock.h>

#include <array>
#include <string>
#include <tuple>
#include <vector>

namespace slideway {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr IndependentVariable kVariables[] = {
    IndependentVariable::radius,         IndependentVariable::slide,
    IndependentVariable::time,           IndependentVariable::revolution,
    IndependentVariable::distance,       IndependentVariable::trace,
    IndependentVariable::measuring_time, IndependentVariable::reading_time};

// The paper's face: radius 10 mm at 110 rpm.
Setup face(double feed, CutDirection direction) {
  Setup setup;
  setup.feed_mm_per_min = feed;
  setup.spindle_rpm = 110.0;
  setup.cut_direction = direction;
  setup.cut_radius_mm = 10.0;
  setup.traverse_mm_per_s = 0.5;
  setup.last_mm = 10.0;
  setup.reading_times =
      std::make_shared<const ReadingTimes>(ReadingTimes{{0.0, 4.0, 10.0}, {70.0, 30.0, 36.0}});
  return setup;
}

class Variables : public testing::Test {
 protected:
  Machine machine_{Machine::paper_lathe(), Lever::paper};
  std::vector<double> positions_{0.0, 6.0, 10.0};
};

TEST(IndependentVariable, HasTheSymbolOfTheFormulas) {
  std::vector<std::string> symbols;
  for (const IndependentVariable variable : kVariables) symbols.emplace_back(symbol(variable));
  EXPECT_THAT(symbols, ElementsAre("r", "x", "t", "k", "s", "X", "m", "t_read"));
}

TEST_F(Variables, WholeCutTakesTheTimeTurnsAndPathOfTheFeed) {
  // Time R / feed, turns R / f, path pi R^2 / f with f = feed / rpm: 300 s, 550 turns, 17.28 m at
  // 2 mm/min; 75 s, 137.5 turns, 4.32 m at 8 mm/min. 5 mm: the path is rounded to 10 mm.
  for (const auto& [feed, time, turns, path] :
       {std::array{2.0, 300.0, 550.0, 17280.0}, std::array{8.0, 75.0, 137.5, 4320.0}}) {
    const auto outward = face(feed, CutDirection::outward);
    const auto inward = face(feed, CutDirection::inward);
    const Stations out(positions_, outward, machine_);
    const Stations in(positions_, inward, machine_);
    for (const auto& [stations, start, end] : {std::tuple{&out, 0, 2}, std::tuple{&in, 2, 0}}) {
      EXPECT_EQ(stations->time(start), 0.0);
      EXPECT_EQ(stations->distance(start), 0.0);
      EXPECT_DOUBLE_EQ(stations->time(end), time);
      EXPECT_DOUBLE_EQ(stations->revolution(end), turns);
      EXPECT_NEAR(stations->distance(end), path, 5.0);
    }
  }
}

TEST_F(Variables, InwardAndOutwardPathsAddUpToTheWholeFace) {
  const auto outward = face(2.0, CutDirection::outward);
  const auto inward = face(2.0, CutDirection::inward);
  const Stations out(positions_, outward, machine_);
  const Stations in(positions_, inward, machine_);
  EXPECT_DOUBLE_EQ(out.distance(1) + in.distance(1), out.distance(2));
  EXPECT_DOUBLE_EQ(out.distance(1) / out.distance(2), 0.36);  // (6 / 10)^2
}

TEST_F(Variables, FaceTakesBothSidesOfADiameterAlike) {
  auto setup = face(2.0, CutDirection::inward);
  setup.center_mm = 8.0;
  setup.spindle_position_mm = 100.0;
  setup.start_s = 20.0;
  const Stations stations(positions_, setup, machine_);
  EXPECT_EQ(stations.trace(1), -2.0);
  EXPECT_EQ(stations.trace(2), 2.0);
  EXPECT_EQ(stations.radius(1), stations.radius(2));
  EXPECT_EQ(stations.slide(1), 102.0);
  EXPECT_EQ(stations.time(1), stations.time(2));
  EXPECT_DOUBLE_EQ(stations.time(0), 20.0 + 60.0);  // 2 mm at 2 mm/min after the start
  EXPECT_EQ(stations.measuring_time(2), 20.0);
}

TEST_F(Variables, ReadingTimeIsThatOfTheStationAndStraightBetweenStations) {
  const auto setup = face(2.0, CutDirection::inward);
  const std::vector<double> positions{-1.0, 0.0, 1.0, 4.0, 7.0, 10.0, 11.0};
  const Stations stations(positions, setup, machine_);
  std::vector<double> times;
  for (Eigen::Index i = 0; i < stations.size(); ++i) times.push_back(stations.reading_time(i));
  EXPECT_THAT(times, ElementsAre(70.0, 70.0, 60.0, 30.0, 33.0, 36.0, 36.0));
}

TEST_F(Variables, SlideReadingRunsFromEitherEnd) {
  auto setup = face(30.0, CutDirection::outward);
  setup.kind = Kind::slide;
  const Stations stations(positions_, setup, machine_);
  EXPECT_DOUBLE_EQ(stations.time(1), 12.0);
  EXPECT_EQ(stations.slide(1), 6.0);
  setup.cut_direction = CutDirection::inward;
  EXPECT_DOUBLE_EQ(stations.time(1), 8.0);
}

TEST(MissingFor, NamesTheKeysThatWouldMakeAVariableKnown) {
  const slideway::Setup bare;
  EXPECT_THAT(missing_for(IndependentVariable::radius, bare), IsEmpty());
  EXPECT_THAT(missing_for(IndependentVariable::slide, bare), IsEmpty());
  EXPECT_THAT(missing_for(IndependentVariable::trace, bare), IsEmpty());
  EXPECT_THAT(missing_for(IndependentVariable::time, bare),
              ElementsAre("feed_mm_per_min", "cut_direction"));
  EXPECT_THAT(missing_for(IndependentVariable::revolution, bare),
              ElementsAre("feed_mm_per_min", "cut_direction", "spindle_rpm"));
  EXPECT_THAT(missing_for(IndependentVariable::distance, bare),
              ElementsAre("feed_mm_per_min", "cut_direction", "spindle_rpm"));
  EXPECT_THAT(missing_for(IndependentVariable::measuring_time, bare),
              ElementsAre("traverse_mm_per_s"));
  EXPECT_THAT(missing_for(IndependentVariable::reading_time, bare), ElementsAre("time_column"));
}

TEST(MissingFor, FindsNothingInACompleteSetup) {
  const auto setup = face(2.0, CutDirection::inward);
  for (const IndependentVariable variable : kVariables)
    EXPECT_THAT(missing_for(variable, setup), IsEmpty());
}

TEST(MissingFor, AsksForAFaceWhereOnlyAFaceHasTheVariable) {
  auto setup = face(2.0, CutDirection::inward);
  setup.kind = Kind::slide;
  EXPECT_THAT(missing_for(IndependentVariable::radius, setup), ElementsAre("kind = \"face\""));
  EXPECT_THAT(missing_for(IndependentVariable::distance, setup), ElementsAre("kind = \"face\""));
  EXPECT_THAT(missing_for(IndependentVariable::revolution, setup), IsEmpty());
}

}  // namespace
}  // namespace slideway
