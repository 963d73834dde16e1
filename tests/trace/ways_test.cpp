// Ways that are no polynomial: no effect of the catalogue but a local form may be said of them
// without a rival, and the squareness must lie within its uncertainty.

#include <cmath>

#include "slideway/trace/analysis.hpp"
#include "trace/faces.hpp"

namespace slideway {
namespace {

using namespace faces;  // NOLINT(google-build-using-namespace)

struct Way {
  std::string name;
  double (*height)(double x);  // mm, over a travel of 10 mm
};

constexpr double kWayHeight = 0.3e-3;  // mm: thirty times the correlated noise

const Way kWays[] = {
    {"kink", [](double x) { return kWayHeight * std::max(x - 6.2, 0.0) / 3.8; }},
    {"joint", [](double x) { return x < 4.3 ? 0.0 : kWayHeight * (1.0 - 0.15 * (x - 4.3)); }},
    {"dip", [](double x) { return -kWayHeight * std::exp(-0.5 * std::pow((x - 5.7) / 0.6, 2)); }},
    {"worn", [](double x) { return -kWayHeight / (1.0 + std::pow((x - 3.5) / 1.5, 4)); }},
    {"wavy", [](double x) { return kWayHeight * 0.1 * x * std::sin(1.3 * x + 0.08 * x * x); }},
};

class Ways : public ::testing::TestWithParam<Way> {};

TEST_P(Ways, GetNoNameAloneAndASquarenessWithinItsUncertainty) {
  const turning::Hidden hidden{
      GetParam().name, [](const turning::ToolPoint& tool) { return GetParam().height(tool.x); }};
  const Closed result = closed(problem_of(), quarter_faces(hidden, 3, kBlunt, 5));
  SCOPED_TRACE(story(result));
  EXPECT_NE(result.verdict, TraceVerdict::nothing_missing);
  for (const TraceRound& round : result.rounds)
    if (round.accepted != "feed_marks" && round.accepted != "local_form") {
      EXPECT_THAT(round.ambiguous_with, ::testing::Not(::testing::IsEmpty())) << round.accepted;
    }
  expect_within_4u(result.final.parameters, "squareness.dbeta_xz", turning::kFaceSquareness);
}

INSTANTIATE_TEST_SUITE_P(, Ways, ::testing::ValuesIn(kWays),
                         [](const auto& way) { return way.param.name; });

}  // namespace
}  // namespace slideway
