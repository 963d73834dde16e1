// The report is the same, run for run and for any number of threads.

#include "cli/run_program.hpp"
#include "slideway/identify/identify.hpp"
#include "slideway/report/report.hpp"
#include "trace/faces.hpp"

namespace slideway {
namespace {

using namespace faces;  // NOLINT(google-build-using-namespace)

TEST(SameBytes, RunForRun) {
  RandomStream random(1, "slide_periodic");
  const turning::Hidden hidden = turning::make_hidden("slide_periodic", 0.1e-3, random);
  const std::vector<Profile> cut = quarter_faces(hidden, 1, kBlunt, 1);
  const Problem problem = problem_of();
  const auto report = [&] { return json_report(analyse(problem, cut)); };
  const std::string first = report();
  EXPECT_THAT(first, ::testing::HasSubstr("slide_periodic"));
  EXPECT_EQ(first, report());
}

#ifdef SLIDEWAY_PROCESSORS
class SameBytesOfTheProgram : public ProgramTest {
 protected:
  [[nodiscard]] std::string report_with(const std::string& processors) const {
    const ProgramRun run = run_program(
        {"identify", shipped("problems/paper-face-10mm/problem.toml"), "--json", "-"},
        {folder_.path(), {}, {{"LD_PRELOAD", SLIDEWAY_PROCESSORS}, {"PROCESSORS", processors}}});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.err, ::testing::HasSubstr("processors: " + processors));
    return run.out;
  }
};

TEST_F(SameBytesOfTheProgram, ForAnyNumberOfThreads) {
  const std::string one = report_with("1");
  EXPECT_THAT(one, ::testing::HasSubstr("\"rounds\""));
  EXPECT_EQ(one, report_with("3"));
}
#endif

}  // namespace
}  // namespace slideway
