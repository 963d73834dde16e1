// Published regressions as problem files: their data are heights read along a slide, their formulas
// effects of the user's own, what comes out is read from the JSON. Through problem file, readers,
// search of the shapes, fit and report no more is lost than the last five digits of the published
// eleven.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/run_program.hpp"
#include "identify/nist.hpp"
#include "slideway/base/text.hpp"
#include "support/measured_data.hpp"

namespace slideway {
namespace {

using nlohmann::json;

const std::string kHeights =
    "kind = \"slide\"\nquantity = \"height\"\nposition_unit = \"mm\"\nfree = []\n";

std::string formula_effect(const std::string& formula, const std::string& parameters) {
  return "[[effect]]\nname = \"formula\"\nas = \"f\"\nformula = \"" + formula +
         "\"\nparameters = [" + parameters + "]\n";
}

class Reference : public ProgramTest {
 protected:
  /// Parameters of `slideway fit`, by name behind the effect's.
  [[nodiscard]] std::map<std::string, json> fitted(const std::string& problem) const {
    folder_.file("problem.toml", "title = \"reference\"\n[low_band]\nlevel = 0\n" + problem);
    const ProgramRun fit = run({"fit", "problem.toml", "--json", "-"});
    EXPECT_EQ(fit.exit_code, 0) << fit.err;
    std::map<std::string, json> out;
    if (fit.exit_code != 0) return out;
    const json report = json::parse(fit.out);
    for (const json& parameter : report["final"]["parameters"]) {
      const std::string name = parameter["name"];
      out[name.substr(name.find('.') + 1)] = parameter;
    }
    correlation_ = report["final"]["correlations"];
    return out;
  }

  /// Profiles of these readings, y in that unit, with their files.
  [[nodiscard]] std::string readings(const std::multimap<double, double>& points,
                                     const std::string& unit, double deviation) const {
    std::string out;
    for (const Profile& profile : nist::profiles(points)) {
      std::string table = "x,y\n";
      for (std::size_t i = 0; i < profile.positions.size(); ++i)
        table += shortest(profile.positions[i]) + ',' + shortest(profile.values[i]) + '\n';
      folder_.file(profile.name + ".csv", table);
      out += "[[profile]]\nname = \"" + profile.name + "\"\nfile = \"" + profile.name +
             ".csv\"\nvalue_unit = \"" + unit + "\"\n" + kHeights;
      // The certified deviations hold for independent readings of one precision.
      if (deviation > 0.0) out += "standard_uncertainty = " + shortest(deviation) + '\n';
    }
    return out;
  }

