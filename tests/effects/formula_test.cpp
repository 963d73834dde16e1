// Effects that are written down as formulas. Expected columns are the closed forms, computed here.
#include "slideway/effects/formula.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <functional>

#include "effects/effect_cases.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/parallel.hpp"

namespace slideway::formula_test {
namespace {

using namespace testing_support;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

Formula coolant() {
  return {.name = "coolant",
          .text = "a * (1 - exp(-max(t - t0, 0) / tau))",
          .parameters = {{"t0", "s", 0.0, 300.0}, {"a", "um"}, {"tau", "s", 1.0, 600.0}}};
}

std::unique_ptr<Effect> effect_of(const Formula& formula) {
  return formula_effect(formula)(lathe(), kTravel);
}

std::unique_ptr<Effect> effect_of(const std::string& text,
                                  std::vector<FormulaParameter> parameters) {
  return effect_of({.name = "own", .text = text, .parameters = std::move(parameters)});
}

std::string refusal(const std::string& text, std::vector<FormulaParameter> parameters) {
  try {
    (void)effect_of(text, std::move(parameters));
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

std::string fault(const std::string& text, std::vector<FormulaParameter> parameters,
                  const Case& profile) {
  const auto effect = effect_of(text, std::move(parameters));
  return effect->fault({profile.positions, profile.setup, lathe()});
}

std::vector<std::string> names(const Effect& effect, std::size_t first, std::size_t count) {
  std::vector<std::string> out;
  for (std::size_t i = first; i < first + count; ++i) out.push_back(effect.parameters()[i].name);
  return out;
}

TEST(Formula, FindsWhichParametersEnterLinearly) {
  const auto effect = effect_of(coolant());
  EXPECT_EQ(effect->amplitudes(), 1);
  EXPECT_THAT(names(*effect, 0, 3), ElementsAre("a", "t0", "tau"));
  EXPECT_FALSE(effect->shapes()[0].logarithmic);  // from 0 on
  EXPECT_TRUE(effect->shapes()[1].logarithmic);
}

TEST(Formula, TakesSeveralAmplitudesIfTheyDoNotMultiplyOneAnother) {
  const auto sum =
      effect_of("a * x + b * sin(x / w)", {{"a", "um/mm"}, {"b", "um"}, {"w", "mm", 0.5, 40.0}});
  EXPECT_EQ(sum->amplitudes(), 2);
  // Either factor alone is linear, the product is not: the one without bounds is the size.
  const auto product = effect_of("g * q * x", {{"g", "1", 0.1, 2.0}, {"q", "um/mm"}});
  EXPECT_THAT(names(*product, 0, 2), ElementsAre("q", "g"));
  EXPECT_EQ(product->amplitudes(), 1);
}

TEST(Formula, ColumnsAreTheClosedForm) {
  const Case face = all_cases()[0];  // inward at 2 mm/min from 10 mm: t = (10 - r) 30 s/mm
  const Eigen::VectorXd z = signal(*effect_of(coolant()), face, Eigen::Vector3d(0.4, 60.0, 90.0));
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const double t = (10.0 - face.positions[static_cast<std::size_t>(i)]) * 30.0;
    const double expected = 0.4e-3 * (1.0 - std::exp(-std::max(t - 60.0, 0.0) / 90.0));
    EXPECT_NEAR(z[i], expected, 1e-17) << t;  // a few roundings of 0.4e-3
  }
}

// Each variable by itself, at r = 7.5 on the second half of a diameter: by hand from its
// definition.
TEST(Formula, HasEveryVariableInItsUnit) {
  Case profile = all_cases()[2];
  profile.positions = {-7.5};
  profile.setup.azimuth_deg = 30.0;
  const double kTime = 2.5 * 30.0, kTurns = kTime * 110.0 / 60.0;
  const double kDistance = kPi * (100.0 - 56.25) / (2.0 / 110.0) / 1000.0;
  const std::pair<const char*, double> cases[] = {{"r", 7.5},
                                                  {"x", 367.5},
                                                  {"X", -7.5},
                                                  {"z", 80.0},
                                                  {"theta", kPi * 7.0 / 6.0},
                                                  {"t", kTime},
                                                  {"m", 2.5 / 0.5},
                                                  {"t_read", 972.5},
                                                  {"k", kTurns},
                                                  {"s", kDistance},
                                                  {"R", 10.0},
                                                  {"feed", 2.0},
                                                  {"rpm", 110.0},
                                                  {"pi * r", kPi * 7.5}};
  for (const auto& [variable, value] : cases) {
    const auto effect = effect_of("a * " + std::string(variable), {{"a", "um"}});
    EXPECT_NEAR(columns(*effect, profile)(0, 0), value, 1e-14 * std::abs(value)) << variable;
  }
}

TEST(Formula, DerivativesAreThoseOfTheClosedFormToTenDigits) {
  const Case face = all_cases()[0];
  const Stations stations(face.positions, face.setup, lathe());
  const auto effect = effect_of("a * exp(-r / w) * cos(2 * pi * t / T)",
                                {{"a", "um"}, {"w", "mm", 0.1, 50.0}, {"T", "s", 1.0, 500.0}});
  for (const std::vector<double>& shape :
       {std::vector{3.0, 40.0}, std::vector{0.1, 500.0}, std::vector{50.0, 7.0}}) {
    const double w = shape[0], period = shape[1];
    Eigen::MatrixXd slopes(stations.size(), 2);
    effect->derivatives(stations, shape, slopes);
    for (int which = 0; which < 2; ++which) {
      Eigen::VectorXd expected(stations.size());
      for (Eigen::Index i = 0; i < stations.size(); ++i) {
        const double r = stations.radius(i), t = stations.time(i), phase = 2.0 * kPi * t / period;
        expected[i] = std::exp(-r / w) * (which == 0 ? r / (w * w) * std::cos(phase)
                                                     : phase / period * std::sin(phase));
      }
      // Central: eps^(6/7) and better. One-sided at an end of the bounds: three digits fewer.
      const bool at_end = shape[static_cast<std::size_t>(which)] == (which == 0 ? 0.1 : 500.0) ||
                          (which == 0 && w == 50.0);
      EXPECT_LT((slopes.col(which) - expected).cwiseAbs().maxCoeff(),
                (at_end ? 1e-6 : 1e-9) * expected.cwiseAbs().maxCoeff())
          << w << " " << period << " " << which;
    }
  }
}

TEST(Formula, IsOfSlopesWhereItsSizeIsAnAngle) {
  const auto effect = effect_of("a * x / 600", {{"a", "urad"}});
  const std::vector<Case> cases = all_cases();
  EXPECT_FALSE(effect->applies_to(cases[0].setup));
  ASSERT_TRUE(effect->applies_to(cases[4].setup));
  EXPECT_NEAR(signal(*effect, cases[4], Eigen::VectorXd::Constant(1, 3.0))[52], 3e-6, 1e-20);
}

TEST(Formula, NamesTheMetadataOfEveryVariableItUses) {
  const auto effect = effect_of("a * s * R / feed", {{"a", "um"}});
  slideway::Setup bare = all_cases()[0].setup;
  bare.feed_mm_per_min.reset();
  bare.spindle_rpm.reset();
  bare.cut_radius_mm.reset();
  EXPECT_THAT(effect->lacking(bare),
              ElementsAre("feed_mm_per_min", "spindle_rpm", "cut_radius_mm"));
  EXPECT_FALSE(effect->applies_to(all_cases()[3].setup));  // no radius along the slide
}

TEST(Formula, GivesTheSameInAnyNumberOfThreads) {
  const Case face = all_cases()[0];
  const auto effect = effect_of(coolant());
  const auto at = [&](std::size_t i) {
    return columns(*effect, face, std::vector{1.0 + static_cast<double>(i), 50.0});
  };
  std::vector<Eigen::MatrixXd> together(200);
  parallel_for(together.size(), [&](std::size_t i) { together[i] = at(i); });
  for (std::size_t i = 0; i < together.size(); ++i) EXPECT_EQ(together[i], at(i));
}

TEST(Formula, RefusesWhatIsNoFormulaWithItsColumn) {
  const std::vector<FormulaParameter> a{{"a", "um"}};
  EXPECT_THAT(refusal("a * foo(x)", a),
              AllOf(StartsWith("column 5: 'foo'"), HasSubstr("accepted")));
  EXPECT_THAT(refusal("a * (x + ", a), StartsWith("column "));
  EXPECT_THAT(refusal("a * 2x", a), StartsWith("column 6: 'x'"));
  EXPECT_THAT(refusal("a = 3", a), StartsWith("column 3: '=' assigns"));
  EXPECT_THAT(refusal("a * 1,5 * x", a), StartsWith("column 6: several results"));
  EXPECT_THAT(refusal("a * \xC2\xB5", a), StartsWith("column 5: a character"));
  EXPECT_THAT(refusal("a * rnd() * x", a), StartsWith("column 5: 'rnd'"));
  EXPECT_THAT(refusal("", a), StartsWith("column 1: "));
  EXPECT_THAT(refusal(std::string(3000, '('), a), StartsWith("column 2001: too long"));
}

TEST(Formula, RefusesParametersThatDoNotFit) {
  EXPECT_THAT(refusal("a * r", {{"a", "um"}, {"r", "mm"}}), HasSubstr("taken"));
  EXPECT_THAT(refusal("a * x * exp", {{"a", "um"}, {"exp", "1"}}), HasSubstr("taken"));
  EXPECT_THAT(refusal("a * x", {{"a", "um"}, {"a b", "1"}}), HasSubstr("is no name"));
  EXPECT_THAT(refusal("a * x", {{"a", "um"}, {"b", "um"}}), HasSubstr("'b' is not in the formula"));
  EXPECT_THAT(refusal("a", {{"a", "um"}}), HasSubstr("no variable"));
  EXPECT_THAT(refusal("a * exp(-t / tau)", {{"a", "um"}, {"tau", "s"}}),
              StartsWith("column 14: 'tau' does not enter linearly"));
  EXPECT_THAT(refusal("exp(a * x)", {{"a", "um", 0.0, 1.0}}), HasSubstr("no parameter enters"));
  EXPECT_THAT(refusal("a * x + 1", {{"a", "um"}}), HasSubstr("something is left"));
  EXPECT_THAT(refusal("a * x", {{"a", "s"}}),
              StartsWith("column 1: 'a' enters linearly, in \"s\""));
  EXPECT_THAT(refusal("a * x + b * r", {{"a", "um"}, {"b", "urad"}}),
              HasSubstr("'b' is in \"urad\""));
  EXPECT_THAT(refusal("a * (r > r0)", {{"a", "um"}, {"r0", "mm", 0.0, 10.0}}),
              StartsWith("column 10: 'r0' moves a jump"));
  EXPECT_THAT(refusal("a * x / 0", {{"a", "um"}}), HasSubstr("not finite"));
}

// Of t in s and r in mm.
TEST(Formula, RefusesUnitsThatDoNotFit) {
  EXPECT_THAT(refusal("a * t", {{"a", "um/min"}}),
              AllOf(StartsWith("column 1: 'a' is in \"um/min\""), HasSubstr("accepted: um/s,")));
  EXPECT_THAT(refusal("a * r * t", {{"a", "um/s"}}), HasSubstr("accepted: um/(mm s),"));
  EXPECT_THAT(refusal("a * t^2 / r", {{"a", "um/s^2"}}), HasSubstr("accepted: mm um/s^2,"));
  EXPECT_THAT(refusal("a * (1 - exp(-t / tau))", {{"a", "um"}, {"tau", "min", 0.1, 5.0}}),
              AllOf(StartsWith("column 19: 'tau' is in \"min\""), HasSubstr("accepted: s,")));
  EXPECT_THAT(refusal("a * t", {{"a", "um/"}}), HasSubstr("cannot be read"));
  EXPECT_THAT(refusal("a * cos(w * t)", {{"a", "um"}, {"w", "deg/s", 0.1, 9.0}}),
              AllOf(StartsWith("column 9: 'w' is in \"deg/s\""), HasSubstr("accepted: rad,")));
  // A number may carry a unit: here s.
  EXPECT_THAT(refusal("a * max(t - 30, 0)", {{"a", "um/min"}}), HasSubstr("accepted: um/s,"));
  EXPECT_THAT(
      refusal("a * (1 - exp(-max(t - 60, 0) / tau))", {{"a", "um"}, {"tau", "min", 0.1, 5.0}}),
      HasSubstr("'tau' is in \"min\""));
  EXPECT_THAT(refusal("a * sin(2 * pi * t / 37.5 + p)", {{"a", "um"}, {"p", "deg", 0.0, 360.0}}),
              HasSubstr("accepted: rad,"));
  for (const auto& [text, parameters] :
       std::initializer_list<std::pair<const char*, std::vector<FormulaParameter>>>{
           {"a * t", {{"a", "um/s"}}},
           {"a * max(t - 30, 0) / 60", {{"a", "um/min"}}},
           {"a * (1 - exp(-t / 60 / tau))", {{"a", "um"}, {"tau", "min", 0.1, 5.0}}},
           {"a * (t^3 + 5.5 * t^2 + 100 * t)", {{"a", "um/s^3"}}},
           {"a * sqrt(x^2 + 6.25)", {{"a", "um/mm"}}},
           {"a * t / 60", {{"a", "um/min"}}},
           {"a * s", {{"a", "um/m"}}},
           {"a * r^2 * rpm / feed", {{"a", "um mm^-1"}}},
           {"a * t^2 / r", {{"a", "mm um/s^2"}}},
           {"a * t^2 / r", {{"a", "um mm/s^2"}}},
           {"a * t * exp(-u)", {{"a", "um/s"}, {"u", "%", 1.0, 9.0}}},
           {"a * sqrt(t)", {{"a", "um/s^0.5"}}},
           {"a * cos(pi / 180 * w * t)", {{"a", "um"}, {"w", "deg/s", 0.1, 9.0}}},
           {"a * sin(2 * pi * f * t + p)",
            {{"a", "um"}, {"f", "Hz", 0.1, 1.0}, {"p", "rad", 0, 6}}},
           {"a * (1 - exp(-max(t - t0, 0) / tau))",
            {{"a", "um"}, {"t0", "s", 0.0, 9.0}, {"tau", "s", 1.0, 9.0}}}})
    EXPECT_NO_THROW((void)formula_effect({.name = "own", .text = text, .parameters = parameters}))
        << text;
}

// A size is what makes the formula micrometres.
TEST(Formula, TellsTheUnitOfASizeInMicrometresAlone) {
  const auto units = [](const std::string& text, const std::vector<FormulaParameter>& sizes) {
    std::vector<std::string> out;
    const auto effect = effect_of(text, sizes);
    for (const Parameter& each : effect->parameters()) out.push_back(each.unit);
    return out;
  };
  EXPECT_THAT(units("a * t", {{"a", "um"}}), ElementsAre("µm/s"));
  EXPECT_THAT(units("a * sqrt(x)", {{"a", "um"}}), ElementsAre("µm/mm^0.5"));
  EXPECT_THAT(units("a * r * x + b * t", {{"a", "um"}, {"b", "um"}}),
              ElementsAre("µm/mm^2", "µm/s"));
  EXPECT_THAT(units("a * r / R", {{"a", "um"}}), ElementsAre("µm"));
  EXPECT_THAT(units("a * r / 10", {{"a", "um"}}), ElementsAre("µm"));
  EXPECT_THAT(units("a * max(t - 30, 0)", {{"a", "um"}}), ElementsAre("µm/s"));
  EXPECT_THAT(units("a * max(t - 30, 0) / 50", {{"a", "um"}}), ElementsAre("µm"));
  EXPECT_THAT(units("a * t / 60", {{"a", "um/min"}}), ElementsAre("µm/min"));
  EXPECT_THAT(units("a * 10^(t / 500)", {{"a", "um"}}), ElementsAre("µm"));
}

TEST(Formula, SaysWhereOnAProfileItIsNotFinite) {
  const Case face = all_cases()[0], diameter = all_cases()[2];
  EXPECT_THAT(fault("a * x + a * 3 / r", {{"a", "um"}}, face),
              AllOf(StartsWith("column 13 of its formula: '3 / r' is not finite at 0 mm"),
                    HasSubstr("r = 0")));
  EXPECT_THAT(fault("a * log(X + 5)", {{"a", "um"}}, diameter),
              AllOf(StartsWith("column 5 of its formula: 'log(X + 5)' is not finite at -10 mm")));
  EXPECT_THAT(fault("a * x", {{"a", "um"}}, face), IsEmpty());
}

TEST(Formula, FindsAPoleBetweenTwoStations) {
  const Case face = all_cases()[0];  // stations every 10/52 mm: none at 3.21, 1/3 or 5.001
  EXPECT_THAT(fault("a / (r - 3.21)", {{"a", "um"}}, face),
              AllOf(HasSubstr("column 1 of its formula: 'a / (r - 3.21)' has a pole near"),
                    HasSubstr("r = 3.21")));
  EXPECT_THAT(fault("a / (r - 5.001)^2", {{"a", "um"}}, face), HasSubstr("r = 5.001"));
  EXPECT_THAT(fault("a * tan(pi * r / 20 + 0.1)", {{"a", "um"}}, face), HasSubstr("column 5"));
  EXPECT_THAT(fault("a / (t - t0)", {{"a", "um"}, {"t0", "s", 3.0, 200.0}}, face),
              HasSubstr("pole"));
  // In a shape alone.
  EXPECT_THAT(fault("a * x / (w - 5)", {{"a", "um"}, {"w", "mm", 1.0, 100.0}}, face),
              HasSubstr("w = 5"));
}

// Beside the largest value, and where each shape by itself is harmless.
TEST(Formula, FindsASmallPoleAndACornerOfTwoShapes) {
  const Case face = all_cases()[0];
  EXPECT_THAT(fault("a * (100 * r^2 + 1 / (r - 3.2123))", {{"a", "um"}}, face),
              HasSubstr("r = 3.2123"));
  EXPECT_THAT(fault("a * log(r - p + q)",
                    {{"a", "um"}, {"p", "mm", 0.0, 10.0}, {"q", "mm", 6.0, 20.0}}, face),
              AllOf(HasSubstr("is not finite"), HasSubstr("p = 10, q = 6")));
}

TEST(Formula, TakesWhatIsSteepButFinite) {
  const Case face = all_cases()[0], diameter = all_cases()[2];
  for (const char* text : {"a / (r + 0.01)", "a * exp((r - R) / 0.05)",
                           "a * sin(X * 17) / (2 + X)^0", "a * (x > 363)", "a * abs(X)"})
    EXPECT_THAT(fault(text, {{"a", "um"}}, diameter), IsEmpty()) << text;
  EXPECT_THAT(fault(coolant().text, coolant().parameters, face), IsEmpty());
}

// The same effect as code: columns, shapes and refusals are those of the formula.
TEST(Formula, CanBeAFunction) {
  Formula as_code = coolant();
  as_code.variables = {"t"};
  as_code.function = [](const auto& variables, const auto& parameters) {
    std::vector<double> out;
    for (const double t : variables.at("t"))
      out.push_back(parameters.at("a") * (1.0 - std::exp(-std::max(t - parameters.at("t0"), 0.0) /
                                                         parameters.at("tau"))));
    return out;
  };
  const auto function = effect_of(as_code), text = effect_of(coolant());
  const Case face = all_cases()[0];
  EXPECT_EQ(names(*function, 0, 3), names(*text, 0, 3));
  EXPECT_EQ(columns(*function, face, std::array{60.0, 90.0}),
            columns(*text, face, std::array{60.0, 90.0}));
  as_code.variables = {"T"};
  EXPECT_THROW((void)effect_of(as_code), UsageError);
  as_code.variables = {"x"};
  as_code.function = [](const auto&, const auto&) { return std::vector{1.0, 2.0, 3.0}; };
  EXPECT_THROW((void)effect_of(as_code), UsageError);
}

// A search that steps over 1/40 of the range would not see this wave.
TEST(Formula, IsSearchedAsFinelyAsItsColumnsChange) {
  const Case face = all_cases()[0];
  const Stations stations(face.positions, face.setup, lathe());
  const auto wave = effect_of("a * cos(2 * pi * f * t)", {{"a", "um"}, {"f", "Hz", 0.0, 0.05}});
  // The phase at the end of the cut, 300 s, moves by less than half a turn.
  EXPECT_LT(wave->resolution(0, 0.02, stations), 0.5 / 300.0);
  EXPECT_GT(wave->resolution(0, 0.02, stations), 0.01 / 300.0);
}

}  // namespace
}  // namespace slideway::formula_test
