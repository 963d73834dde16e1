// Within a time limit nothing is named that was not held against its rivals.

#include <chrono>
#include <thread>

#include "trace/faces.hpp"

namespace slideway::time_limit_test {
namespace {

using namespace faces;  // NOLINT(google-build-using-namespace)
using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

class TimeLimited : public testing::Test {
 protected:
  /// The loop with a limit three times as long as it takes, slept through at a stage.
  [[nodiscard]] TraceResult slept_at(const std::string& where) const {
    Problem problem = problem_;
    const Seconds limit = 3.0 * took_ + Seconds(0.2);
    problem.trace.time_limit_s = limit.count();
    bool has_slept = false;
    return close_loop(problem, profiles_, [&](const std::string& stage, double) {
      if (stage == where && !std::exchange(has_slept, true)) std::this_thread::sleep_for(limit);
    });
  }

  Problem problem_ = problem_of({"linear_drift", "slide_periodic", "centre_step"});
  std::vector<Profile> profiles_ = quarter_faces(
      {"linear_drift", [](const turning::ToolPoint& p) { return 0.6e-3 * p.t / 300.0; }}, 3, kBlunt,
      5);
  Clock::time_point start_ = Clock::now();
  TraceResult whole_ = close_loop(problem_, profiles_);
  Seconds took_ = Clock::now() - start_;
};

TEST_F(TimeLimited, NothingIsNamedBeforeItIsHeldAgainstItsRivals) {
  ASSERT_EQ(whole_.verdict, TraceVerdict::explained);
  for (const char* stage : {"searching round 1", "searching round 2", "comparing rivals"}) {
    const TraceResult found = slept_at(stage);
    EXPECT_TRUE(found.unfinished) << stage;
    EXPECT_EQ(found.verdict, TraceVerdict::unnamed) << stage;
    EXPECT_THAT(found.rounds, testing::IsEmpty()) << stage;
    for (const TriedEffect& tried : found.refused) EXPECT_TRUE(tried.refused) << stage;
  }
}

TEST_F(TimeLimited, WhatIsNamedByThenStaysAndWhatWasLeftOutIsSaid) {
  const TraceResult found = slept_at("describing what is left");
  EXPECT_FALSE(found.unfinished);
  EXPECT_EQ(found.verdict, whole_.verdict);
  ASSERT_EQ(found.rounds.size(), 1U);
  EXPECT_EQ(found.rounds[0].accepted, "linear_drift");
  EXPECT_THAT(found.not_looked_at, testing::Contains("detection limits"));
  EXPECT_THAT(found.detection_limits, testing::IsEmpty());
  EXPECT_FALSE(found.fragile);
}

TEST_F(TimeLimited, ALongLimitChangesNothing) {
  Problem problem = problem_;
  problem.trace.time_limit_s = 1e6;
  const TraceResult found = close_loop(problem, profiles_);
  EXPECT_FALSE(found.unfinished);
  EXPECT_THAT(found.not_looked_at, testing::IsEmpty());
  EXPECT_EQ(found.rounds.at(0).delta_bic, whole_.rounds.at(0).delta_bic);
  EXPECT_EQ(found.detection_limits.size(), whole_.detection_limits.size());
}

}  // namespace
}  // namespace slideway::time_limit_test
