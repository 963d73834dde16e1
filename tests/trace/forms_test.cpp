// Where nothing of the catalogue explains what is left, short formulas describe it, and the best,
// pasted into the problem file, closes the loop.
#include <algorithm>
#include <fstream>

#include "base/temporary_folder.hpp"
#include "slideway/base/text.hpp"
#include "slideway/report/residual_table.hpp"
#include "trace/faces.hpp"

namespace slideway {
namespace {

using namespace faces;  // NOLINT(google-build-using-namespace)
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Field;

constexpr double kFormSize = 0.2e-3;  // mm: 20 times the noise
constexpr std::uint64_t kFormSeed = 11;

turning::Hidden open_shape(const std::string& name) {
  RandomStream random(kFormSeed, name);
  return turning::make_hidden(name, kFormSize, random);
}

std::string told_forms(const Unnamed& left) {
  std::string out = "\n  on " + left.clock;
  for (const UnnamedForm& form : left.forms) {
    out += "\n  " + form.form + " " + form.formula + " dBIC " + significant(form.delta_bic, 5);
    for (const FittedParameter& p : form.parameters)
      out += "\n    " + p.name + " = " + significant(*p.value, 5) + " +- " +
             significant(*p.standard_uncertainty, 3);
  }
  return out;
}

struct OpenShape {
  const char *name, *clock, *form;
};

class Forms : public ::testing::TestWithParam<OpenShape> {};

// The right variable, and the form that made it among the three that are told.
TEST_P(Forms, DescribeAShapeOfNoCatalogue) {
  const TraceResult result =
      close_loop(problem_of(), quarter_faces(open_shape(GetParam().name), 3, kBlunt, kFormSeed));
  ASSERT_EQ(result.verdict, TraceVerdict::unnamed) << story(result);
  SCOPED_TRACE(story(result) + told_forms(*result.unnamed));
  EXPECT_EQ(result.unnamed->clock, GetParam().clock);
  EXPECT_LE(result.unnamed->forms.size(), 3U);
  EXPECT_THAT(result.unnamed->forms, Contains(Field(&UnnamedForm::form, GetParam().form)));
  EXPECT_NE(result.unnamed->to_confirm, "");
  for (const UnnamedForm& form : result.unnamed->forms)
    EXPECT_LT(*form.after_rms_um, *form.before_rms_um) << form.form;
}

INSTANTIATE_TEST_SUITE_P(Process, Forms,
                         ::testing::Values(OpenShape{"stretched_exponential", "t",
                                                     "stretched exponential"},
                                           OpenShape{"chirp", "r", "chirp"},
                                           OpenShape{"double_bump", "r", "bump + bump"},
                                           OpenShape{"switched_drift", "t", "kink"}),
                         [](const auto& shape) { return std::string(shape.param.name); });

TEST(FormsOfNothing, AreNotProposed) {
  const TraceResult result = close_loop(problem_of(), quarter_faces({}, 3, kBlunt, 12));
  EXPECT_FALSE(result.unnamed) << story(result);
}

/// The curve of what is left follows the two bumps about 3.2 and 6.9 mm, and its band holds them:
/// between the places where they cross 0 no model of the carriage has taken their part.
TEST(FormsCurve, FollowsWhatIsLeft) {
  const Analysis analysis =
      analyse(problem_of(), quarter_faces(open_shape("double_bump"), 2, kBlunt, kFormSeed));
  ASSERT_TRUE(analysis.trace->unnamed);
  const UnnamedCurve& curve = analysis.trace->unnamed->curve;
  EXPECT_EQ(curve.variable, "x");
  ASSERT_GE(curve.at.size(), 100U);
  EXPECT_TRUE(std::ranges::is_sorted(curve.at));
  const auto top = std::ranges::max_element(curve.residual);
  EXPECT_NEAR(curve.at[static_cast<std::size_t>(top - curve.residual.begin())], 3.2, 0.35);
  for (const double u : curve.expanded_uncertainty) EXPECT_GT(u, 0.0);
  const std::string table = residual_table(analysis, "a test");
  EXPECT_EQ(std::ranges::count(table, '\n'), std::ssize(curve.at) + 3);
  EXPECT_THAT(table, ::testing::HasSubstr("\nx_mm,residual_um,expanded_uncertainty_um\n"));
}

/// A problem file with these faces beside it, and more text behind.
std::filesystem::path written(const std::filesystem::path& folder,
                              const std::vector<Profile>& faces, const std::string& more) {
  std::string text = "title = \"Faces\"\n[machine]\nlever = \"paper\"\n[low_band]\nlevel = " +
                     std::to_string(kQuarterLevel) + "\n";
  for (const Profile& face : faces) {
    std::ofstream data(folder / (face.name + ".csv"));
    data << "x_mm,z_um\n";
    for (std::size_t i = 0; i < face.positions.size(); ++i)
      data << shortest(face.positions[i]) << ',' << shortest(face.values[i] / kMicrometre) << '\n';
    const Setup& setup = face.setup;
    text += "[[profile]]\nname = \"" + face.name + "\"\nfile = \"" + face.name +
            ".csv\"\nkind = \"face\"\nquantity = \"height\"\nposition_column = \"x_mm\"\n"
            "value_column = \"z_um\"\nposition_unit = \"mm\"\nvalue_unit = \"um\"\n"
            "center_mm = " +
            shortest(setup.center_mm) + "\nfeed_mm_per_min = " + shortest(*setup.feed_mm_per_min) +
            "\nspindle_rpm = " + shortest(*setup.spindle_rpm) + "\ncut_direction = \"" +
            (*setup.cut_direction == CutDirection::inward ? "inward" : "outward") +
            "\"\ncut_radius_mm = " + shortest(*setup.cut_radius_mm) +
            "\ntraverse_mm_per_s = " + shortest(*setup.traverse_mm_per_s) + "\n";
  }
  text +=
      "[[effect]]\nname = \"squareness\"\n[[effect]]\nname = \"straightness\"\ndegree = 3\n"
      "[trace]\ncandidates = [\"all\"]\n";
  std::ofstream(folder / "problem.toml") << text << more;
  return folder / "problem.toml";
}

// The whole way of who meets a verdict without a name: run, paste the block, run again.
TEST(FormsPasted, CloseTheLoop) {
  const TemporaryFolder folder;
  const std::vector<Profile> faces = quarter_faces(open_shape("chirp"), 3, kBlunt, kFormSeed);
  const Problem first = read_problem(written(folder.path(), faces, ""));
  const TraceResult before = close_loop(first, read_profiles(first));
  ASSERT_EQ(before.verdict, TraceVerdict::unnamed) << story(before);
  ASSERT_FALSE(before.unnamed->forms.empty());
  SCOPED_TRACE(told_forms(*before.unnamed));
  const UnnamedForm& form = before.unnamed->forms.front();
  const Problem again = read_problem(written(folder.path(), faces, form.candidate));
  const TraceResult after = close_loop(again, read_profiles(again));
  SCOPED_TRACE(story(after));
  EXPECT_EQ(after.verdict, TraceVerdict::explained);
  EXPECT_THAT(named(after), ElementsAre("chirp_of_x"));
  const TraceRound* round = round_of(after, "chirp_of_x");
  ASSERT_NE(round, nullptr);
  EXPECT_LT(*round->after_rms_um, *round->before_rms_um);
  EXPECT_LT(*round->after_holdout_rms_um, *round->before_holdout_rms_um);
  // What was told of the form holds for the effect. Two fits of the same values under a noise that
  // was estimated anew differ by a part of their uncertainty.
  for (const FittedParameter& told : form.parameters) {
    const FittedParameter* fitted = find(round->parameters, told.name);
    ASSERT_NE(fitted, nullptr) << told.name;
    EXPECT_NEAR(*fitted->value, *told.value, *told.expanded_uncertainty) << told.name;
  }
  EXPECT_NEAR(*form.after_rms_um, *round->after_rms_um, 0.05 * *round->after_rms_um);
}

}  // namespace
}  // namespace slideway
