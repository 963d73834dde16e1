// Known effects on backgrounds nobody simulated: a milled surface, and traces along a mirror.

#include <cmath>

#include "problems/shipped.hpp"
#include "slideway/base/units.hpp"
#include "slideway/format/format.hpp"
#include "trace/faces.hpp"

namespace slideway {
namespace {

using namespace faces;  // NOLINT(google-build-using-namespace)
using turning::Hidden;
using turning::ToolPoint;

class RealBackground : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(measured_data()))
      GTEST_SKIP() << "no " << measured_data().string() << "; set SLIDEWAY_DATA";
  }
};

constexpr double kRadius = 2.8;    // mm: half of the milled profile each
constexpr double kFeed = 2.2;      // mm/min at 110 rpm: 0.02 mm a turn, marks of 25 nm
constexpr double kStep = 0.25e-3;  // mm

/// Two cuts whose roughness and waviness are the halves of NIST's milled surface, each levelled by
/// nothing but the free offset and tilt.
std::vector<Profile> milled_faces(const Hidden& hidden) {
  const Trace milled =
      read_trace(measured_data() / "nist_npl_reference_profiles/mill.xml", {}).trace;
  std::vector<Profile> out;
  for (const bool inward : {true, false}) {
    turning::Cut cut;
    cut.radius_mm = kRadius;
    cut.feed_mm_per_min = kFeed;
    cut.inward = inward;
    cut.nose_radius_mm = kSharp;
    Profile profile;
    profile.name = inward ? "inward" : "outward";
    for (int i = 0; i < 11200; ++i) profile.positions.push_back(kStep * i);
    const std::size_t first = inward ? 0 : 11200;
    turning::Stylus stylus;
    stylus.datum = [&](double X, double) {
      const auto at = static_cast<std::size_t>(std::lround(std::abs(X) / kStep));
      return milled.values[first + at] * kMicrometre;
    };
    RandomStream random(1, "no noise of ours");
    profile.values =
        turning::trace(turning::Face(cut, hidden.tool), profile.positions, stylus, random);
    Setup& setup = profile.setup;
    setup.feed_mm_per_min = kFeed;
    setup.spindle_rpm = 110.0;
    setup.cut_direction = inward ? CutDirection::inward : CutDirection::outward;
    setup.cut_radius_mm = kRadius;
    setup.last_mm = profile.positions.back();
    out.push_back(std::move(profile));
  }
  return out;
}

Problem milled_problem() {
  Problem problem = problem_of();
  problem.low_band.level = 7;  // 32 µm a value
  problem.effects = {{"straightness", {std::nullopt, 2, std::nullopt}, {}}};
  return problem;
}

// Its strongest wavelength is 200 µm, the feed of the mill; nothing else is there.
TEST_F(RealBackground, MilledSurfaceHasItsOwnMarksOnly) {
  const TraceResult result =
      close_loop(milled_problem(), milled_faces({"nothing", [](const ToolPoint&) { return 0.0; }}));
  SCOPED_TRACE(story(result));
  ASSERT_EQ(result.rounds.size(), 1U);
  EXPECT_EQ(result.rounds[0].accepted, "slide_periodic");
  expect_within_4u(result.rounds[0].parameters, "slide_periodic.period_mm", 0.2);
}

// Time and revolutions are one clock at one spindle speed.
TEST_F(RealBackground, PeriodInTimeOnAMilledSurface) {
  const TraceResult result = close_loop(
      milled_problem(), milled_faces({"time_periodic", [](const ToolPoint& p) {
                                        return 0.3e-3 * std::cos(2.0 * kPi * p.t / 9.1 + 0.3);
                                      }}));
  SCOPED_TRACE(story(result));
  const TraceRound* time = round_of(result, "time_periodic");
  const TraceRound* revolution = round_of(result, "revolution_periodic");
  ASSERT_TRUE(time || revolution);
  if (time) {
    EXPECT_THAT(time->ambiguous_with, ::testing::ElementsAre("revolution_periodic"));
    expect_within_4u(time->parameters, "time_periodic.period_s", 9.1);
    expect_within_4u(time->parameters, "time_periodic.amplitude_um", 0.3);
  } else {
    EXPECT_THAT(revolution->ambiguous_with, ::testing::ElementsAre("time_periodic"));
    expect_within_4u(revolution->parameters, "revolution_periodic.cycles_per_revolution",
                     60.0 / 110.0 / 9.1);
  }
}

TEST_F(RealBackground, StepOnAMilledSurface) {
  static constexpr double kHeight = 2e-3;  // mm; half of it is 4 of its standard uncertainties
  const TraceResult result = close_loop(
      milled_problem(),
      milled_faces({"step", [](const ToolPoint& p) { return p.r < 1.234 ? kHeight : 0.0; }}));
  SCOPED_TRACE(story(result));
  const TraceRound* round = round_of(result, "step");
  ASSERT_NE(round, nullptr);
  EXPECT_THAT(round->ambiguous_with, ::testing::IsEmpty());
  expect_within_4u(round->parameters, "step.height_um", kHeight / kMicrometre);
  const FittedParameter* position = find(round->parameters, "step.position_mm");
  ASSERT_NE(position, nullptr);
  EXPECT_NEAR(*position->value, 1.234, 0.1);  // the nose: sqrt(2 · 2 mm · 2 µm) = 0.089 mm
}

/// Two parallel traces along a mirror (DABAM 071, 073), slopes, with the slope of `rise` laid over.
std::vector<Profile> mirror_traces(double amplitude_mm, double period_mm) {
  std::vector<Profile> out;
  for (const std::string entry : {"071", "073"}) {
    Profile profile;
    profile.name = "trace " + entry;
    TraceRequest request;
    request.header_lines = 6;  // FILE_HEADER_LINES of dabam-071.txt
    Trace trace =
        read_trace(measured_data() / ("dabam_slope_profiles/dabam-" + entry + ".dat"), request)
            .trace;
    profile.positions = std::move(trace.positions);
    for (std::size_t i = 0; i < trace.values.size(); ++i) {
      const double phase = 2.0 * kPi * profile.positions[i] / period_mm;
      profile.values.push_back(trace.values[i] * kMicroradian -
                               amplitude_mm * 2.0 * kPi / period_mm * std::sin(phase));
    }
    profile.setup.kind = Kind::slide;
    profile.setup.quantity = Quantity::slope;
    profile.setup.first_mm = profile.positions.front();
    profile.setup.last_mm = profile.positions.back();
    out.push_back(std::move(profile));
  }
  return out;
}

TEST_F(RealBackground, WavinessLaidOverTwoTracesOfAMirror) {
  Problem problem = problem_of();
  problem.low_band.level = 4;
  problem.effects = {{"straightness", {std::nullopt, 2, std::nullopt}, {}}};
  const TraceResult result = close_loop(problem, mirror_traces(30e-6, 21.7));
  SCOPED_TRACE(story(result));
  const TraceRound* round = round_of(result, "slide_periodic");
  ASSERT_NE(round, nullptr);
  EXPECT_THAT(round->ambiguous_with, ::testing::IsEmpty());
  expect_within_4u(round->parameters, "slide_periodic.period_mm", 21.7);
  expect_within_4u(round->parameters, "slide_periodic.amplitude_um", 0.030);
}

}  // namespace
}  // namespace slideway
