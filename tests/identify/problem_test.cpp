#include <cstdlib>

#include "identify/problem_file.hpp"
#include "slideway/effects/catalogue.hpp"

namespace slideway {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

// The example of the interface document: every key of it, with values that differ from the
// defaults.
constexpr const char* kEverything = R"(
title = "Face turned at two feeds"
[machine]
lever = "split"
overhang_mm = 40.0
spindle_position_mm = 5.0
[[machine.body]]
name = "x_carriage"
lower = 0
axis = "x"
[[machine.body]]
name = "z_carriage"
lower = 1
axis = "z"
[low_band]
wavelet = "db4"
level = 3
boundary = "periodic"
[[profile]]
name = "feed2"
file = "feed2.csv"
kind = "face"
quantity = "height"
position_column = "x_mm"
value_column = 3
position_unit = "mm"
value_unit = "µm"
window = [0.0, 10.0]
center_mm = 1.0
z_mm = 2.0
overhang_mm = 50.0
feed_mm_per_min = 2
spindle_rpm = 110.0
cut_direction = "inward"
cut_radius_mm = 10.0
start_s = 3.0
traverse_mm_per_s = 0.5
free = ["offset"]
standard_uncertainty = 0.01
role = "holdout"
[[profile]]
name = "level"
file = "level.csv"
kind = "slide"
quantity = "slope"
position_unit = "m"
value_unit = "arcsec"
base_mm = 100.0
standard_uncertainty = 0.5
[[effect]]
name = "squareness"
[[effect]]
name = "straightness"
body = "x_carriage"
degree = 5
priors = [{ parameter = "b2", value = 0.0, standard_uncertainty = 1e-8 }]
[runout]
r_um = 0.3
p_um = 2.5
diameter_mm = 1000.0
standard_uncertainty_um = 0.1
[trace]
candidates = ["all"]
max_effects = 2
significance = 0.05
[truth]
seed = 7
noise_um = 0.01
noise_correlation_mm = 0.1
samples = 500
parameters = { "squareness.dbeta_xz" = 2.8e-6, "straightness.b2" = 2.29e-8 }
[[truth.effect]]
name = "thermal_drift"
amplitude_um = 0.4
time_constant_s = 120.0
)";

TEST_F(ProblemFile, GivesEveryKeyOfAProfile) {
  const Problem problem = read(kEverything);
  ASSERT_EQ(problem.profiles.size(), 2u);
  const ProfileEntry& entry = problem.profiles[0];
  const slideway::Setup& setup = entry.profile.setup;
  EXPECT_EQ(entry.profile.name, "feed2");
  EXPECT_EQ(entry.profile.file, "feed2.csv");
  EXPECT_EQ(entry.source.path, folder_.path() / "feed2.csv");
  EXPECT_EQ(entry.source.request.position_column, "x_mm");
  EXPECT_EQ(entry.source.request.value_column, "3");
  EXPECT_EQ(entry.source.window, std::pair(0.0, 10.0));
  EXPECT_EQ(entry.source.value_unit, "um");
  EXPECT_EQ(setup.center_mm, 1.0);
  EXPECT_EQ(setup.z_mm, 2.0);
  EXPECT_EQ(setup.overhang_mm, 50.0);
  EXPECT_EQ(setup.spindle_position_mm, 5.0);
  EXPECT_EQ(setup.feed_mm_per_min, 2.0);
  EXPECT_EQ(setup.spindle_rpm, 110.0);
  EXPECT_EQ(setup.cut_direction, CutDirection::inward);
  EXPECT_EQ(setup.cut_radius_mm, 10.0);
  EXPECT_EQ(setup.start_s, 3.0);
  EXPECT_EQ(setup.traverse_mm_per_s, 0.5);
  EXPECT_TRUE(entry.profile.free_offset);
  EXPECT_FALSE(entry.profile.free_tilt);
  EXPECT_EQ(entry.profile.standard_uncertainty, 1e-5);  // mm
  EXPECT_EQ(entry.profile.role, Role::holdout);
}

