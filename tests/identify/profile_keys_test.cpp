#include "identify/cases.hpp"
#include "identify/problem_file.hpp"
#include "slideway/identify/model.hpp"
#include "slideway/identify/override.hpp"

namespace slideway {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::Not;
using ::testing::ThrowsMessage;

std::vector<std::string> keys_of(const std::vector<Assumption>& assumed) {
  std::vector<std::string> keys;
  for (const Assumption& each : assumed) keys.push_back(each.key);
  return keys;
}

TEST_F(ProblemFile, GivesAProfileALowBandOfItsOwn) {
  const Problem problem =
      read(kMachine + ("[low_band]\nwavelet = \"db4\"\nlevel = 3\n" + profile()) +
           profile("level = 0\nboundary = \"periodic\"\n", "readings") + kEffect);
  EXPECT_FALSE(problem.profiles[0].profile.low_band);
  EXPECT_EQ(problem.low_band_of(problem.profiles[0].profile).level, 3);
  const LowBandOptions& own = problem.low_band_of(problem.profiles[1].profile);
  EXPECT_EQ(own.level, 0);
  EXPECT_EQ(own.wavelet, "db4");  // what it does not say is that of [low_band]
  EXPECT_EQ(own.boundary, Boundary::periodic);
}

TEST_F(ProblemFile, KnowsWhenStationsWereReadAndWhichWayRound) {
  const ProfileEntry entry =
      read(kMachine +
           profile("kind = \"slide\"\ntime_column = \"t_min\"\ntime_unit = \"min\"\n"
                   "reversed = true\n") +
           kEffect)
          .profiles[0];
  EXPECT_EQ(entry.source.request.time_column, "t_min");
  EXPECT_EQ(entry.source.time_unit, "min");
  EXPECT_TRUE(entry.profile.setup.reversed);
  EXPECT_FALSE(read(kMachine + profile() + kEffect).profiles[0].profile.setup.reversed);
  EXPECT_THAT(profile_refusal("time_column = 3"),
              HasSubstr(": profile.time_unit: missing; accepted: s min h"));
  EXPECT_THAT(profile_refusal("time_column = 3\ntime_unit = \"ms\""),
              HasSubstr(":10: profile.time_unit: \"ms\""));
  EXPECT_THAT(profile_refusal("time_unit = \"s\""),
              HasSubstr(": profile.time_column: missing; accepted: a column"));
  EXPECT_THAT(profile_refusal("kind = \"slide\"\nreversed = 1"),
              HasSubstr(":10: profile.reversed: must be true or false"));
  EXPECT_THAT(profile_refusal("reversed = true"),
              HasSubstr(":9: profile.reversed: belongs to kind = \"slide\" only"));
}

// Two instruments drift each in its own way; what is read by one has one drift.
TEST_F(ProblemFile, GivesEachInstrumentItsOwnZero) {
  const auto with = [&](const std::string& scope) {
    std::vector<std::string> names;
    const std::string level = "kind = \"slide\"\ninstrument = \"level\"\n";
    for (const DeclaredEffect& each :
         read(kMachine + profile(level) + profile(level, "b") + profile("kind = \"slide\"\n", "c") +
              "[[effect]]\nname = \"zero_drift\"\n" + scope)
             .effects)
      names.push_back(term_name(each.name, each.options.profiles));
    return names;
  };
  EXPECT_THAT(with(""), ElementsAre("zero_drift[feed2,b]", "zero_drift[c]"));
  EXPECT_THAT(with("profiles = [\"feed2\", \"b\"]"), ElementsAre("zero_drift[feed2,b]"));
  EXPECT_THAT(with("scope = \"all\""), ElementsAre("zero_drift"));
  EXPECT_THAT(with("scope = \"profile\""),
              ElementsAre("zero_drift[feed2]", "zero_drift[b]", "zero_drift[c]"));
}

TEST_F(ProblemFile, PutsALevelIntoAProfileByItsKey) {
  const Problem problem = read_problem(write(kMachine + profile() + kEffect), {},
                                       std::vector<Override>{{"profile.feed2.level", "2"}});
  EXPECT_EQ(problem.low_band_of(problem.profiles[0].profile).level, 2);
  EXPECT_THAT(
      [&] {
        read_problem(write(kMachine + profile() + kEffect), {},
                     std::vector<Override>{{"profile.feed2.level", "31"}});
      },
      ThrowsMessage<UsageError>(HasSubstr("profile.level: must be a whole number from 0 to 30")));
}

TEST_F(ProblemFile, RefusesALowBandOfAProfileThatIsNone) {
  EXPECT_THAT(profile_refusal("level = -1"), HasSubstr(":9: profile.level: must be a whole"));
  EXPECT_THAT(profile_refusal("wavelet = \"haar\""), HasSubstr(":9: profile.wavelet: \"haar\""));
  EXPECT_THAT(profile_refusal("boundary = \"symetric\""), HasSubstr("did you mean 'symmetric'?"));
}

// 2^level samples make one value; level 0 keeps them all.
TEST(ProfileLowBand, IsThatOfEachObservation) {
  std::vector<Profile> profiles{
      cases::face("face", 2.0, cases::spaced(0.0, 10.0, 640), std::vector<double>(640, 1e-3)),
      cases::face("readings", 2.0, cases::spaced(0.0, 10.0, 61), std::vector<double>(61, 1e-3))};
  profiles[1].low_band = LowBandOptions{.level = 0};
  const Problem problem = cases::problem(Lever::paper, 5, {cases::effect("squareness")});
  const Model model = build_model(problem, profiles);
  EXPECT_EQ(model.observations[0].values.size(), 20);
  ASSERT_EQ(model.observations[1].values.size(), 61);
  EXPECT_EQ(model.observations[1].values[30], 1e-3);
  const Model coarser = build_model(problem, profiles, 16);
  EXPECT_EQ(coarser.observations[0].values.size(), 10);
  EXPECT_EQ(coarser.observations[1].low_band.options().level, 2);  // 61 >> 2 = 15
}

TEST_F(ProblemFile, TakesTheNoseOfTheToolOfAFace) {
  EXPECT_EQ(read(kMachine + profile("nose_radius_mm = 0.8") + kEffect)
                .profiles[0]
                .profile.setup.nose_radius_mm,
            0.8);
  EXPECT_FALSE(
      read(kMachine + profile() + kEffect).profiles[0].profile.setup.nose_radius_mm.has_value());
  EXPECT_THAT(profile_refusal("nose_radius_mm = 0"),
              HasSubstr(":9: profile.nose_radius_mm: must be greater than 0, not 0"));
  EXPECT_THAT(profile_refusal("kind = \"slide\"\nnose_radius_mm = 1"),
              HasSubstr(":10: profile.nose_radius_mm: belongs to kind = \"face\" only"));
}

TEST_F(ProblemFile, TakesWhereATraceLiesAndWhatMeasuredIt) {
  const Problem problem =
      read(kMachine +
           profile("azimuth_deg = 60.0\nsurface = \"disc 3\"\ninstrument = \"PGI\"\n"
                   "mask = [[1.0, 2.0], [4, 5]]") +
           profile("", "plain") + kEffect);
  const ProfileEntry& own = problem.profiles[0];
  EXPECT_EQ(own.profile.setup.azimuth_deg, 60.0);
  EXPECT_EQ(own.profile.surface, "disc 3");
  EXPECT_EQ(own.profile.instrument, "PGI");
  EXPECT_THAT(own.source.mask, ElementsAre(std::pair{1.0, 2.0}, std::pair{4.0, 5.0}));
  const ProfileEntry& plain = problem.profiles[1];
  EXPECT_EQ(plain.profile.setup.azimuth_deg, 0.0);
  EXPECT_FALSE(plain.profile.surface);
  EXPECT_FALSE(plain.profile.instrument);
  EXPECT_TRUE(plain.source.mask.empty());
  EXPECT_THAT(keys_of(problem.assumed), Contains("profile.plain.azimuth_deg"));
}

TEST_F(ProblemFile, RefusesAPlaceOfATraceThatIsNone) {
  EXPECT_THAT(profile_refusal("azimuth_deg = 361"),
              HasSubstr(":9: profile.azimuth_deg: 361 is out of range"));
  EXPECT_THAT(profile_refusal("kind = \"slide\"\nazimuth_deg = 10"),
              HasSubstr(":10: profile.azimuth_deg: belongs to kind = \"face\" only"));
  for (const char* mask : {"mask = [1.0, 2.0]", "mask = [[2.0, 1.0]]", "mask = 3"})
    EXPECT_THAT(profile_refusal(mask), HasSubstr(":9: profile.mask: must be a list of ranges"));
}

TEST_F(ProblemFile, ConfinesAnEffectToProfiles) {
  const std::string profiles = profile() + profile("", "feed8") + profile("", "feed20");
  const Problem problem =
      read(kMachine + profiles + kEffect +
           "[[effect]]\nname = \"step\"\nprofiles = [\"feed8\"]\n"
           "[[effect]]\nname = \"cup\"\nscope = \"profile\"\nprofiles = [\"feed2\", "
           "\"feed8\"]\n"
           "[truth]\nparameters = { \"step[feed8].height_um\" = 0.5 }\n"
           "[[truth.effect]]\nname = \"edge_roll_off\"\nscope = \"profile\"\n"
           "amplitude_um = 1\nwidth_mm = 0.2\n");
  std::vector<std::string> names;
  for (const DeclaredEffect& effect : problem.effects)
    names.push_back(term_name(effect.name, effect.options.profiles));
  EXPECT_THAT(names, IsSupersetOf({"step[feed8]", "cup[feed2]", "cup[feed8]"}));
  EXPECT_THAT(names, Not(Contains("cup[feed20]")));
  ASSERT_TRUE(problem.truth);
  EXPECT_EQ(problem.truth->effects.size(), 3U);
  EXPECT_THAT(problem.truth->effects[2].options.profiles, ElementsAre("feed20"));
}

// It stays in the model, where the report says that it is not determined.
TEST_F(ProblemFile, KeepsAnEffectOfEachProfileThatNoneOfThemCanShow) {
  const std::string chord = "name = \"chord\"\nscope = \"profile\"\n";
  const Problem problem =
      read(kMachine + profile("kind = \"slide\"\n") + "[[effect]]\n" + chord +
           "[truth]\n[[truth.effect]]\n" + chord + "height_um = 0.02\ndistance_mm = 1\n");
  ASSERT_EQ(problem.effects.size(), 1U);
  EXPECT_EQ(problem.effects[0].name, "chord");
  ASSERT_TRUE(problem.truth);
  EXPECT_EQ(problem.truth->effects.size(), 1U);
}

// The search takes what acts in all profiles apart; what acts in some of them is looked for whole,
// too: of two cuts that have it, either one alone explains little.
TEST_F(ProblemFile, LooksForACandidateOfEachProfileInAllOfThemFirst) {
  const std::string profiles = profile() + profile("", "feed8") + profile("", "feed20");
  const auto looked_for = [&](const std::string& keys) {
    std::vector<std::string> names;
    for (const DeclaredEffect& own :
         read(kMachine + profiles + kEffect +
              "[[trace.candidate]]\nname = \"cup\"\nscope = \"profile\"\n" + keys)
             .trace.own)
      names.push_back(term_name(own.name, own.options.profiles));
    return names;
  };
  EXPECT_THAT(looked_for(""), ElementsAre("cup"));
  EXPECT_THAT(looked_for("profiles = [\"feed2\", \"feed8\"]\n"),
              ElementsAre("cup[feed2,feed8]", "cup[feed2]", "cup[feed8]"));
}

TEST_F(ProblemFile, RefusesProfilesThatAreNone) {
  const auto refused = [&](const std::string& keys) {
    return refusal(kMachine + profile() + kEffect + "[[effect]]\nname = \"cup\"\n" + keys);
  };
  EXPECT_THAT(refused("profiles = [\"feed3\"]\n"), HasSubstr("did you mean 'feed2'?"));
  EXPECT_THAT(refused("profiles = []\n"), HasSubstr("profiles: is empty; accepted: feed2"));
  EXPECT_THAT(refused("scope = \"cut\"\n"), HasSubstr("accepted: all instrument profile"));
  EXPECT_THAT(refused("profiles = [\"feed2\"]\n[[effect]]\nname = \"cup\"\n"),
              HasSubstr("declared twice for the same body and profile"));
}

TEST_F(ProblemFile, TakesALoss) {
  const auto loss = [&](const char* line) {
    return read(kMachine + profile(line) + kEffect).profiles[0].profile.loss;
  };
  EXPECT_EQ(loss(""), Loss::none);
  EXPECT_EQ(loss("loss = \"none\""), Loss::none);
  EXPECT_EQ(loss("loss = \"huber\""), Loss::huber);
  EXPECT_EQ(loss("loss = \"cauchy\""), Loss::cauchy);
  EXPECT_THAT(profile_refusal("loss = \"hubr\""), HasSubstr("did you mean 'huber'?"));
}

TEST_F(ProblemFile, RefusesNumbersThatLeaveNoDigits) {
  for (const char* key : {"center_mm", "z_mm", "start_s"})
    for (const char* value : {" = 1e18", " = -1e300"})
      EXPECT_THAT(profile_refusal(std::string(key) + value), HasSubstr("from -1e+09 to 1e+09"))
          << key;
  for (const char* key :
       {"feed_mm_per_min", "spindle_rpm", "cut_radius_mm", "traverse_mm_per_s", "nose_radius_mm"})
    for (const char* value : {" = 1e18", " = 1e-300"})
      EXPECT_THAT(profile_refusal(std::string(key) + value), HasSubstr("from 1e-9 to 1e9")) << key;
  for (const char* value : {" = 1e18", " = 1e-300"})  // 1e-15 to 1e12 mm, in µm
    EXPECT_THAT(profile_refusal(std::string("standard_uncertainty") + value),
                HasSubstr("from 1e-12 to 1e+15 um"));
  EXPECT_THAT(
      refusal("[machine]\nlever = \"paper\"\nspindle_position_mm = 1e18\n" + profile() + kEffect),
      HasSubstr(":3: machine.spindle_position_mm: 1e+18 is out of range"));
}

TEST_F(ProblemFile, NamesTheLineOfAKeyThatDoesNotFitTheData) {
  folder_.file("feed2.csv", "0,1\n10,2\n");
  const auto path = write(kMachine + profile("center_mm = 1e9") + kEffect);
  EXPECT_THAT([&] { read_profiles(read_problem(path)); },
              ThrowsMessage<UsageError>(path.string() +
                                        ":8: profile.center_mm: 'feed2': the spindle axis lies "
                                        "1e+09 mm away from a trace of 10 mm; accepted: up to a "
                                        "million times its length"));
}

TEST_F(ProblemFile, ListsWhatItAssumes) {
  folder_.file("feed2.csv", "0,1\n10,2\n");
  const Problem problem =
      read(kMachine + profile("feed_mm_per_min = 2\ncut_direction = \"inward\"") + kEffect);
  EXPECT_THAT(keys_of(problem.assumed),
              ElementsAre("low_band.level", "profile.feed2.free", "profile.feed2.center_mm",
                          "profile.feed2.cut_radius_mm"));
  EXPECT_EQ(problem.assumed[0].value, "5");
  EXPECT_EQ(problem.assumed[0].why, "default");
  EXPECT_EQ(problem.assumed[1].value, R"(["offset", "tilt"])");
  EXPECT_EQ(problem.assumed[3].value, "");
  const std::vector<Assumption> told = assumptions(problem, read_profiles(problem));
  EXPECT_EQ(told[3].value, "10");
  EXPECT_EQ(told[3].why, "largest radius of the trace");
}

TEST_F(ProblemFile, AssumesNothingThatTheFileSaysOrThatCannotMatter) {
  const std::string given = "level = 4\nfree = []\ncenter_mm = 0\n";
  EXPECT_THAT(read(kMachine + profile(given) + kEffect).assumed, ElementsAre());
  EXPECT_THAT(keys_of(read(profile("kind = \"slide\"") + kEffect).assumed),
              ElementsAre("low_band.level", "profile.feed2.free"));
}

TEST_F(ProblemFile, AssumesAPlaceAlongZWhereAnEffectDependsOnIt) {
  const std::string vertical = "[[effect]]\nname = \"vertical_straightness\"\ndegree = 2\n";
  EXPECT_THAT(keys_of(read(kMachine + profile() + vertical).assumed),
              Contains("profile.feed2.z_mm"));
  EXPECT_THAT(keys_of(read(kMachine + profile() + kEffect).assumed),
              Not(Contains("profile.feed2.z_mm")));
}

TEST_F(ProblemFile, AssumesAnOverhangOfTheSplitLeverAndTheStartOfCutsThatFollowOneAnother) {
  const std::string cut = "feed_mm_per_min = 2\ncut_direction = \"inward\"\n";
  const Problem two =
      read("[machine]\nlever = \"split\"\n" + profile(cut) + profile(cut, "b") + kEffect);
  EXPECT_THAT(keys_of(two.assumed),
              IsSupersetOf({"profile.feed2.overhang_mm", "profile.b.overhang_mm",
                            "profile.feed2.start_s", "profile.b.start_s"}));
  const Problem given =
      read("[machine]\nlever = \"split\"\noverhang_mm = 5\n" + profile(cut) + kEffect);
  EXPECT_THAT(keys_of(given.assumed), Not(Contains("profile.feed2.overhang_mm")));
  EXPECT_THAT(keys_of(given.assumed), Not(Contains("profile.feed2.start_s")));
}

}  // namespace
}  // namespace slideway
