// Effects of a problem's own: how they are written down, refused, declared, shared and simulated.
#include <algorithm>
#include <cmath>

#include "identify/cases.hpp"
#include "problem_file.hpp"
#include "slideway/base/file.hpp"
#include "slideway/base/random.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/effects/formula.hpp"
#include "slideway/identify/identify.hpp"
#include "slideway/identify/simulate.hpp"

namespace slideway {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::string kParameters =
    R"(parameters = [{ name = "a", unit = "um" }, { name = "t0", unit = "s", lower = 0, upper = 300 },
  { name = "tau", unit = "s", lower = 1, upper = 600 }]
)";
const std::string kFormula =
    "name = \"formula\"\nas = \"coolant\"\n"
    "formula = \"a * (1 - exp(-max(t - t0, 0) / tau))\"\n" +
    kParameters;
const std::string kShared = "[[effect]]\n" + kFormula +
                            "cause = \"coolant switched on\"\nsource = \"shop\"\n"
                            "typical = \"0.2 to 1 um\"\n";

class OwnEffects : public ProblemFile {
 protected:
  [[nodiscard]] std::string with(const std::string& lines) const {
    return kMachine +
           profile("feed_mm_per_min = 2\ncut_direction = \"inward\"\ncut_radius_mm = 10\n") +
           kEffect + lines;
  }