TEST_F(ProblemFile, TakesASlopeReadingInItsOwnUnits) {
  const Problem problem = read(kEverything);
  const ProfileEntry& entry = problem.profiles[1];
  EXPECT_EQ(entry.profile.setup.kind, Kind::slide);
  EXPECT_EQ(entry.profile.setup.quantity, Quantity::slope);
  EXPECT_EQ(entry.profile.setup.base_mm, 100.0);
  EXPECT_EQ(entry.profile.setup.overhang_mm, 40.0);
  EXPECT_EQ(entry.source.position_unit, "m");
  // One arc second is pi / 648000 rad; two roundings are allowed for.
  EXPECT_NEAR(*entry.profile.standard_uncertainty, 0.5 * 3.14159265358979323846 / 648000.0, 1e-21);
}

TEST_F(ProblemFile, GivesMachineModelRunoutTraceAndTruth) {
  const Problem problem = read(kEverything);
  EXPECT_EQ(problem.title, "Face turned at two feeds");
  EXPECT_EQ(problem.lever, Lever::split);
  ASSERT_EQ(problem.bodies.size(), 2u);
  EXPECT_EQ(problem.bodies[1].lower, 1);
  EXPECT_EQ(problem.bodies[1].axis, Axis::z);
  EXPECT_EQ(problem.low_band.wavelet, "db4");
  EXPECT_EQ(problem.low_band.level, 3);
  EXPECT_EQ(problem.low_band.boundary, Boundary::periodic);
  ASSERT_EQ(problem.effects.size(), 2u);
  EXPECT_EQ(problem.effects[1].options.degree, 5);
  ASSERT_EQ(problem.effects[1].priors.size(), 1u);
  EXPECT_EQ(problem.effects[1].priors[0].standard_uncertainty, 1e-8);
  ASSERT_TRUE(problem.runout);
  EXPECT_EQ(problem.runout->diameter_mm, 1000.0);
  EXPECT_EQ(problem.trace.candidates.size(), effect_names().size());
  EXPECT_EQ(problem.trace.max_effects, 2);
  ASSERT_TRUE(problem.truth);
  EXPECT_EQ(problem.truth->seed, 7u);
  EXPECT_EQ(problem.truth->samples, 500u);
  EXPECT_EQ(problem.truth->parameters.at("straightness.b2"), 2.29e-8);
  ASSERT_EQ(problem.truth->effects.size(), 1u);
  EXPECT_EQ(problem.truth->effects[0].parameters.at("time_constant_s"), 120.0);
}

TEST_F(ProblemFile, HasTheDefaultsOfTheInterface) {
  const Problem problem = read(kMachine + profile() + kEffect);
  const ProfileEntry& entry = problem.profiles[0];
  EXPECT_EQ(problem.low_band.wavelet, "db1");
  EXPECT_EQ(problem.low_band.level, 5);
  EXPECT_EQ(problem.low_band.boundary, Boundary::symmetric);
  ASSERT_EQ(problem.bodies.size(), 2u);
  EXPECT_EQ(problem.bodies[0].name, "x_carriage");
  EXPECT_EQ(entry.profile.setup.kind, Kind::face);
  EXPECT_EQ(entry.profile.setup.quantity, Quantity::height);
  EXPECT_EQ(entry.source.request.position_column, "1");
  EXPECT_EQ(entry.source.request.value_column, "2");
  EXPECT_TRUE(entry.profile.free_offset && entry.profile.free_tilt);
  EXPECT_EQ(entry.profile.role, Role::fit);
  EXPECT_FALSE(entry.profile.standard_uncertainty || problem.runout || problem.truth);
}

TEST_F(ProblemFile, TakesBothMicroSigns) {
  for (const char* unit : {"\u00b5m", "\u03bcm"}) {
    const Problem problem = read(std::string(kMachine) +
                                 "[[profile]]\nname = \"a\"\nfile = \"a.csv\"\nposition_unit = "
                                 "\"mm\"\nvalue_unit = \"" +
                                 unit + "\"\n" + kEffect);
    EXPECT_EQ(problem.profiles[0].source.value_unit, "um");
  }
}

