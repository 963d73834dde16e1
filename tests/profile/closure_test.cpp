#include "slideway/profile/closure.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "profile/lines.hpp"
#include "slideway/base/random.hpp"

namespace slideway {
namespace {

using lines::Point;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

constexpr double kStep = 100.0;  // mm

// Any surface; a closure knows nothing of its form.
double surface(double x, double y) {
  return 1e-3 * (std::sin(x / 300.0) + 0.5 * std::cos(y / 200.0) + 1e-6 * x * y);
}

// A line of `stations` heights of a surface, with an offset and a tilt of its own.
Profile height_line(const std::string& name, const Point& from, const Point& to,
                    std::size_t stations, RandomStream& random) {
  Profile line = lines::named(name, from, to);
  const double offset = random.normal(), tilt = random.normal();
  for (std::size_t i = 0; i < stations; ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(stations - 1);
    line.positions.push_back(t * std::hypot(to[0] - from[0], to[1] - from[1]));
    line.values.push_back(
        surface(from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])) + offset +
        tilt * t);
  }
  lines::complete(line);
  return line;
}

// Its slopes over a base of one step.
Profile as_slopes(const Profile& heights) {
  Profile out = heights;
  out.positions.clear();
  out.values.clear();
  out.setup.quantity = Quantity::slope;
  const double base = heights.positions[1] - heights.positions[0];
  out.setup.base_mm = base;
  for (std::size_t i = 1; i < heights.values.size(); ++i) {
    out.positions.push_back(0.5 * (heights.positions[i - 1] + heights.positions[i]));
    out.values.push_back((heights.values[i] - heights.values[i - 1]) / base);
  }
  lines::complete(out);
  return out;
}

std::vector<Profile> union_jack(RandomStream& random) {
  std::vector<Profile> out;
  for (const lines::UnionJack& line : lines::kUnionJack)
    out.push_back(height_line(line.name, line.from(1600.0, 1000.0), line.to(1600.0, 1000.0),
                              line.steps + 1, random));
  return out;
}

// Lines along x, then along y, each with a station at each crossing and 4 steps between them.
std::vector<Profile> grid(std::size_t n, RandomStream& random) {
  std::vector<Profile> out;
  const double size = 4.0 * kStep * static_cast<double>(n - 1);
  for (const char* axis : {"x", "y"})
    for (std::size_t i = 0; i < n; ++i) {
      const double at = 4.0 * kStep * static_cast<double>(i);
      const bool along_x = std::string(axis) == "x";
      out.push_back(height_line(axis + std::to_string(i), along_x ? Point{0, at} : Point{at, 0},
                                along_x ? Point{size, at} : Point{at, size}, 4 * (n - 1) + 1,
                                random));
    }
  return out;
}

std::vector<Profile> without(std::vector<Profile> profiles, const std::string& name) {
  std::erase_if(profiles, [&](const Profile& profile) { return profile.name == name; });
  return profiles;
}

double largest(const Closure& closure) {
  double out = 0.0;
  for (const Misclosure& each : closure.readings)
    out = std::max(out, std::abs(each.size.value_or(0)));
  return out;
}

std::vector<std::string> suspects(const Closure& closure, const std::vector<Profile>& profiles) {
  std::vector<std::string> out;
  for (const std::size_t suspect : closure.suspects) out.push_back(profiles[suspect].name);
  return out;
}

// 8 lines, 24 readings at 9 places; 16 offsets and tilts and 9 heights less the plane: 2 closures.
TEST(CloseLines, ClosesAnySurfaceWithAnyOffsetsAndTilts) {
  RandomStream random(1, "surface");
  std::vector<Profile> plate = union_jack(random);
  for (const bool slopes : {false, true}) {
    if (slopes)
      for (Profile& line : plate) line = as_slopes(line);
    const Closure closure = close_lines(plate).value();
    EXPECT_EQ(closure.lines, 8U);
    EXPECT_EQ(closure.places, 9U);
    EXPECT_EQ(closure.readings.size(), 24U);
    EXPECT_EQ(closure.redundancy, 2U);
    EXPECT_FALSE(closure.worst);
    EXPECT_THAT(closure.notes, IsEmpty());
    EXPECT_LT(largest(closure), 1e-12);  // rounding of heights of about 1 mm
  }
}

