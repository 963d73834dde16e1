#include <gmock/gmock.h>

#include "cli/run_program.hpp"

namespace slideway::html_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

const std::string kProblem = shipped("problems/paper-face-10mm/problem.toml");

using Html = ProgramTest;

TEST_F(Html, TheJsonMakesTheSamePageLater) {
  ASSERT_EQ(
      run({"identify", kProblem, "--no-trace", "--json", "a.json", "--html", "a.html"}).exit_code,
      0);
  const ProgramRun later = run({"report", "a.json", "--html", "b.html"});
  EXPECT_EQ(later.exit_code, 0) << later.err;
  EXPECT_EQ(later.out, "");
  EXPECT_EQ(contents(path("a.html")), contents(path("b.html")));
}

TEST_F(Html, GoesToStdoutAloneIfAsked) {
  const ProgramRun page = run({"fit", kProblem, "--html", "-"});
  EXPECT_EQ(page.exit_code, 0) << page.err;
  EXPECT_THAT(page.out, StartsWith("<!DOCTYPE html>"));
  EXPECT_THAT(page.out, testing::EndsWith("</html>\n"));
}

TEST_F(Html, IsMadeOfARankingToo) {
  EXPECT_EQ(run({"rank", kProblem, "--html", "problem.html"}).exit_code, 0);
  EXPECT_THAT(contents(path("problem.html")), HasSubstr("Ranking only"));
  const ProgramRun columns =
      run({"rank", shipped("data/axis-ranking.csv"), "--signal", "2", "--candidates", "3", "4",
           "--level", "5", "--html", "columns.html"});
  EXPECT_EQ(columns.exit_code, 0) << columns.err;
  const std::string page = contents(path("columns.html"));
  EXPECT_THAT(page, HasSubstr("Correlation with column"));
  EXPECT_THAT(page, HasSubstr("Low band: db1, level 5, symmetric."));
}

TEST_F(Html, WhatIsNoReportIsRefused) {
  for (const std::string text :
       {"", "{", "[1, 2]", "{\"schema\": \"slideway.report/9\"}",
        "{\"schema\": \"slideway.report/2\"}",
        "{\"schema\": \"slideway.report/2\", \"title\": 1e999}", "\xff\xfe"}) {
    folder_.file("r.json", text);
    const ProgramRun refused = run({"report", "r.json", "--html", "r.html"});
    EXPECT_TRUE(is_refused(refused, 3)) << text;
    EXPECT_THAT(refused.err, StartsWith("slideway: r.json: "));
  }
  EXPECT_TRUE(is_refused(run({"report", "gone.json", "--html", "r.html"}), 3));
  EXPECT_TRUE(is_refused(run({"report", "r.json", "--html", "./r.json"}), 2));
}

}  // namespace
}  // namespace slideway::html_test