  /// What a simulation says against a problem; empty: nothing.
  [[nodiscard]] std::string why(const std::string& text) const {
    const Problem problem = read_problem(write(text + "[truth]\nsamples = 100\n"));
    try {
      (void)simulate(problem);
    } catch (const UsageError& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(OwnEffects, AreDeclaredByTheNameTheyAreGiven) {
  const Problem problem =
      read(with("[[effect]]\n" + kFormula + "profiles = [\"feed2\"]\n" +
                R"(priors = [{ parameter = "tau", value = 90, standard_uncertainty = 5 }])"));
  ASSERT_EQ(problem.effects.size(), 2U);
  EXPECT_EQ(problem.effects[1].name, "coolant");
  EXPECT_THAT(problem.effects[1].options.profiles, ElementsAre("feed2"));
  EXPECT_EQ(problem.effects[1].priors.front().parameter, "tau");
  const auto effect = make_effect("coolant", problem.effects[1].options, problem.machine(), {});
  EXPECT_EQ(effect->description().name, "coolant");
}

TEST_F(OwnEffects, AreLookedForWhereTheyAreCandidates) {
  const Problem problem =
      read(with("[trace]\n[[trace.candidate]]\n" + kFormula +
                "[[trace.candidate]]\nname = \"step\"\nprofiles = [\"feed2\"]\n"));
  ASSERT_EQ(problem.trace.own.size(), 2U);
  EXPECT_EQ(problem.trace.own[0].name, "coolant");
  EXPECT_EQ(problem.trace.own[1].name, "step");
  // With options of its own it is looked for once, with these.
  EXPECT_EQ(std::ranges::count(problem.trace.candidates, "step"), 0);
  EXPECT_EQ(problem.trace.candidates.size(), effect_names().size() - 1);
}

TEST_F(OwnEffects, OfAFileAreCandidatesAndCanBeDeclaredByName) {
  write(kShared, "our-lathes.toml");
  const std::string shared = "effects = [\"our-lathes.toml\"]\n";
  EXPECT_EQ(read(shared + with("")).trace.own.front().name, "coolant");
  EXPECT_EQ(read(shared + with("[trace]\ncandidates = [\"step\"]\n")).trace.own.size(), 0U);
  EXPECT_EQ(read(shared + with("[trace]\ncandidates = [\"coolant\"]\n")).trace.own.size(), 1U);
  EXPECT_EQ(read(shared + with("[[effect]]\nname = \"coolant\"\n")).effects[1].name, "coolant");
}

TEST_F(OwnEffects, AreRefusedWithFileLineAndColumn) {
  // kMachine has 2 lines, the profile 9, the other effect 2: [[effect]] is line 14.
  const auto refused = [&](const std::string& from, const std::string& to) {
    std::string text = with("[[effect]]\n" + kFormula);
    text.replace(text.find(from), from.size(), to);
    return refusal(text);
  };
  EXPECT_THAT(
      refused("exp(-max", "expp(-max"),
      AllOf(HasSubstr(": effect.formula: column 10: 'expp'"), HasSubstr("accepted: r x X")));
  EXPECT_THAT(refused("as = \"coolant\"", "as = \"step\""),
              HasSubstr(": effect.as: 'step' is the name of another effect"));
  EXPECT_THAT(refused("as = \"coolant\"", "as = \"a b\""), HasSubstr("is no name"));
  EXPECT_THAT(refused("as = \"coolant\"\n", ""), HasSubstr("effect.as: missing"));
  EXPECT_THAT(refused("\"a\", unit = \"um\"", "\"a\", unit = \"K\""),
              HasSubstr("column 1: 'a' enters linearly"));
  EXPECT_THAT(refused("\"a\", unit = \"um\"", "\"a\""),
              HasSubstr("effect.parameters.unit: missing"));
  EXPECT_THAT(refused("lower = 1, upper = 600", "lower = 600, upper = 1"),
              HasSubstr("effect.parameters.upper: must be greater than lower"));
  EXPECT_THAT(refused("name = \"a\"", "name = \"scope\""), HasSubstr("is a key of an effect"));
  EXPECT_THAT(refused(kParameters, ""), HasSubstr("effect.parameters: missing"));
  EXPECT_THAT(refusal(with("[[effect]]\n" + kFormula + "degree = 3\n")),
              HasSubstr("'degree' is not an option"));
  EXPECT_THAT(refusal(with("[[effect]]\n" + kFormula + "[[trace.candidate]]\n" + kFormula)),
              HasSubstr("trace.candidate.as: 'coolant' is the name of another effect"));
}

TEST_F(OwnEffects, OfAFileNeedCauseSourceAndTypicalSize) {
  std::string bare = kShared;
  bare.erase(bare.find("typical"));
  const std::string path = write(bare, "our-lathes.toml").string();
  try {
    (void)read_effect_file(path);
    ADD_FAILURE();
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), AllOf(StartsWith(path + ":1: effect.typical: missing")));
  }
}

// Simulated and fitted: 0.4 µm, 60 s, 90 s beside a cone, without noise.
TEST_F(OwnEffects, AreSimulatedAndFitted) {
  const Problem problem = read_problem(write(with("[[effect]]\n" + kFormula) +
                                             "[truth]\nsamples = 4000\nparameters = { "
                                             "\"squareness.dbeta_xz\" = 2e-6, \"coolant.a\" = 0.4, "
                                             "\"coolant.t0\" = 60, \"coolant.tau\" = 90 }\n"));
  std::vector<Profile> profiles = simulate(problem);
  // By hand, at t = (10 - r) 30 s/mm.
  for (const std::size_t i : {0U, 1000U, 3999U}) {
    const double r = profiles[0].positions[i], t = (10.0 - r) * 30.0;
    EXPECT_NEAR(profiles[0].values[i],
                -2e-6 * r + 0.4e-3 * (1.0 - std::exp(-std::max(t - 60.0, 0.0) / 90.0)), 1e-16);
  }
  const Result result = identify(problem, profiles, Scope::fit);
  for (const FittedParameter& parameter : result.declared->parameters) {
    if (!parameter.name.starts_with("coolant.")) continue;
    const double truth = parameter.name == "coolant.a"    ? 0.4
                         : parameter.name == "coolant.t0" ? 60.0
                                                          : 90.0;
    ASSERT_TRUE(parameter.value) << parameter.name;
    EXPECT_NEAR(*parameter.value, truth, 1e-4 * truth) << parameter.name;  // no noise: solver alone
  }
}

TEST_F(OwnEffects, OfATruthAreWrittenWhereTheyAre) {
  const Problem problem = read_problem(write(
      with("") +
      "[truth]\nsamples = 300\n[[truth.effect]]\nname = \"formula\"\nas = \"bow\"\n"
      "formula = \"a * (r / R)^2\"\nparameters = [{ name = \"a\", unit = \"um\" }]\na = 2\n"));
  const std::vector<Profile> profiles = simulate(problem);
  EXPECT_NEAR(profiles[0].values.back(), 2e-3, 1e-18);
}

// A position in mm that a problem calls m is another log.
TEST_F(OwnEffects, TakeNoOtherUnitOfALogThanItsFileStates) {
  write("x_mm,q_K\n0,1\n5,2\n10,4\n", "log.csv");
  const auto read_in = [&](const std::string& unit) {
    return read_problem(
        write(with("[[channel]]\nname = \"sensor\"\nfile = \"log.csv\"\n"
                   "clock = \"x\"\ntime_column = \"x_mm\"\n"
                   "value_column = \"q_K\"\n" +
                   unit)));
  };
  EXPECT_EQ(read_in("time_unit = \"mm\"\n").own_effects.front().name, "sensor");
  EXPECT_EQ(read_in("").own_effects.front().name, "sensor");
  try {
    (void)read_in("time_unit = \"m\"\n");
    ADD_FAILURE();
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("channel.time_unit: the file has mm, the problem m; "
                                        "accepted: the same"));
  }
}

