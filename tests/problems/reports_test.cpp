// What holds of the report of every problem that ships with its data.

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "problems/shipped.hpp"
#include "slideway/report/document.hpp"
#include "slideway/report/report.hpp"

namespace slideway {
namespace {

using nlohmann::json;

class ShippedReport : public testing::TestWithParam<const char*> {
 protected:
  [[nodiscard]] static Analysis analysed(const AnalysisOptions& options) {
    const Problem problem = shipped_problem(GetParam() + std::string("/problem.toml"));
    return analyse(problem, read_profiles(problem), options);
  }
};

TEST_P(ShippedReport, ReadBackMakesTheSameBytes) {
  const std::string text = json_report(analysed({.closes_loop = false, .with_details = true}));
  EXPECT_EQ(json_report(parse_report(text, "report")), text);
}

TEST_P(ShippedReport, WithoutTheLoopTheDeclaredModelIsTheFinalOne) {
  const json report = json::parse(json_report(analysed({.closes_loop = false})));
  EXPECT_FALSE(report["final"]["parameters"].empty());
  EXPECT_EQ(report["declared"], report["final"]);
  EXPECT_TRUE(report["trace"].is_null());
}

INSTANTIATE_TEST_SUITE_P(Of, ShippedReport,
                         testing::Values("paper-600mm", "paper-face-10mm", "three-levels",
                                         "milling-machine-way"),
                         [](const auto& name) {
                           std::string text = name.param;
                           std::erase(text, '-');
                           return text;
                         });

// The loop adds feed marks here: each parameter of the two models stands in its own.
TEST(FinalModel, HoldsWhatTheLoopAddedAndIsWhatIsCrossChecked) {
  const Problem problem = shipped_problem("paper-face-10mm/problem.toml");
  const Analysis analysis = analyse(problem, read_profiles(problem));
  const ModelResult &declared = *analysis.result.declared, &final = *analysis.result.final;
  ASSERT_FALSE(analysis.trace->rounds.empty());
  for (const TraceRound& round : analysis.trace->rounds) {
    EXPECT_THAT(final.effects, testing::Contains(term_name(round.accepted, round.profiles)));
    for (const FittedParameter& p : round.parameters)
      EXPECT_EQ(p.expanded_uncertainty, final.find(p.name)->expanded_uncertainty) << p.name;
  }
  EXPECT_GE(final.effects.size(), declared.effects.size());
  EXPECT_EQ(analysis.result.crosscheck.squareness->fit_U_rad,
            final.find("squareness.dbeta_xz")->expanded_uncertainty);
}

}  // namespace
}  // namespace slideway
