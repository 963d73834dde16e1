#include "slideway/report/emphasis.hpp"

#include <gmock/gmock.h>

#include "report/sample_result.hpp"
#include "slideway/report/report.hpp"

namespace slideway::emphasis_test {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(Emphasis, IsOfHeadingsAlone) {
  EXPECT_EQ(with_emphasis("Title\n=====\n\nInputs\n  feed2\n    0.5 ⠀⡄\n"),
            "\033[1mTitle\033[22m\n\033[1m=====\033[22m\n\n\033[1mInputs\033[22m\n  feed2\n    0.5 "
            "⠀⡄\n");
  EXPECT_EQ(with_emphasis(""), "");
  EXPECT_EQ(with_emphasis("  no newline"), "  no newline");
}

TEST(Emphasis, HasAColourForEveryVerdict) {
  TraceResult trace;
  for (const auto& [verdict, colour] : {std::pair{TraceVerdict::nothing_missing, "\033[32m"},
                                        {TraceVerdict::explained, "\033[32m"},
                                        {TraceVerdict::ambiguous, "\033[33m"},
                                        {TraceVerdict::unnamed, "\033[31m"},
                                        {TraceVerdict::not_identifiable, "\033[31m"}}) {
    trace.verdict = verdict;
    Result result = sample_result();
    *result.declared->parameters[0].value += *result.final->parameters[0].expanded_uncertainty;
    EXPECT_THAT(with_emphasis(text_report({result, trace})), HasSubstr(colour)) << text_of(verdict);
  }
  Result result = sample_result();
  EXPECT_THAT(with_emphasis(text_report({result})), Not(HasSubstr("\033[31m")));
  result.final->converged = false;
  EXPECT_THAT(with_emphasis(text_report({result})), HasSubstr("\033[31mNot converged:\033[39m"));
}

}  // namespace
}  // namespace slideway::emphasis_test