TEST_F(ProblemFile, TakesTheDataDirectoryFromItsCallerAndNotFromTheEnvironment) {
  const std::string text = std::string(kMachine) +
                           "[[profile]]\nname = \"a\"\nfile = \"${SLIDEWAY_DATA}/a.csv\"\n"
                           "position_unit = \"mm\"\nvalue_unit = \"um\"\n" +
                           kEffect;
  const char* before = std::getenv("SLIDEWAY_DATA");
  const std::string kept = before != nullptr ? before : "";
  setenv("SLIDEWAY_DATA", "/environment", 1);
  EXPECT_THAT(refusal(text), AllOf(HasSubstr("SLIDEWAY_DATA"), HasSubstr("--data DIR")));
  EXPECT_EQ(read_problem(folder_.path() / "problem.toml", "/option").profiles[0].source.path,
            "/option/a.csv");
  unsetenv("SLIDEWAY_DATA");
  if (before != nullptr) setenv("SLIDEWAY_DATA", kept.c_str(), 1);
}

TEST_F(ProblemFile, SaysHowTheTextIsWritten) {
  const Problem problem =
      read(kMachine +
           profile("delimiter = \";\"\ndecimal = \",\"\nencoding = \"latin-1\"\nheader_lines = 3\n"
                   "line = \"row:12\"") +
           kEffect);
  const TraceRequest& request = problem.profiles[0].source.request;
  EXPECT_EQ(request.delimiter, ";");
  EXPECT_EQ(request.decimal, ",");
  EXPECT_EQ(request.encoding, "latin-1");
  EXPECT_EQ(request.header_lines, 3);
  EXPECT_EQ(request.line, "row:12");
}

TEST_F(ProblemFile, TellsWhichPartOfAllItsFilesHasBeenRead) {
  write("x,z\n0,1\n1,2\n2,3\n3,4\n", "feed2.csv");  // read twice, by profiles of two names
  const Problem problem = read(kMachine + profile() + profile("", "again") + kEffect);
  std::vector<double> told;
  const std::vector<Profile> profiles =
      read_profiles(problem, [&](double done) { told.push_back(done); });
  EXPECT_THAT(profiles, ::testing::SizeIs(2));
  EXPECT_THAT(told, ::testing::ElementsAre(0.5, 1.0));
}

TEST_F(ProblemFile, NamesTheProfileWhoseDataAreBad) {
  const Problem problem = read(kMachine + profile() + kEffect);
  try {
    read_profiles(problem);
    FAIL() << "a missing file was read";
  } catch (const DataError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("profile 'feed2': "), HasSubstr("feed2.csv")));
  }
}

TEST_F(ProblemFile, OfASimulationDiffersInTruthAndProfilesOnly) {
  const Problem problem = read(kEverything);
  const std::string text = simulated_problem_text(problem, {"feed2.csv", "level.csv"});
  EXPECT_EQ(text, simulated_problem_text(problem, {"feed2.csv", "level.csv"}));
  EXPECT_THAT(text, Not(HasSubstr("truth")));
  const Problem again = read_problem(write(text, "again.toml"));
  EXPECT_FALSE(again.truth);
  EXPECT_EQ(again.title, problem.title);
  EXPECT_EQ(again.runout->p_um, 2.5);
  EXPECT_EQ(again.effects[1].priors[0].standard_uncertainty, 1e-8);
  const ProfileEntry& face = again.profiles[0];
  EXPECT_EQ(face.source.request.position_column, "x_mm");
  EXPECT_EQ(face.source.request.value_column, "z_um");
  EXPECT_FALSE(face.source.window);
  EXPECT_EQ(face.profile.standard_uncertainty, 1e-5);
  EXPECT_EQ(face.profile.setup.feed_mm_per_min, 2.0);
  const ProfileEntry& level = again.profiles[1];
  EXPECT_EQ(level.source.request.value_column, "slope_urad");
  EXPECT_EQ(level.source.value_unit, "urad");
  EXPECT_EQ(level.profile.setup.base_mm, 100.0);
  // Two conversions between arcsec, rad and urad: a few roundings.
  EXPECT_NEAR(*level.profile.standard_uncertainty,
              *problem.profiles[1].profile.standard_uncertainty, 1e-20);
}

}  // namespace
}  // namespace slideway
