#include "slideway/report/comparison.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "report/sample_result.hpp"
#include "slideway/base/error.hpp"
#include "slideway/report/layout.hpp"

namespace slideway::comparison_test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

NamedReport sample(const std::string& name) { return {name, {sample_result()}}; }

TEST(Comparison, OfAReportWithItselfFindsNothing) {
  const json document = json::parse(comparison_json(sample("a"), sample("b")));
  EXPECT_TRUE(document["changes"].empty());
  for (const json& p : document["parameters"]) {
    if (!p["En"].is_null()) {
      EXPECT_EQ(p["En"], 0.0);
    }
  }
  EXPECT_THAT(comparison_text(sample("a"), sample("b")), HasSubstr("verdicts are the same."));
}

TEST(Comparison, CountsInUnitsOfTheCombinedUncertainty) {
  NamedReport later = sample("b");
  FittedParameter& squareness = later.analysis.result.final->parameters[0];
  // U_A = 3e-9, U_B = 4e-9: U = 5e-9 (Pythagoras); B - A = 1e-8: E_n = 2.
  NamedReport first = sample("a");
  first.analysis.result.final->parameters[0].expanded_uncertainty = 3e-9;
  squareness.expanded_uncertainty = 4e-9;
  squareness.value = *squareness.value + 1e-8;
  const json p = json::parse(comparison_json(first, later))["parameters"][0];
  EXPECT_NEAR(p["expanded_uncertainty"], 5e-9, 1e-15);
  EXPECT_NEAR(p["En"], 2.0, 1e-6);
  EXPECT_THAT(comparison_text(first, later),
              HasSubstr("Changed by more than U: squareness.dbeta_xz."));
}

TEST(Comparison, NamesWhatChanged) {
  NamedReport later = sample("b");
  Result& result = later.analysis.result;
  result.inputs[0].sha256 = std::string(64, 'b');
  result.low_band[0].wavelet = "db4";
  result.crosscheck.squareness->verdict = Consistency::inconsistent;
  result.inputs.pop_back();
  result.final->parameters.pop_back();
  const json document = json::parse(comparison_json(sample("a"), later));
  std::vector<std::string> what;
  for (const json& change : document["changes"]) what.push_back(change["what"]);
  EXPECT_THAT(what, testing::IsSupersetOf(
                        {"input feed2, sha256", "low band of feed2", "cross-check of squareness"}));
  EXPECT_EQ(document["parameters"].size(), 3U);
  EXPECT_TRUE(document["parameters"][2]["b"].is_null());
  for (const bool swapped : {false, true}) {
    const NamedReport first = sample("a");
    std::istringstream text(swapped ? comparison_text(later, first)
                                    : comparison_text(first, later));
    for (std::string line; std::getline(text, line);) EXPECT_LE(columns_of(line), 80U) << line;
  }
}

TEST(Comparison, RefusesOneParameterInTwoUnits) {
  NamedReport later = sample("b");
  later.analysis.result.final->parameters[0].unit = "um";
  EXPECT_THROW(comparison_text(sample("a"), later), DataError);
}

}  // namespace
}  // namespace slideway::comparison_test
