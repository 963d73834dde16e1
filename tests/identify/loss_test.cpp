// Traces with dirt: Huber's and Cauchy's loss of [[profile]].
#include <gtest/gtest.h>

#include <ceres/covariance.h>
#include <ceres/problem.h>

#include <cmath>
#include <utility>

#include "identify/cases.hpp"
#include "residual.hpp"
#include "slideway/base/random.hpp"
#include "slideway/identify/noise_model.hpp"

namespace slideway::loss_test {
namespace {

constexpr std::size_t kValues = 2000;
constexpr double kNoise = 1e-4;      // mm
constexpr double kCurvature = 1e-6;  // mm^-1
constexpr int kEvery = 20;           // one value of so many is dirt

/// A slide of that curvature with white noise, some values lifted by `dirt`.
Profile slide(double dirt, Loss loss) {
  RandomStream random(11, "dirt");
  std::vector<double> x = cases::spaced(-100.0, 100.0, kValues), z;
  for (std::size_t i = 0; i < x.size(); ++i)
    z.push_back(kCurvature * x[i] * x[i] + kNoise * random.normal() +
                (i % kEvery == 7 ? dirt : 0.0));
  Profile out = cases::profile("slide", Kind::slide, x, z);
  out.loss = loss;
  return out;
}

struct Fitted {
  double error_in_u = 0.0, u = 0.0;

