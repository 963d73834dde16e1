// Profiles left out in turn: what the others predict of them.
#include <gtest/gtest.h>

#include <optional>

#include "search_round.hpp"
#include "trace/faces.hpp"

namespace slideway {
namespace {

using namespace faces;  // NOLINT(google-build-using-namespace)

/// Prediction errors of every candidate without and with it.
std::vector<double> prediction_errors(const Problem& problem,
                                      const std::vector<Profile>& profiles) {
  const Model model = build_model(problem, profiles);
  const Solution fitted = fit(model);
  const Dictionary dictionary = make_dictionary(model, problem, 0);
  Candidates all;
  for (const Candidate& each : dictionary.candidates) all.push_back(&each);
  std::optional<Calibration> calibration;
  const SearchRound round = search_round(model, fitted, all, calibration, [](double) {});
  std::vector<double> out;
  for (const TestedCandidate& each : round.tested)
    if (each.held_out)
      out.insert(out.end(),
                 {each.held_out->before_um.value_or(0.0), each.held_out->after_um.value_or(0.0)});
  return out;
}

// The levelling takes the column of a squareness. What rounding leaves of it is no direction that
// the other cuts know: positions that differ in their last digits give the same prediction, to the
// rounding of some hundred values.
TEST(LeaveOneOut, KnowsNothingFromTheRoundingOfWhatLevellingTakes) {
  const Problem problem = problem_of({"straightness", "local_form", "thermal_drift", "step"});
  const turning::Hidden bump{"bump", [](const turning::ToolPoint& tool) {
                               return 0.1e-3 * std::exp(-std::pow((tool.r - 4.0) / 0.7, 2));
                             }};
  std::vector<Profile> cuts = quarter_faces(bump, 2, kBlunt, 1);
  for (Profile& cut : cuts) cut.free_offset = cut.free_tilt = true;
  const std::vector<double> expected = prediction_errors(problem, cuts);
  ASSERT_FALSE(expected.empty());
  for (Profile& cut : cuts)
    for (double& position : cut.positions) position = position / 25.4 * 25.4;
  const std::vector<double> found = prediction_errors(problem, cuts);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    EXPECT_NEAR(found[i], expected[i], 1e-6 * expected[i]) << i;
}

}  // namespace
}  // namespace slideway
