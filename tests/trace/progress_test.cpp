// What who waits is told.

#include <thread>

#include "trace/faces.hpp"

namespace slideway {
namespace {

using namespace faces;  // NOLINT(google-build-using-namespace)

TEST(Progress, EachStageGoesFromItsBeginningOnInTheThreadOfTheCaller) {
  const turning::Hidden drift{"linear_drift",
                              [](const turning::ToolPoint& p) { return 0.6e-3 * p.t / 300.0; }};
  std::vector<std::pair<std::string, double>> told;
  const std::thread::id caller = std::this_thread::get_id();
  close_loop(problem_of({"linear_drift", "slide_periodic", "centre_step"}),
             quarter_faces(drift, 3, kBlunt, 5), [&](const std::string& stage, double done) {
               EXPECT_EQ(std::this_thread::get_id(), caller) << stage;
               EXPECT_GE(done, 0.0) << stage;
               EXPECT_LE(done, 1.0) << stage;
               if (!told.empty() && told.back().first == stage) {
                 EXPECT_GE(done, told.back().second) << stage;
               }
               told.emplace_back(stage, done);
             });
  std::vector<std::string> stages;
  for (const auto& [stage, done] : told)
    if (stages.empty() || stages.back() != stage) stages.push_back(stage);
  EXPECT_THAT(stages,
              testing::ElementsAre("making the columns of every candidate", "searching round 1",
                                   "bootstrap", "searching round 1", "searching round 2",
                                   "comparing rivals", "describing what is left"));
}

}  // namespace
}  // namespace slideway
