// The report is the same, run for run and for any number of threads.

#include <sched.h>

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
  const auto report = [&] {
    const TraceResult trace = close_loop(problem, cut);
    return json_report(identify(problem, cut), &trace);
  };
  const std::string first = report();
  EXPECT_THAT(first, ::testing::HasSubstr("slide_periodic"));
  EXPECT_EQ(first, report());
}

/// Keeps this thread, and the programs it starts, on one processor.
class OneProcessor {
 public:
  OneProcessor() {
    CPU_ZERO(&before_);
    good_ = ::sched_getaffinity(0, sizeof before_, &before_) == 0;
    cpu_set_t one;
    CPU_ZERO(&one);
    for (int i = 0; i < CPU_SETSIZE; ++i)
      if (CPU_ISSET(i, &before_)) {
        CPU_SET(i, &one);
        break;
      }
    good_ = good_ && ::sched_setaffinity(0, sizeof one, &one) == 0;
  }
  ~OneProcessor() { ::sched_setaffinity(0, sizeof before_, &before_); }
  OneProcessor(const OneProcessor&) = delete;
  OneProcessor& operator=(const OneProcessor&) = delete;
  [[nodiscard]] bool good() const { return good_; }

 private:
  cpu_set_t before_;
  bool good_ = false;
};

class SameBytesOfTheProgram : public ProgramTest {};

TEST_F(SameBytesOfTheProgram, OnOneProcessorAndOnAll) {
  const std::vector<std::string> arguments{
      "identify", shipped("problems/paper-face-10mm/problem.toml"), "--json", "-", "--quiet"};
  const ProgramRun all = run(arguments);
  const OneProcessor one;
  if (!one.good()) GTEST_SKIP() << "no right to choose a processor";
  const ProgramRun single = run(arguments);
  EXPECT_EQ(all.exit_code, 0) << all.err;
  EXPECT_GT(all.out.size(), 1000U);
  EXPECT_EQ(all.out, single.out);
}

}  // namespace
}  // namespace slideway
