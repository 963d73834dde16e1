#include "identify/problem_file.hpp"

namespace slideway {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class PlannedCutFile : public ProblemFile {
 protected:
  /// The message that refuses a [[plan.cut]] with these lines, or "".
  [[nodiscard]] std::string cut_refusal(const std::string& lines) const {
    return refusal_behind("[[plan.cut]]\n" + lines + "\n");
  }
};

TEST_F(PlannedCutFile, TakesWhatItLeavesOutFromTheProfileItIsLike) {
  const std::string text =
      kMachine + profile("feed_mm_per_min = 2.0\nspindle_rpm = 110.0\nz_mm = 5.0") +
      profile("feed_mm_per_min = 8.0", "feed8") + kEffect +
      "[[plan.cut]]\nname = \"a\"\nspindle_rpm = 200.0\ntime_min = 12.0\n"
      "[[plan.cut]]\nname = \"b\"\nlike = \"feed8\"\nwindow = [0.0, 10.0]\nsamples = 50\n";
  const std::vector<PlannedCut> cuts = read_problem(write(text)).planned;
  ASSERT_EQ(cuts.size(), 2U);
  EXPECT_EQ(cuts[0].like, "feed2");
  const slideway::Setup& setup = cuts[0].entry.profile.setup;
  EXPECT_EQ(setup.feed_mm_per_min, 2.0);
  EXPECT_EQ(setup.spindle_rpm, 200.0);
  EXPECT_EQ(setup.z_mm, 5.0);
  EXPECT_EQ(cuts[0].time_min, 12.0);
  EXPECT_EQ(cuts[1].entry.profile.setup.feed_mm_per_min, 8.0);
  EXPECT_EQ(cuts[1].samples, 50U);
  EXPECT_TRUE(read_problem(write(kMachine + profile() + kEffect)).planned.empty());
}

// An SDF file states its units, so its profile need not; a cut like it is planned in mm and µm.
TEST_F(PlannedCutFile, LikeAFileThatStatesItsUnitsIsInMillimetres) {
  write(
      "aNPL-V1.0\r\nNumPoints = 4\r\nNumProfiles = 1\r\nXscale = 2.5E-07\r\nYscale = 0\r\n"
      "Zscale = 1E-06\r\nZresolution = -1\r\nCompression = 0\r\nDataType = 7\r\n"
      "CheckType = 0\r\n*\r\n-0.3\r\n-0.2\r\n-0.1\r\n-0.2\r\n*\r\n*",
      "own.sdf");
  const std::string text = std::string(kMachine) +
                           "[[profile]]\nname = \"own\"\nfile = \"own.sdf\"\n" + kEffect +
                           "[[plan.cut]]\nname = \"a\"\nwindow = [0.0, 10.0]\nsamples = 50\n";
  const std::vector<PlannedCut> cuts = read_problem(write(text)).planned;
  ASSERT_EQ(cuts.size(), 1U);
  EXPECT_EQ(cuts[0].entry.source.position_unit, "mm");
  EXPECT_EQ(cuts[0].entry.source.value_unit, "um");
}

TEST_F(PlannedCutFile, NamesLineAndKeyOfAMistypedOne) {
  EXPECT_THAT(cut_refusal("name = \"a\"\nfede_mm_per_min = 2.0"),
              HasSubstr(":13: plan.cut.fede_mm_per_min: unknown key (did you mean "
                        "'feed_mm_per_min'?); accepted: like samples"));
  EXPECT_THAT(refusal_behind("[plan]\ncuts = 3\n"),
              HasSubstr("plan.cuts: unknown key (did you mean 'cut'?); accepted: cut"));
  EXPECT_THAT(cut_refusal("name = \"a\"\nfile = \"a.csv\""), HasSubstr("plan.cut.file: unknown"));
}

TEST_F(PlannedCutFile, RefusesWhatNoCutCanBe) {
  EXPECT_THAT(cut_refusal("feed_mm_per_min = 2.0"), HasSubstr("plan.cut.name: missing"));
  EXPECT_THAT(cut_refusal("name = \"feed2\""), HasSubstr("'feed2' is used twice"));
  EXPECT_THAT(cut_refusal("name = \"a\"\nlike = \"feed3\""),
              AllOf(HasSubstr("plan.cut.like: 'feed3' is no profile of this kind and quantity"),
                    HasSubstr("accepted: feed2")));
  EXPECT_THAT(cut_refusal("name = \"a\"\nsamples = 100"), HasSubstr("plan.cut.window: missing"));
  EXPECT_THAT(cut_refusal("name = \"a\"\ncost = -1"), HasSubstr("plan.cut.cost"));
}

// Nothing tells the positions and the noise of a reading that no profile is like.
TEST_F(PlannedCutFile, NeedsAllMetadataOfAReadingLikeNone) {
  EXPECT_THAT(cut_refusal("name = \"a\"\nkind = \"slide\""), HasSubstr("plan.cut.window: missing"));
  EXPECT_THAT(cut_refusal("name = \"a\"\nkind = \"slide\"\nwindow = [0, 100]\nsamples = 50"),
              HasSubstr("plan.cut.standard_uncertainty: missing"));
  EXPECT_EQ(cut_refusal("name = \"a\"\nkind = \"slide\"\nwindow = [0, 100]\nsamples = 50\n"
                        "standard_uncertainty = 0.1\nposition_unit = \"mm\"\nvalue_unit = \"um\""),
            "");
}

}  // namespace
}  // namespace slideway