  mutable json correlation_;
};

// JCGM 100:2008 (GUM), H.3: correction b of a thermometer, y1 + y2 (t - 20 °C), from eleven
// comparisons, and its value at 30 °C. Printed to the last digit that is compared.
TEST_F(Reference, CalibrationOfAThermometerIsTheOneOfTheGuide) {
  folder_.file("b.csv",
               "t,b\n1.521,-0.171\n2.012,-0.169\n2.512,-0.166\n3.003,-0.159\n3.507,-0.164\n"
               "3.999,-0.165\n4.513,-0.156\n5.002,-0.157\n5.503,-0.159\n6.010,-0.161\n"
               "6.511,-0.160\n");
  const std::string profile =
      "[[profile]]\nname = \"b\"\nfile = \"b.csv\"\nvalue_unit = \"um\"\n" + kHeights;
  const std::string units = R"({ name = "y1", unit = "um" }, { name = "y2", unit = "um/mm" })";
  const auto at_20 = fitted(profile + formula_effect("y1 + y2 * x", units));
  EXPECT_NEAR(at_20.at("y1")["value"], -0.1712, 5e-5);
  EXPECT_NEAR(at_20.at("y1")["standard_uncertainty"], 0.0029, 5e-5);
  EXPECT_NEAR(at_20.at("y2")["value"], 0.00218, 5e-6);
  EXPECT_NEAR(at_20.at("y2")["standard_uncertainty"], 0.00067, 5e-6);
  EXPECT_NEAR(at_20.at("y1")["degrees_of_freedom"], 9.0, 1e-9);
  ASSERT_EQ(correlation_.size(), 1U);
  EXPECT_NEAR(correlation_[0][2].get<double>(), -0.930, 5e-4);
  const auto at_30 = fitted(profile + formula_effect("y1 + y2 * (x - 10)", units));
  EXPECT_NEAR(at_30.at("y1")["value"], -0.1494, 5e-5);
  EXPECT_NEAR(at_30.at("y1")["standard_uncertainty"], 0.0041, 5e-5);
}

/// A set of NIST with its formula; shapes are searched from a part of its lower start to as many
/// times its higher one.
struct Set {
  std::string name, formula;
  std::vector<int> amplitudes;
  double range = 2.0;
};

// No two shapes whose parts may change places have the same range. Besides those that
// tests/identify/nist_nonlinear_test.cpp leaves out: Kirby 2 and Hahn 1, which read one place twice
// (a profile of one sample), and Thurber, whose formula has poles between the starts.
const std::string kPeaks =
    "b1 * exp(-b2 * x) + b3 * exp(-(x - b4)^2 / b5^2) + b6 * exp(-(x - b7)^2 / b8^2)";
const std::string kExponentials = "b1 * exp(-b2 * x) + b3 * exp(-b4 * x) + b5 * exp(-b6 * x)";
const std::vector<Set> kSets{
    {"Misra1a", "b1 * (1 - exp(-b2 * x))", {1}},
    {"Misra1b", "b1 * (1 - (1 + b2 * x / 2)^(-2))", {1}},
    {"Misra1c", "b1 * (1 - (1 + 2 * b2 * x)^(-0.5))", {1}},
    {"Misra1d", "b1 * b2 * x / (1 + b2 * x)", {1}},
    {"BoxBOD", "b1 * (1 - exp(-b2 * x))", {1}},
    {"DanWood", "b1 * x^b2", {1}},
    {"Rat42", "b1 / (1 + exp(b2 - b3 * x))", {1}},
    {"Rat43", "b1 / (1 + exp(b2 - b3 * x))^(1 / b4)", {1}},
    {"MGH09", "b1 * (x^2 + x * b2) / (x^2 + x * b3 + b4)", {1}, 5.0},
    {"MGH10", "b1 * exp(b2 / (x + b3))", {1}},
    {"MGH17", "b1 + b2 * exp(-x * b4) + b3 * exp(-x * b5)", {1, 2, 3}},
    {"Bennett5", "b1 * (b2 + x)^(-1 / b3)", {1}},
    {"Eckerle4", "(b1 / b2) * exp(-0.5 * ((x - b3) / b2)^2)", {1}},
    {"Lanczos2", kExponentials, {1, 3, 5}},
    {"Lanczos3", kExponentials, {1, 3, 5}},
    {"Gauss1", kPeaks, {1, 3, 6}},
    {"Gauss2", kPeaks, {1, 3, 6}},
    {"Gauss3", kPeaks, {1, 3, 6}, 1.5},
    {"ENSO",
     "b1 + b2 * cos(2*pi*x/12) + b3 * sin(2*pi*x/12) + b5 * cos(2*pi*x/b4) + b6 * sin(2*pi*x/b4) + "
     "b8 * cos(2*pi*x/b7) + b9 * sin(2*pi*x/b7)",
     {1, 2, 3, 5, 6, 8, 9}}};

class NistLinearThroughTheProgram : public Reference,
                                    public testing::WithParamInterface<std::string> {};

// A polynomial is a straightness; heights and coefficients in mm. Without Norris, which reads one
// place twice: a profile of one sample.
TEST_P(NistLinearThroughTheProgram, TheCertifiedCoefficientsComeOut) {
  const std::filesystem::path folder = measured_data() / "nist_strd_linear";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no nist_strd_linear";
  const nist::Certified answer = nist::certified(folder, GetParam());
  const std::map<std::string, json> found =
      fitted(readings(nist::points(folder, GetParam()), "mm", answer.residual_deviation) +
             "[[effect]]\nname = \"straightness\"\ndegree = " +
             std::to_string(answer.coefficients.size() - 1) + '\n');
  for (std::size_t k = 0; k < answer.coefficients.size(); ++k) {
    const json& parameter = found.at('b' + std::to_string(k));
    EXPECT_GE(nist::digits(parameter["value"], answer.coefficients[k]), 6.0) << k;
    if (answer.residual_deviation > 0.0) {
      EXPECT_GE(nist::digits(parameter["standard_uncertainty"], answer.deviations[k]), 6.0) << k;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Sets, NistLinearThroughTheProgram,
                         testing::Values("wampler1", "wampler2", "wampler3", "wampler4", "wampler5",
                                         "filip", "pontius"),
                         [](const auto& set) { return set.param; });

class NistThroughTheProgram : public Reference, public testing::WithParamInterface<Set> {
 protected:
  [[nodiscard]] std::string problem(const nist::File& file) const {
    const std::string out = readings(file.points, "um", file.residual_deviation);
    std::string parameters;
    for (const auto& [b, numbers] : file.certified) {
      parameters += "{ name = \"b" + std::to_string(b) + "\", unit = ";
      if (std::ranges::count(GetParam().amplitudes, b)) {
        parameters += "\"um\" }, ";
        continue;
      }
      const auto [low, high] = std::minmax(numbers[0], numbers[1]);
      const double range = GetParam().range;
      parameters += "\"1\", lower = " + shortest(std::min(low * range, low / range)) +
                    ", upper = " + shortest(std::max(high * range, high / range)) + " }, ";
    }
    parameters.resize(parameters.size() - 2);
    return out + formula_effect(GetParam().formula, parameters);
  }
};

TEST_P(NistThroughTheProgram, TheCertifiedParametersComeOut) {
  const std::filesystem::path path =
      measured_data() / "nist_strd_nonlinear" / (GetParam().name + ".dat");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no nist_strd_nonlinear";
  const nist::File file = nist::read(path);
  const std::map<std::string, json> found = fitted(problem(file));
  ASSERT_EQ(found.size(), file.certified.size());
  for (const auto& [b, numbers] : file.certified) {
    const json& parameter = found.at("b" + std::to_string(b));
    EXPECT_GE(nist::digits(parameter["value"], numbers[2]), 6.0) << b;
    // Widened where the residual has a structure; then the digits are the widening's.
    const double u = parameter["standard_uncertainty"];
    EXPECT_GE(u, numbers[3] * (1.0 - 1e-6)) << b;
    if (GetParam().name == "Bennett5") continue;  // its residual has one
    EXPECT_GE(nist::digits(u, numbers[3]), 6.0) << b;
  }
}

INSTANTIATE_TEST_SUITE_P(Sets, NistThroughTheProgram, testing::ValuesIn(kSets),
                         [](const auto& set) { return set.param.name; });

}  // namespace
}  // namespace slideway