// Second differences (1, -2, 1) along both directions vanish whatever the offsets and tilts are, so
// their product is the one closure of 3 by 3 lines, with weight 4 at the centre, 2 at the middles
// of the sides, 1 at the corners: an error d at the centre looks as d there, -2d or 4d elsewhere.
TEST(CloseLines, ShowsAnErrorOfOneReadingAsComputedByHand) {
  RandomStream random(2, "grid");
  std::vector<Profile> plate = grid(3, random);
  const double d = 0.25;
  plate[1].values[4] += d;  // of x1, the middle line along x, at the centre
  const Closure closure = close_lines(plate).value();
  EXPECT_EQ(closure.redundancy, 1U);
  for (const Misclosure& each : closure.readings) {
    const double sign = plate[each.profile].name[0] == 'x' ? 1.0 : -1.0;
    double expected = 4.0 * d * sign;
    for (const double at : each.place) expected /= std::abs(at - 4.0 * kStep) < 1.0 ? -2.0 : 1.0;
    EXPECT_NEAR(each.size.value(), expected, 1e-12) << plate[each.profile].name;
  }
  ASSERT_TRUE(closure.worst);
  EXPECT_THAT(closure.readings[*closure.worst].place,
              testing::ElementsAre(4.0 * kStep, 4.0 * kStep));  // where it is most precise
  EXPECT_EQ(closure.suspects.size(), 6U);                       // one closure names nobody
}

TEST(CloseLines, NamesTheLineWhereOthersAgreeAboutIt) {
  RandomStream random(3, "suspect");
  const std::vector<Profile> sound = grid(5, random);
  std::vector<Profile> step = sound, spike = sound;
  for (std::size_t i = 7; i < 17; ++i) step[1].values[i] += 0.1;  // a slope misread at station 7
  spike[1].values[8] += 0.1;  // where y2 crosses: without either line nothing is read twice there
  EXPECT_THAT(suspects(close_lines(step).value(), step), UnorderedElementsAre("x1"));
  EXPECT_THAT(suspects(close_lines(spike).value(), spike), UnorderedElementsAre("x1", "y2"));
}

// 4 sides and 2 diagonals: 14 readings, 12 offsets and tilts and 5 heights, less the plane.
TEST(CloseLines, SaysWhatNothingChecks) {
  RandomStream random(4, "square");
  std::vector<Profile> square = union_jack(random);
  square = without(without(square, "centre_x"), "centre_y");
  square[0].values[8] += 1.0;
  const Closure closure = close_lines(square).value();
  EXPECT_EQ(closure.places, 5U);
  EXPECT_EQ(closure.redundancy, 0U);
  EXPECT_FALSE(closure.readings[0].size || closure.limit || closure.worst);
}

TEST(CloseLines, MeetsOnlyOnOneSurfaceAndNotInParallel) {
  RandomStream random(5, "surfaces");
  std::vector<Profile> plate = grid(3, random);
  for (std::size_t i = 3; i < 6; ++i) plate[i].setup.z_mm = 5.0;
  EXPECT_EQ(close_lines(plate).value().places, 0U);
  plate = without(plate, "none");
  plate.resize(1);
  EXPECT_FALSE(close_lines(plate));
}

TEST(CloseLines, UsesNoSlopesOverAGapAndDoubtsLengths) {
  RandomStream random(6, "gap");
  std::vector<Profile> plate = union_jack(random);
  for (Profile& line : plate) line = as_slopes(line);
  plate[2].positions.erase(plate[2].positions.begin() + 4);
  plate[2].values.erase(plate[2].values.begin() + 4);
  for (Point* end : {&plate[3].line->from_mm, &plate[3].line->to_mm})
    for (double& coordinate : *end) coordinate *= 1.0 / 25.4;
  const Closure closure = close_lines(plate).value();
  EXPECT_EQ(closure.lines, 7U);
  EXPECT_THAT(closure.notes,
              UnorderedElementsAre(HasSubstr("a gap in its slopes"), HasSubstr("are both right?")));
}

