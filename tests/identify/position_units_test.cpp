// Traces of one kind that differ in length by the ratio of two units.

#include "position_units.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "identify/cases.hpp"

namespace slideway {
namespace {

using Notes = std::vector<std::vector<std::string>>;

Profile cut_of(const std::string& name, double length_mm) {
  return cases::face(name, 8.0, {0.0, length_mm}, {0.0, 0.0});
}

Notes notes_of(std::vector<Profile> profiles) {
  note_other_position_units(profiles);
  Notes out;
  for (const Profile& profile : profiles) out.push_back(profile.doubts);
  return out;
}

const Notes kNone(3);

TEST(PositionUnits, OfTheTraceUnlikeMostOthersAreDoubted) {
  EXPECT_EQ(notes_of({cut_of("cut1", 100.0), cut_of("cut2", 0.1), cut_of("cut3", 103.0)})[1],
            std::vector<std::string>{"positions of cut2 may be in another unit: its trace is 1000 "
                                     "times shorter than that of cut1"});
  const Notes first =
      notes_of({cut_of("cut1", 2600.0), cut_of("cut2", 100.0), cut_of("cut3", 103.0)});
  EXPECT_EQ(first, (Notes{{"positions of cut1 may be in another unit: its trace is 25.4 times "
                           "longer than that of cut2"},
                          {},
                          {}}));
}

TEST(PositionUnits, OfTwoTracesTheSecondIsDoubted) {
  const Notes found = notes_of({cut_of("cut1", 0.1), cut_of("cut2", 100.0)});
  EXPECT_EQ(found, (Notes{{},
                          {"positions of cut2 may be in another unit: its trace is 1000 times "
                           "longer than that of cut1"}}));
}

TEST(PositionUnits, OfAnyOtherRatioAreNotDoubted) {
  // A diameter beside radii; 6 % beside either ratio; another kind.
  EXPECT_EQ(notes_of({cut_of("a", 100.0), cut_of("b", 200.0), cut_of("c", 50.0)}), kNone);
  for (const double ratio : {25.4, 1000.0})
    for (const double off : {0.94, 1.06})
      EXPECT_EQ(
          notes_of({cut_of("a", 100.0), cut_of("b", 100.0 * ratio * off), cut_of("c", 100.0)}),
          kNone);
  Profile slide = cut_of("b", 100.0);
  slide.setup.kind = Kind::slide;
  EXPECT_EQ(notes_of({cut_of("a", 0.1), slide, cut_of("c", 0.1)}), kNone);
}

}  // namespace
}  // namespace slideway
