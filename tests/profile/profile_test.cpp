#include "slideway/profile/profile.hpp"

#include <gmock/gmock.h>

#include <string>

#include "base/temporary_folder.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/file.hpp"
#include "slideway/base/text.hpp"

namespace slideway {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;
using testing::ThrowsMessage;

class ReadProfile : public testing::Test {
 protected:
  ReadProfile() {
    source_.position_unit = "mm";
    source_.value_unit = "um";
  }

  // Reads text as columns 1 and 2 of a file.
  const Profile& read(const std::string& text) {
    source_.path = folder_.file("face.csv", text);
    profile_.name = "face";
    read_profile(source_, profile_);
    return profile_;
  }
  std::string file() { return (folder_.path() / "face.csv").string(); }

  TemporaryFolder folder_;
  ProfileSource source_;
  Profile profile_;
};

TEST_F(ReadProfile, ConvertsToMillimetresAndCompletesTheSetup) {
  profile_.setup.center_mm = 4.0;
  const std::string text = "x_mm,z_um\n0,1\n2,-0.3\n10,2\n";
  read(text);
  EXPECT_THAT(profile_.positions, ElementsAre(0.0, 2.0, 10.0));
  EXPECT_THAT(profile_.values, ElementsAre(0.001, -0.0003, 0.002));
  EXPECT_EQ(profile_.sha256, sha256(text));
  EXPECT_EQ(profile_.setup.first_mm, 0.0);
  EXPECT_EQ(profile_.setup.last_mm, 10.0);
  EXPECT_EQ(profile_.setup.cut_radius_mm, 6.0);
  EXPECT_EQ(profile_.format, "text");
  EXPECT_THAT(profile_.notes,
              ElementsAre("text: commas between columns, decimal point, 1 header line"));
}

TEST_F(ReadProfile, SeesTheResolutionOfTheReadings) {
  const auto resolution = [&](const std::string& values) {
    std::string text = "x,z\n";
    for (std::size_t at = 0, x = 0; at < values.size(); ++x) {
      const std::size_t end = std::min(values.find(' ', at), values.size());
      text += std::to_string(x) + ',' + values.substr(at, end - at) + '\n';
      at = end + 1;
    }
    return read(text).resolution;
  };
  EXPECT_DOUBLE_EQ(resolution("-276 -271 -265 -258"), 1e-3);
  EXPECT_NEAR(resolution("0.1 0.3 0.7 0.2"), 1e-4, 1e-15);
  EXPECT_NEAR(resolution("10.2 10.7 11.2 9.7"), 5e-4, 1e-15);  // steps of half a micrometre
  EXPECT_EQ(resolution("0.123456789012 1.987654321098 3.1415926535897"), 0.0);
  EXPECT_EQ(resolution("2 2 2"), 0.0);
  // Steps of 0.01 µm restated in inches, as far as a double goes; 1e-6: a step in 1e5 of
  // them, each with sixteen digits.
  const std::vector<int> steps{-31207, 15, 88210, -9};
  std::string inches;
  for (const int each : steps) inches += (inches.empty() ? "" : " ") + shortest(each / 2540.0);
  EXPECT_NEAR(resolution(inches), 1e-3 / 2540.0, 1e-6 * 1e-3 / 2540.0);
}

TEST_F(ReadProfile, LeavesOutWhatIsMasked) {
  source_.mask = {{1.5, 3.0}, {9.0, 20.0}};
  read("x_mm,z_um\n0,1\n1,2\n2,3\n3,4\n4,5\n9.5,6\n");
  EXPECT_THAT(profile_.positions, ElementsAre(0.0, 1.0, 4.0));
  EXPECT_EQ(profile_.left_out, 3U);
  EXPECT_EQ(profile_.missing, 0U);
  EXPECT_THAT(profile_.notes, Contains("3 samples left out by the problem's mask"));
}

class TimedProfile : public ReadProfile {
 protected:
  TimedProfile() {
    source_.request.time_column = "t_min";
    source_.time_unit = "min";
  }
  [[nodiscard]] const ReadingTimes& times() const { return *profile_.setup.reading_times; }
};

TEST_F(TimedProfile, KeepsTheTimeOfEachStationInSeconds) {
  read("x_mm,z_um,t_min\n0,1,2.5\n2,3,1\n10,2,1\n");
  EXPECT_THAT(times().positions_mm, ElementsAre(0.0, 2.0, 10.0));
  EXPECT_THAT(times().times_s, ElementsAre(150.0, 60.0, 60.0));
}

// Out of six rows one is outside the window, one masked, one without a value, one left out.
TEST_F(TimedProfile, LetsATimeFollowItsRow) {
  source_.window = {0.0, 20.0};
  source_.mask = {{9.5, 10.5}};
  source_.left_out_rows = {4};
  read("x_mm,z_um,t_min\n30,9,\n12,1,1\n10,1,2\n8,1,3\n6,,4\n4,1,5\n2,1,7\n");
  EXPECT_THAT(profile_.positions, ElementsAre(2.0, 4.0, 12.0));
  EXPECT_THAT(times().positions_mm, ElementsAre(2.0, 4.0, 12.0));
  EXPECT_THAT(times().times_s, ElementsAre(420.0, 300.0, 60.0));
}

TEST_F(TimedProfile, MeansTimesLikePositions) {
  source_.most_samples = 4;
  read("x_mm,z_um,t_min\n0,0,0\n1,0,1\n2,0,4\n3,0,6\n4,0,7\n5,0,8\n6,0,9\n7,0,20\n");
  EXPECT_THAT(profile_.positions, ElementsAre(0.5, 2.5, 4.5, 6.5));
  EXPECT_THAT(times().times_s, ElementsAre(30.0, 300.0, 450.0, 870.0));
}

TEST_F(TimedProfile, RefusesAStationWithoutATimeAndAnotherUnit) {
  EXPECT_THAT([&] { read("x_mm,z_um,t_min\n0,1,0\n2,3,\n"); },
              ThrowsMessage<DataError>(
                  StartsWith(file() + ": data row 2: no reading time; accepted: a finite number")));
  EXPECT_THAT([&] { read("x_mm,z_um,t_min\n0,1,0\n2,3,inf\n"); },
              ThrowsMessage<DataError>(HasSubstr("column 't_min'")));
  EXPECT_THAT([&] { read("x_mm,z_um\n0,1\n2,3\n"); },
              ThrowsMessage<DataError>(HasSubstr("'t_min'")));
  source_.request.time_column = "t_s";
  EXPECT_THAT([&] { read("x_mm,z_um,t_s\n0,1,0\n2,3,1\n"); },
              ThrowsMessage<DataError>(
                  HasSubstr("the header has the unit s, the problem time_unit = \"min\"")));
}

TEST_F(ReadProfile, MasksInTheUnitOfTheProblem) {
  source_.position_unit = "um";
  source_.mask = {{1500.0, 2500.0}};
  read("x_um,z_um\n0,1\n1000,2\n2000,3\n3000,4\n");
  EXPECT_THAT(profile_.positions, ElementsAre(0.0, 1.0, 3.0));
}

TEST_F(ReadProfile, GivesTheSamePositionsFromMillimetresAndMicrometres) {
  // mm text is rounded once, um text is rounded and then divided: within 1 ulp of one another.
  std::string in_mm, in_um;
  for (int i = 0; i < 2000; ++i) {
    const std::string half = std::to_string(i * 5);  // 0.5 um steps, in tenths of a micrometre
    in_um += half + "e-1,0\n";
    in_mm += half + "e-4,0\n";
  }
  const std::vector<double> mm = read(in_mm).positions;
  source_.position_unit = "um";
  const std::vector<double> um = read(in_um).positions;
  ASSERT_EQ(mm.size(), um.size());
  for (std::size_t i = 0; i < mm.size(); ++i)
    EXPECT_LE(std::abs(mm[i] - um[i]), std::nextafter(mm[i], 11.0) - mm[i]);
}

TEST_F(ReadProfile, TurnsTimeIntoPositionByTheFeed) {
  source_.position_unit = "s";
  EXPECT_THAT([&] { read("0,0\n30,1\n"); },
              ThrowsMessage<UsageError>(
                  StartsWith(file() + ": profile 'face': positions in time need feed")));
  profile_.setup.feed_mm_per_min = 2.0;
  EXPECT_THAT(read("0,0\n30,1\n").positions, ElementsAre(0.0, 1.0));
}

TEST_F(ReadProfile, KeepsTheWindowWithItsEnds) {
  source_.window = {1.0, 3.0};
  EXPECT_THAT(read("0,0\n1,1\n2,2\n3,3\n4,4\n").positions, ElementsAre(1.0, 2.0, 3.0));
  EXPECT_EQ(profile_.setup.cut_radius_mm, 3.0);
}

TEST_F(ReadProfile, ReversesATraceThatRunsBackwards) {
  read("3,30\n2,20\n-1,10\n");
  EXPECT_THAT(profile_.positions, ElementsAre(-1.0, 2.0, 3.0));
  EXPECT_THAT(profile_.values, ElementsAre(0.010, 0.020, 0.030));
  EXPECT_EQ(profile_.notes.back(), "trace runs backwards in the file: reversed");
}

TEST_F(ReadProfile, LeavesOutMissingPointsAndCountsThoseInTheWindow) {
  source_.window = {1.0, 4.0};
  read("0,\n1,1\n2,nan\n3,3\n4,4\n");
  EXPECT_THAT(profile_.positions, ElementsAre(1.0, 3.0, 4.0));
  EXPECT_THAT(profile_.values, ElementsAre(0.001, 0.003, 0.004));
  EXPECT_EQ(profile_.missing, 1U);
  EXPECT_EQ(profile_.notes.back(), "1 missing point left out");
}

// Positions i and values 10 i for i = 0, 1, ...
std::string ramp(int rows) {
  std::string text;
  for (int i = 0; i < rows; ++i) text += std::to_string(i) + "," + std::to_string(10 * i) + "\n";
  return text;
}

TEST_F(ReadProfile, KeepsMeansWhereThereAreTooManySamples) {
  source_.most_samples = 8;
  source_.value_unit = "mm";
  profile_.standard_uncertainty = 6.0;
  EXPECT_EQ(read(ramp(8)).positions.size(), 8U);
  EXPECT_EQ(profile_.standard_uncertainty, 6.0);
  profile_ = {.standard_uncertainty = 6.0};
  read(ramp(23));  // 9 make means of 2, 17 of 4; the last three are no whole one
  EXPECT_THAT(profile_.positions, ElementsAre(1.5, 5.5, 9.5, 13.5, 17.5));
  EXPECT_THAT(profile_.values, ElementsAre(15.0, 55.0, 95.0, 135.0, 175.0));
  EXPECT_EQ(profile_.standard_uncertainty, 3.0);  // of white noise
  EXPECT_THAT(profile_.notes, Contains("23 samples, more than 8: kept as means of 4 each"));
}

TEST_F(ReadProfile, MeansAreOfTheSamplesThatAreKept) {
  source_.most_samples = 8;
  source_.window = {2.0, 40.0};
  source_.left_out_rows = {5};
  const std::string text = "-1,0\n" + ramp(12);  // data row 5 is i = 3
  EXPECT_THAT(read(text).positions, ElementsAre(3.0, 5.5, 7.5, 9.5));
}

TEST_F(ReadProfile, NamesTheFirstRowOfAMeanThatNeighboursContradict) {
  source_.most_samples = 64;
  std::string text, backwards;
  for (int i = 0; i < 80; ++i) {
    const std::string row =
        std::to_string(i) + "," + std::to_string(i == 54 ? 90000 : i * 37 % 101) + "\n";
    text += row;
    backwards = row + backwards;
  }
  ASSERT_EQ(read(text).outliers.size(), 1U);
  EXPECT_EQ(profile_.outliers[0].row, 55U);
  profile_ = {};
  ASSERT_EQ(read(backwards).outliers.size(), 1U);
  EXPECT_EQ(profile_.outliers[0].row, 25U);  // rows 25 and 26 are i = 55 and 54
}

// A straight line with a bad value in data row 6, the missing one of row 3 and the window before
// it.
std::string line_with_a_spike() {
  std::string text = "x,z\n-1,77\n";
  for (int i = 0; i < 30; ++i)
    text += std::to_string(i) + "," + (i == 1 ? "" : std::to_string(i == 4 ? 5000 : i * 37 % 101)) +
            "\n";
  return text;
}

TEST_F(ReadProfile, ListsOutliersByTheirDataRowAndKeepsThem) {
  source_.window = {0.0, 40.0};
  read(line_with_a_spike());
  ASSERT_EQ(profile_.outliers.size(), 1U);
  EXPECT_EQ(profile_.outliers[0].row, 6U);
  EXPECT_DOUBLE_EQ(profile_.outliers[0].value, 5.0);
  EXPECT_EQ(profile_.values.size(), 29U);
  EXPECT_EQ(profile_.left_out, 0U);
  EXPECT_THAT(profile_.notes,
              Contains(StartsWith(
                  "1 sample that neighbours contradict, kept: data row 6, 5000 \u00b5m where ")));
}

TEST_F(ReadProfile, ListsTheSameRowOfATraceThatRunsBackwards) {
  std::string text;
  for (int i = 0; i < 30; ++i)
    text += std::to_string(30 - i) + "," + std::to_string(i == 4 ? 5000 : i * 37 % 101) + "\n";
  read(text);
  ASSERT_EQ(profile_.outliers.size(), 1U);
  EXPECT_EQ(profile_.outliers[0].row, 5U);
}

TEST_F(ReadProfile, LeavesOutSpikesAndRowsWhereItIsAsked) {
  source_.window = {0.0, 40.0};
  source_.leave_out_spikes = true;
  read(line_with_a_spike());
  EXPECT_EQ(profile_.left_out, 1U);
  EXPECT_EQ(profile_.outliers.size(), 1U);
  EXPECT_EQ(profile_.values.size(), 28U);
  EXPECT_EQ(profile_.positions.size(), 28U);
  EXPECT_THAT(profile_.notes, Contains(HasSubstr("contradict, left out: data row 6")));

  profile_ = {};
  source_.leave_out_spikes = false;
  source_.left_out_rows = {6, 1, 7, 3, 6};  // 1 is outside the window, 3 is missing anyway
  read(line_with_a_spike());
  EXPECT_EQ(profile_.left_out, 2U);
  EXPECT_EQ(profile_.missing, 1U);
  EXPECT_EQ(profile_.values.size(), 27U);
  EXPECT_TRUE(profile_.outliers.empty());
  EXPECT_EQ(profile_.notes.back(), "2 samples left out by the problem's leave_out");
}

TEST_F(ReadProfile, RefusesToLeaveOutARowThatIsNotThere) {
  source_.left_out_rows = {4};
  EXPECT_THAT([&] { read("0,0\n1,0\n2,0\n"); },
              ThrowsMessage<UsageError>(
                  "profile 'face': leave_out: data row 4 is not there; accepted: 1 to 3"));
}

TEST_F(ReadProfile, HoldsTheUnitOfTheHeaderAgainstTheSource) {
  EXPECT_NO_THROW(read("x_mm,Height [\u00b5m]\n0,1\n1,2\n"));
  EXPECT_THAT(
      [&] { read("x_mm,z_nm\n0,1\n1,2\n"); },
      ThrowsMessage<DataError>(file() + ": the header has the unit nm, the problem value_unit = "
                                        "\"um\"; accepted: the same"));
  EXPECT_THAT([&] { read("x [in],z_um\n0,1\n1,2\n"); },
              ThrowsMessage<DataError>(HasSubstr("unit inch, the problem position_unit = \"mm\"")));
  profile_.setup.quantity = Quantity::slope;
  source_.value_unit = "urad";
  EXPECT_THAT([&] { read("x_mm,z_um\n0,1\n1,2\n"); },
              ThrowsMessage<DataError>(HasSubstr("unit um, the problem value_unit = \"urad\"")));
}

TEST_F(ReadProfile, TakesTheUnitThatAHeaderStatesAndGuessesNone) {
  source_.value_unit.clear();
  EXPECT_THAT([&] { read("x_mm,z\n0,1\n1,2\n"); },
              ThrowsMessage<UsageError>(HasSubstr("value_unit is missing")));
  read("x_mm,z_nm\n0,1\n1,2\n");
  EXPECT_DOUBLE_EQ(profile_.values[1], 2e-6);  // mm
}

TEST_F(ReadProfile, SaysWhichSizesLookLikeBlunders) {
  profile_.setup.feed_mm_per_min = 20000.0;
  profile_.setup.spindle_rpm = 110000.0;
  read("0,0\n1,1500\n");
  ASSERT_EQ(profile_.doubts.size(), 3U);
  EXPECT_EQ(profile_.doubts[0], "heights range over 1.5 mm, more than 1 mm: is value_unit right?");
  EXPECT_EQ(profile_.doubts[1],
            "feed_mm_per_min = 20000, but lathes feed at 0.01 to 10000 mm/min: is it right?");
  EXPECT_EQ(profile_.doubts[2],
            "spindle_rpm = 110000, but spindles turn at 0.1 to 100000 rev/min: is it right?");
}

// 100 mm at 0.02 mm/min are 5000 min: a feed in metres a minute.
TEST_F(ReadProfile, SaysThatACutTakesDays) {
  profile_.setup.feed_mm_per_min = 0.02;
  read("0,0\n100,1\n");
  EXPECT_THAT(profile_.doubts,
              Contains("feed_mm_per_min = 0.02 makes a cut of 83 h: is it in mm/min?"));
}

TEST_F(ReadProfile, SaysThatTheSpindleAxisIsFarAway) {
  profile_.setup.center_mm = -30.0;
  read("0,0\n10,1\n");
  EXPECT_THAT(profile_.doubts, Contains("the spindle axis lies 30 mm outside a trace of 10 mm: a "
                                        "ring, or is center_mm wrong?"));
  profile_.setup.center_mm = 0.0;
  profile_.doubts.clear();
  read("0,0\n10,1\n");
  EXPECT_THAT(profile_.doubts, IsEmpty());
}

TEST_F(ReadProfile, SaysThatTheFaceIsFartherAlongTheSlideThanAnyLatheReaches) {
  const std::string note = " but lathes travel 30 m at most: is it right?";
  for (const double side : {-1.0, 1.0}) {
    profile_.doubts.clear();
    profile_.setup.spindle_position_mm = side * 1e6;
    read("0,0\n100,1\n");
    EXPECT_THAT(profile_.doubts,
                Contains(AllOf(HasSubstr("spindle_position_mm = "), HasSubstr(note))));
  }
  profile_.doubts.clear();
  profile_.setup.spindle_position_mm = 600.0;
  read("0,0\n100,1\n");
  EXPECT_THAT(profile_.doubts, IsEmpty());
}

// The centre of a face of 100 mm at 1e6 mm.
TEST_F(ReadProfile, SaysThatACentreIsFartherAwayThanAnyLatheTurns) {
  for (const double side : {-1.0, 1.0}) {
    profile_.doubts.clear();
    profile_.setup.center_mm = side * 1e6;
    read("0,0\n100,1\n");
    EXPECT_THAT(profile_.doubts, Contains(HasSubstr("outside a trace of 100 mm")));
    EXPECT_THAT(profile_.doubts, Contains(HasSubstr("more than any lathe turns")));
  }
}

TEST_F(ReadProfile, RefusesPositionsThatDifferInTheirLastDigitsOnly) {
  profile_.setup.kind = Kind::slide;
  EXPECT_THAT(
      [&] { read("100000000,0\n100000001,1\n"); },
      ThrowsMessage<DataError>(file() + ": positions lie 1e+08 mm away from 0 over a length "
                                        "of 1 mm; accepted: up to a million times their "
                                        "length"));
}

// At 1e18 mm both ends of the trace have one radius; at a million lengths ten digits are left.
TEST_F(ReadProfile, RefusesACentreThatLeavesNoRadius) {
  profile_.setup.center_mm = 1e18;
  EXPECT_THAT([&] { read("0,0\n10,1\n"); },
              ThrowsMessage<KeyError>(StartsWith("the spindle axis lies 1e+18 mm away")));
  profile_.setup.center_mm = -9e6;
  EXPECT_NO_THROW(read("0,0\n10,1\n"));
}

TEST_F(ReadProfile, RefusesPositionsOutOfOrder) {
  const std::string rule = "; positions must strictly increase (or strictly decrease)";
  EXPECT_THAT([&] { read("x,z\n0,0\n1,0\n0.5,0\n"); },
              ThrowsMessage<DataError>(file() + ": data row 3: position 0.5 follows 1" + rule));
  EXPECT_THAT([&] { read("0,0\n0.5,0\n0.5,0\n"); },
              ThrowsMessage<DataError>(file() + ": data row 3: position 0.5 follows 0.5" + rule));
  EXPECT_THAT([&] { read("0,0\n0,0\n1,0\n"); },
              ThrowsMessage<DataError>(file() + ": data row 2: position 0 follows 0" + rule));
  EXPECT_THAT([&] { read("3,0\n2,0\n2.5,0\n"); },
              ThrowsMessage<DataError>(file() + ": data row 3: position 2.5 follows 2" + rule));
}

TEST_F(ReadProfile, RefusesFewerThanTwoSamples) {
  EXPECT_THAT([&] { read("0,0\n"); },
              ThrowsMessage<DataError>(file() + ": 1 sample, at least 2 are needed"));
  source_.window = {5.0, 6.5};
  EXPECT_THAT([&] { read("0,0\n1,1\n"); },
              ThrowsMessage<DataError>(
                  file() + ": no sample in the window [5, 6.5], at least 2 are needed"));
}

TEST_F(ReadProfile, RefusesATraceThatReachesBeyondTheCut) {
  profile_.setup.cut_radius_mm = 9.0;
  EXPECT_THAT([&] { read("0,0\n10,1\n"); },
              ThrowsMessage<KeyError>(StartsWith("9, but the trace reaches r = 10; ")));
  // Four places of a radius, or of the positions, are no contradiction: 9.9996 reads 10.00.
  profile_.setup.cut_radius_mm = 9.9996;
  EXPECT_NO_THROW(read("0,0\n10,1\n"));
  EXPECT_EQ(profile_.setup.cut_radius_mm, 10.0);
  profile_.setup.kind = Kind::slide;
  profile_.setup.cut_radius_mm = 9.0;
  EXPECT_NO_THROW(read("0,0\n10,1\n"));
}

// A line's ends are those of the file, whatever has no value there.
TEST_F(ReadProfile, LaysALineByPositionsWithoutAValueToo) {
  profile_.line = Line{{0, 0}, {40, 0}};
  source_.left_out_rows = {5};
  read("40,\n30,1\n20,2\n10,1\n0,3\n");
  EXPECT_THAT(profile_.positions, ElementsAre(10.0, 20.0, 30.0));
  EXPECT_EQ(profile_.line->first_mm, 0.0);
  EXPECT_EQ(profile_.line->last_mm, 40.0);
}

}  // namespace
}  // namespace slideway