  explicit Fitted(const Profile& profile) : Fitted(std::vector{profile}) {}
  explicit Fitted(const std::vector<Profile>& profiles) {
    const Model model =
        build_model(cases::problem(Lever::paper, 0, {cases::effect("straightness", 2)}), profiles);
    const Solution found = fit(model);
    const Eigen::RowVectorXd row = found.parameters.jacobian.row(2);
    u = found.uncertainty.of(row).standard_uncertainty;
    error_in_u = (found.parameters.values[2] - kCurvature) / u;
  }
};

// One value of one of three readings, ten standard deviations off: noise has a largest one of 4.2
// or more with a probability of 10⁻³ in each reading, so of 60 clean ones one is told in 6 %.
TEST(FarValue, IsToldWithItsPlace) {
  const auto notes_on_slopes = [](double off, std::uint64_t seed) {
    std::vector<Profile> runs;
    for (const char* name : {"run1", "run2", "run3"}) {
      RandomStream random(seed, name);
      const std::vector<double> x = cases::spaced(0.0, 1000.0, 41);
      std::vector<double> slopes;
      for (const double at : x) slopes.push_back(2.0 * kCurvature * at + 1e-6 * random.normal());
      runs.push_back(cases::profile(name, Kind::slide, x, slopes));
      runs.back().setup.quantity = Quantity::slope;
    }
    runs[1].values[17] += off * 1e-6;
    const FittedModel fitted =
        fit_declared(cases::problem(Lever::paper, 0, {cases::effect("straightness", 2)}), runs);
    std::vector<std::string> notes;
    for (const std::string& note : summarise(fitted.model, fitted.fit).notes)
      if (note.find("read wrongly") != std::string::npos) notes.push_back(note);
    return notes;
  };
  int told = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const std::vector<std::string> notes = notes_on_slopes(10.0, seed);
    ASSERT_GE(notes.size(), 1U);
    EXPECT_NE(notes[0].find("'run2': the value at 425 mm"), std::string::npos) << notes[0];
    told += static_cast<int>(notes_on_slopes(0.0, seed).size());
  }
  EXPECT_LE(told, 1);
}

class LossOfAProfile : public ::testing::TestWithParam<Loss> {};

TEST_P(LossOfAProfile, KeepsDirtOutOfTheEstimate) {
  const double dirt = 200.0 * kNoise;
  const Fitted plain(slide(dirt, Loss::none)), robust(slide(dirt, GetParam()));
  EXPECT_LT(std::abs(robust.error_in_u), 4.0);
  // Squares see a noise of 200 sqrt(0.05 0.95) = 44 times the instrument's; with a bounded or a
  // linear loss one value of twenty counts as a few standard deviations at most.
  EXPECT_LT(robust.u, 0.1 * plain.u);
}

// Tuned for an efficiency of 95 % on normal noise: U grows by 1 / sqrt(0.95) = 1.026. The spread of
// 2000 values is known to 1.6 %, but both fits have the same noise: a third of that is left.
TEST_P(LossOfAProfile, CostsFivePercentOfTheEfficiencyOnCleanData) {
  const Fitted plain(slide(0.0, Loss::none)), robust(slide(0.0, GetParam()));
  EXPECT_NEAR(robust.u / plain.u, 1.0 / std::sqrt(0.95), 0.02);
  EXPECT_LT(std::abs(robust.error_in_u), 4.0);
}

TEST_P(LossOfAProfile, IsOfThatProfileAlone) {
  Profile plain = slide(0.0, Loss::none);
  plain.name = "plain";
  for (double& value : plain.values) value *= 1.0 + 1e-9;  // no copy of the other
  const Fitted both(std::vector{slide(200.0 * kNoise, GetParam()), plain});
  EXPECT_LT(std::abs(both.error_in_u), 4.0);
  EXPECT_LT(both.u, Fitted(plain).u);
}

INSTANTIATE_TEST_SUITE_P(Robust, LossOfAProfile, ::testing::Values(Loss::huber, Loss::cauchy));

// What an orthogonal factorisation leaves out of a sum of squares does not depend on the
// parameters, where the levelling is the best for them.
TEST(CompressedResidual, HasTheSquareOfTheLevelledValuesButForAConstant) {
  const std::vector<Profile> profiles{slide(0.0, Loss::none)};
  const Model model =
      build_model(cases::problem(Lever::paper, 0, {cases::effect("straightness", 3)}), profiles);
  const Observation& observation = model.observations[0];
  const Noise noise = Noise::white(kNoise, kValues);
  const Eigen::MatrixXd columns = fit(model).linear.columns[0];
  const ProfileTriangle triangle(observation, noise, columns, observation.values);
  const CompressedResidual residual(model, triangle);
  ASSERT_EQ(residual.parameter_block_sizes().size(), 1U);
  const auto left_out = [&](const Eigen::VectorXd& amplitudes) {
    const double* parameters[] = {amplitudes.data()};
    Eigen::VectorXd out(residual.num_residuals());
    EXPECT_TRUE(residual.Evaluate(parameters, out.data(), nullptr));
    const Eigen::VectorXd rest = observation.values - columns * amplitudes;
    Eigen::MatrixXd direct =
        rest - observation.nuisances * observation.nuisances.householderQr().solve(rest);
    noise.whiten(direct);
    return direct.squaredNorm() - out.squaredNorm();
  };
  const Eigen::Index a = columns.cols();
  const double at_zero = left_out(Eigen::VectorXd::Zero(a));
  EXPECT_NEAR(left_out(Eigen::VectorXd::Constant(a, kNoise)), at_zero, 1e-6 * at_zero);
}

TEST(Covariance, IsTheOneOfCeres) {
  Profile profile = slide(0.0, Loss::none);
  profile.standard_uncertainty = kNoise;
  profile.free_offset = profile.free_tilt = false;
  const std::vector<Profile> profiles{profile};
  const Model model =
      build_model(cases::problem(Lever::paper, 0, {cases::effect("straightness", 4)}), profiles);
  const Solution found = fit(model);
  const ProfileTriangle triangle(model.observations[0], found.noise[0], found.linear.columns[0],
                                 model.observations[0].values);
  Eigen::VectorXd amplitudes = found.estimate.amplitudes;
  ceres::Problem problem;
  problem.AddResidualBlock(new CompressedResidual(model, triangle), nullptr, amplitudes.data());
  ceres::Covariance::Options options;
  options.algorithm_type = ceres::DENSE_SVD;
  ceres::Covariance covariance(options);
  const std::vector<std::pair<const double*, const double*>> blocks{
      {amplitudes.data(), amplitudes.data()}};
  ASSERT_TRUE(covariance.Compute(blocks, &problem));
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> expected(
      amplitudes.size(), amplitudes.size());
  covariance.GetCovarianceBlock(amplitudes.data(), amplitudes.data(), expected.data());
  const Eigen::MatrixXd& basis = found.uncertainty.basis;
  const Eigen::MatrixXd ours = basis * found.uncertainty.covariance * basis.transpose();
  // Rounding of two factorisations of columns that are nearly orthogonal.
  EXPECT_LT((ours - expected).norm(), 1e-10 * expected.norm());
}

// Two readings that disagree by far more than noise in all values: none of these is an outlier.
// Their white noise is known to 5 % of 200 values each; three of those are allowed.
TEST(Loss, OfAReadingThatDisagreesAsAWholeLeavesItsNoiseWhatItIs) {
  std::vector<Profile> readings;
  for (const char* name : {"rough", "fine"}) {
    RandomStream random(3, name);
    std::vector<double> x = cases::spaced(0.0, 200.0, 200), z;
    for (const double at : x)
      z.push_back(kNoise * random.normal() +
                  (readings.empty() ? 50.0 * kNoise * std::sin(2.0 * kPi * at / 150.0) : 0.0));
    readings.push_back(cases::profile(name, Kind::slide, x, z));
    readings.back().free_offset = readings.back().free_tilt = false;
  }
  readings.front().loss = Loss::huber;
  readings.back().standard_uncertainty = kNoise;
  const Model model =
      build_model(cases::problem(Lever::paper, 0, {cases::effect("straightness", 2)}), readings);
  EXPECT_GT(fit(model).noise[0].standard_deviation(), 0.85 * kNoise);
}

}  // namespace
}  // namespace slideway::loss_test