TEST(CloseLines, ComparesTwoProfilesOfOneLineStationByStation) {
  RandomStream random(7, "twice");
  std::vector<Profile> twice{height_line("once", {0, 0}, {1600, 0}, 17, random),
                             height_line("again", {0, 0}, {1600, 0}, 17, random)};
  for (double& value : twice[0].values) value += 1e-4 * random.normal();
  EXPECT_FALSE(close_lines(twice).value().repeats.at(0).is_beyond());
  twice[1] = as_slopes(twice[1]);
  twice[0].values[3] += 2e-3;
  const Closure closure = close_lines(twice).value();
  const Repeat& repeat = closure.repeats.at(0);
  EXPECT_EQ(repeat.stations, 17U);
  EXPECT_TRUE(repeat.is_beyond());
  EXPECT_NEAR(repeat.place[0], 300.0, 1e-9);
  EXPECT_NEAR(repeat.difference, -2e-3, 4e-4);  // four of its uncertainties
}

// --- false alarms: of `kSets` sets 1 in 1000 may alarm, 2 of them; Poisson's 99.9 % allow 8
// -------

constexpr int kSets = 2000, kAllowed = 8;

void expect_few_alarms(const std::string& what,
                       const std::function<std::vector<Profile>(RandomStream&)>& make) {
  RandomStream random(8, what);
  int alarms = 0, repeats = 0;
  for (int i = 0; i < kSets; ++i) {
    const Closure closure = close_lines(make(random)).value();
    EXPECT_TRUE(closure.limit);
    alarms += closure.worst ? 1 : 0;
    for (const Repeat& repeat : closure.repeats) repeats += repeat.is_beyond() ? 1 : 0;
  }
  EXPECT_LE(alarms, kAllowed) << what;
  EXPECT_LE(repeats, kAllowed) << what;
}

void add_noise(std::vector<Profile>& plate, double memory, RandomStream& random) {
  for (Profile& line : plate) {
    double last = 0.0;
    for (double& value : line.values) {
      last = memory * last + random.normal();
      value += 1e-3 * last;
    }
  }
}

TEST(CloseLines, AlarmsInOneOfAThousandSetsOfSlopes) {
  expect_few_alarms("slopes", [](RandomStream& random) {
    std::vector<Profile> plate = union_jack(random);
    for (Profile& line : plate) line = as_slopes(line);
    for (Profile& line : plate)
      for (double& value : line.values) value += 1e-4 * random.normal();
    return plate;
  });
}

TEST(CloseLines, AlarmsInOneOfAThousandSetsOfSteppedHeights) {
  for (const double memory : {0.0, 0.7, 1.0})
    expect_few_alarms("heights, memory " + std::to_string(memory), [&](RandomStream& random) {
      std::vector<Profile> plate = union_jack(random);
      add_noise(plate, memory, random);
      return plate;
    });
}

TEST(CloseLines, AlarmsInOneOfAThousandSetsOfScannedHeights) {
  for (const double memory : {0.0, 0.7, 1.0})
    expect_few_alarms("scans, memory " + std::to_string(memory), [&](RandomStream& random) {
      std::vector<Profile> plate;
      for (const lines::UnionJack& line : lines::kUnionJack)
        plate.push_back(
            height_line(line.name, line.from(1600, 1000), line.to(1600, 1000), 201, random));
      add_noise(plate, memory, random);
      return plate;
    });
}

// Each height where lines meet is set to the mean there, offsets and tilts taken out before.
TEST(CloseLines, AlarmsInOneOfAThousandSetsOfTiedHeights) {
  expect_few_alarms("tied", [](RandomStream& random) {
    std::vector<Profile> plate = union_jack(random);
    add_noise(plate, 1.0, random);
    lines::tie(plate);
    return plate;
  });
}

TEST(CloseLines, AlarmsInOneOfAThousandRepeatedLines) {
  expect_few_alarms("repeats", [](RandomStream& random) {
    std::vector<Profile> plate = grid(3, random);
    plate.push_back(height_line("again", plate[0].line->from_mm, plate[0].line->to_mm, 9, random));
    add_noise(plate, random.uniform() < 0.5 ? 0.0 : 1.0, random);
    return plate;
  });
}

}  // namespace
}  // namespace slideway
