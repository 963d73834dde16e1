#include "slideway/report/comparison.hpp"

#include <gmock/gmock.h>

#include <functional>
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

TEST(Comparison, NamesEachChangeOfInputsOptionsAndVerdicts) {
  const auto full = [](const std::string& name) {
    NamedReport out = sample(name);
    Result& result = out.analysis.result;
    out.analysis.details.setups = {{.profile = "feed2", .setup = {}}};
    out.analysis.details.options.emplace();
    out.analysis.trace.emplace().gates = {{"delta_bic", 10.0}};
    result.crosscheck.held_out = {{.profile = "cut3"}};
    result.crosscheck.profiles = {{.profiles = {"a", "c"}, .what = "squareness"}};
    result.conformity = {{.what = "straightness", .limit_um = 5.0}};
    return out;
  };
  using Changes = std::vector<std::pair<std::string, std::function<void(Analysis&)>>>;
  const Changes changes{
      {"input feed2, loss", [](Analysis& a) { a.result.inputs[0].loss = Loss::huber; }},
      {"setup of feed2, feed_mm_per_min",
       [](Analysis& a) { a.details.setups[0].setup.feed_mm_per_min = 2.0; }},
      {"setup of feed2, overhang_mm",
       [](Analysis& a) { a.details.setups[0].setup.overhang_mm = 3.0; }},
      {"options, max_effects", [](Analysis& a) { a.details.options->max_effects += 1; }},
      {"assumed profile.feed2.free", [](Analysis& a) { a.result.assumed.clear(); }},
      {"gate delta_bic", [](Analysis& a) { a.trace->gates[0].second = 6.0; }},
      {"tolerance of straightness", [](Analysis& a) { a.result.conformity[0].limit_um = 4.0; }},
      {"conformity of straightness",
       [](Analysis& a) { a.result.conformity[0].verdict = ConformityVerdict::does_not_conform; }},
      {"cut3, held out",
       [](Analysis& a) { a.result.crosscheck.held_out[0].verdict = HeldOutVerdict::does_not_fit; }},
      {"squareness of a and c",
       [](Analysis& a) { a.result.crosscheck.profiles[0].verdict = Consistency::inconsistent; }}};
  EXPECT_THAT(comparison_text(full("a"), full("b")), HasSubstr("verdicts are the same."));
  for (const auto& [what, change] : changes) {
    NamedReport later = full("b");
    change(later.analysis);
    const json found = json::parse(comparison_json(full("a"), later))["changes"];
    ASSERT_EQ(found.size(), 1U) << what;
    EXPECT_EQ(found[0]["what"], what);
  }
}

TEST(Comparison, RefusesOneParameterInTwoUnits) {
  NamedReport later = sample("b");
  later.analysis.result.final->parameters[0].unit = "um";
  EXPECT_THROW(comparison_text(sample("a"), later), DataError);
}

}  // namespace
}  // namespace slideway::comparison_test
