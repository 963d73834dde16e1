#include <gmock/gmock.h>

#include "report/sample_result.hpp"
#include "slideway/report/report.hpp"

namespace slideway::box_test {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string short_text(const Result& result, const TraceResult& trace) {
  return text_report({result, trace});
}

TEST(Box, CutsNothingOfTheBoxWhereItHasAllRoom) {
  TraceResult trace;
  trace.verdict = TraceVerdict::unnamed;
  trace.advice = {std::string(60, 'w') + " " + std::string(60, 'x') + " " + std::string(60, 'y')};
  Result result = sample_result();
  result.final->identifiability.unidentifiable.clear();
  result.crosscheck.squareness->reason = std::string(60, 'z') + " " + std::string(60, 'v');
  result.crosscheck.squareness->En.reset();
  EXPECT_THAT(short_text(result, trace), HasSubstr("…"));
  const std::string text = text_report({result, trace}, {.full = true, .page = ""});
  const std::string box = text.substr(0, text.find("\n\n"));
  for (const char letter : {'w', 'x', 'y', 'z', 'v'})
    EXPECT_THAT(box, HasSubstr(std::string(60, letter)));
  EXPECT_THAT(box, Not(HasSubstr("…")));
}

TEST(Box, KeepsTheNextStepInTheBox) {
  TraceResult trace;
  trace.verdict = TraceVerdict::nothing_missing;
  Result result = sample_result();
  result.final->identifiability.unidentifiable.clear();
  result.crosscheck.squareness->reason = std::string(60, 'z') + " " + std::string(60, 'v');
  result.crosscheck.squareness->En.reset();
  EXPECT_THAT(short_text(result, trace), HasSubstr("│ Next     none is needed"));
}

TEST(Box, HasANextStepWhereverTheNumbersAreInDoubt) {
  TraceResult trace;
  trace.verdict = TraceVerdict::nothing_missing;
  Result sound = sample_result();
  sound.final->identifiability.unidentifiable.clear();
  const auto next = [&](const Result& result) {
    return line_with(short_text(result, trace), "│ Next");
  };
  EXPECT_THAT(next(sound), HasSubstr("none is needed"));
  EXPECT_THAT(short_text(sound, trace), HasSubstr("Nothing missing:"));

  Result result = sound;
  result.final->converged = false;
  EXPECT_THAT(next(result), HasSubstr("the fit must converge"));
  EXPECT_THAT(line_with(short_text(result, trace), "│ Result"), Not(HasSubstr("±")));

  result = sound;
  result.crosscheck.held_out = {{.profile = "cut3", .verdict = HeldOutVerdict::does_not_fit}};
  EXPECT_THAT(next(result), HasSubstr("what sets cut3 apart"));
  EXPECT_THAT(short_text(result, trace), Not(HasSubstr("Nothing missing")));

  result = sound;
  result.crosscheck.profiles = {
      {.profiles = {"a", "c"}, .what = "squareness", .verdict = Consistency::inconsistent}};
  EXPECT_THAT(next(result), HasSubstr("why a and c disagree"));
  EXPECT_THAT(short_text(result, trace), HasSubstr("│ Verdict  Inconsistent: a and c disagree"));

  // U of the squareness is 2.2e-9 rad.
  trace.detection_limits = {{.effect = "tool_wear", .squareness_rad = 2.0e-9}};
  EXPECT_THAT(next(sound), HasSubstr("none is needed"));
  trace.detection_limits[0].squareness_rad = 3.0e-9;
  EXPECT_THAT(next(sound), HasSubstr("slideway plan"));
  trace.next_cut = {"cut1-feed8", "a cut at 8 mm/min", "tells cup from tool_wear; 75 min"};
  EXPECT_THAT(next(sound), HasSubstr("a cut at 8 mm/min, by slideway plan"));
}

TEST(Box, CountsTheContradictionsThatItHasNoRoomFor) {
  TraceResult trace;
  trace.verdict = TraceVerdict::unnamed;
  Result result = sample_result();
  const auto odd = [](const char* with, const char* what) {
    return ProfileCheck{.profiles = {"inward", with},
                        .what = what,
                        .En = 1.5,
                        .verdict = Consistency::inconsistent};
  };
  result.crosscheck.profiles = {odd("coarse", "squareness"), odd("coarse", "straightness"),
                                odd("outward", "straightness")};
  EXPECT_THAT(
      short_text(result, trace),
      HasSubstr("│ Check    INCONSISTENT: squareness of inward and coarse, E_n = 1.5; 2 more\n"));
  EXPECT_THAT(short_text(result, trace),
              HasSubstr("inward and coarse disagree in squareness and straightness;"));
  const std::string all = text_report({result, trace}, {.full = true, .page = ""});
  EXPECT_THAT(all.substr(0, all.find("\n\n")), HasSubstr("of inward and outward, E_n = 1.5"));
}

// It is why they disagree, and two lines have no room for all of both.
TEST(Box, BeginsWithTheBlunder) {
  TraceResult trace;
  trace.verdict = TraceVerdict::unnamed;
  trace.blunders = {{.profile = "coarse", .what = BlunderKind::sign}};
  trace.advice = {"profile coarse: wrong sign"};
  Result result = sample_result();
  result.crosscheck.profiles = {{.profiles = {"inward", "coarse"},
                                 .what = "squareness",
                                 .verdict = Consistency::inconsistent}};
  EXPECT_THAT(short_text(result, trace), HasSubstr("│ Verdict  Blunder: profile coarse disagrees"));
}

}  // namespace
}  // namespace slideway::box_test