TEST_F(OwnEffects, NeedANameOfTheirOwn) {
  Problem problem = read_problem(write(with("")));
  const DeclaredEffect own{"coolant", {}, {}};
  look_for(own, problem);
  EXPECT_EQ(problem.trace.own.back().name, "coolant");
  for (const std::string name : {"coolant", "step", "formula", "all"})
    EXPECT_THROW(look_for({name, {}, {}}, problem), UsageError) << name;
}

TEST_F(OwnEffects, OfAFileGoWithASimulation) {
  write(kShared, "our-lathes.toml");
  const Problem problem = read_problem(write(
      "effects = [\"./our-lathes.toml\"]\n" + with("") +
      "[truth]\nsamples = 300\n[[truth.effect]]\nname = \"coolant\"\na = 1\nt0 = 0\ntau = 20\n"));
  const std::filesystem::path made = folder_.path() / "made";
  write_simulation(problem, made);
  EXPECT_EQ(read_problem(made / "problem.toml").own_effects.front().name, "coolant");
}

TEST_F(OwnEffects, ThatAreNotFiniteOnAProfileAreRefusedWithThePlace) {
  const std::string pole =
      "name = \"formula\"\nas = \"pole\"\nformula = \"a * 2 / (r - 3.3333)\"\n"
      "parameters = [{ name = \"a\", unit = \"um\" }]\n";
  const std::string expected =
      "profile 'feed2': effect 'pole': column 5 of its formula: '2 / (r - "
      "3.3333)' has a pole near 3.3";
  EXPECT_THAT(why(with("[[effect]]\n" + pole)), HasSubstr(expected));
  EXPECT_THAT(why(with("[[trace.candidate]]\n" + pole)), HasSubstr(expected));
}

// A shop's own effects may be for slopes where a problem has heights; one that names its profiles
// may not.
TEST_F(OwnEffects, AreRefusedInProfilesOfAnotherQuantity) {
  const std::string bend =
      "name = \"formula\"\nas = \"bend\"\nformula = \"a * tanh(r - 5)\"\n"
      "parameters = [{ name = \"a\", unit = \"urad\" }]\n";
  const std::string here = "profiles = [\"feed2\"]\n";
  const auto refused =
      HasSubstr("effect 'bend' is in no profile; accepted: a size in um for heights");
  EXPECT_EQ(why(with("[[trace.candidate]]\n" + bend)), "");
  EXPECT_THAT(why(with("[[trace.candidate]]\n" + bend + here)), refused);
  EXPECT_THAT(why(with("[[effect]]\n" + bend)), refused);
}

// Noise of 1 µm at 100 stations: U of a is 0.3 µm.
TEST(OwnEffectBounds, AreSaidToBeLeftWhereTheSizeIsBeyondThemByItsU) {
  const std::vector<double> x = cases::spaced(0.0, 400.0, 100);
  const auto notes_of = [&](double size_mm, std::optional<double> upper) {
    RandomStream random(1, "bounds");
    std::vector<double> z;
    for (const double at : x) z.push_back(size_mm * std::sin(at / 30.0) + 1e-3 * random.normal());
    DeclaredEffect own = cases::effect("own");
    own.options.own = formula_effect(
        {.name = "own", .text = "a * sin(x / 30)", .parameters = {{"a", "um", 0.0, upper}}});
    const std::vector<Profile> profiles{cases::profile("slide", Kind::slide, x, z)};
    const FittedModel found = fit_declared(cases::problem(Lever::paper, 0, {own}), profiles);
    return summarise(found.model, found.fit).notes;
  };
  const auto said = [](const char* what) { return ::testing::Contains(HasSubstr(what)); };
  EXPECT_THAT(notes_of(-5e-3, {}), said("below 0 µm: a size is not held inside its bounds"));
  EXPECT_THAT(notes_of(5e-3, 2.0), said("above 2 µm: a size is not held inside its bounds"));
  EXPECT_THAT(notes_of(0.0, {}), ::testing::Not(said("inside its bounds")));
  EXPECT_THAT(notes_of(5e-3, {}), ::testing::Not(said("inside its bounds")));
}

}  // namespace
}  // namespace slideway
