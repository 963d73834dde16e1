// Parts of the search against what is known of them from outside.

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "calibration.hpp"
#include "detection.hpp"
#include "refine.hpp"
#include "search.hpp"
#include "slideway/base/random.hpp"
#include "slideway/base/units.hpp"
#include "slideway/identify/lack_of_fit.hpp"
#include "slideway/identify/linear_algebra.hpp"
#include "slideway/identify/noise_model.hpp"
#include "trace/faces.hpp"

namespace slideway {
namespace {

using namespace faces;  // NOLINT(google-build-using-namespace)

constexpr double kRounding = 1e-9;  // some hundred operations on numbers of order one

/// First-order autoregression as a block mean beside white noise: Var(e) ρ^d at every distance d.
Noise first_order(double rho, double innovation, Eigen::Index n = 160) {
  const double variance = innovation * innovation / (1.0 - rho * rho);
  ExponentialMixture covariance;
  covariance.white = 0.0;
  covariance.lengths[0] = -1.0 / std::log(rho);
  covariance.variances[0] = 1.0;
  covariance.variances[0] = variance * rho / covariance.covariance(1.0);
  covariance.white = variance - covariance.variance();
  return {covariance, n};
}

/// Cuts of 160 low-band values, their model and the noise it is whitened with.
struct Bench {
  explicit Bench(const turning::Hidden& hidden = {"clean"}, std::uint64_t seed = 3, int cuts = 1)
      : problem(make_problem()),
        profiles(quarter_faces(hidden, cuts, kBlunt, seed)),
        model(build_model(problem, profiles)),
        fitted(fit(model)) {}

  static Problem make_problem() {
    Problem problem = problem_of();
    problem.low_band.level = 5;
    return problem;
  }

  [[nodiscard]] Whitened white(const Noise& noise) const { return {fitted.linear, {noise}}; }
  [[nodiscard]] Whitened white() const { return white(first_order(0.4, 5e-5)); }

  Problem problem;
  std::vector<Profile> profiles;
  Model model;
  Solution fitted;
};

TEST(Whitened, TurnsTheCovarianceOfAFirstOrderNoiseIntoTheUnitMatrix) {
  const double rho = 0.7, innovation = 0.3;
  const Bench bench;
  const Whitened data = bench.white(first_order(rho, innovation));
  const Eigen::Index n = data.rows();
  ASSERT_EQ(n, data.values());
  Eigen::MatrixXd w = Eigen::MatrixXd::Identity(n, n);
  data.whiten(w);
  // Textbook covariance of AR(1): σ² ρ^|i-j| / (1 - ρ²).
  Eigen::MatrixXd covariance(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      covariance(i, j) = innovation * innovation *
                         std::pow(rho, std::abs(static_cast<double>(i - j))) / (1.0 - rho * rho);
  EXPECT_LT(
      (w * covariance * w.transpose() - Eigen::MatrixXd::Identity(n, n)).cwiseAbs().maxCoeff(),
      kRounding);
}

/// What the model and the nuisances span, orthonormal: by one QR over all of it.
Eigen::MatrixXd basis_of(const Bench& bench, const Whitened& data) {
  Eigen::MatrixXd span = model_span(bench.fitted.linear);
  data.whiten(span);
  return orthonormal(std::move(span));
}

TEST(Whitened, ResidualLiesOutsideWhatTheModelSpans) {
  const Bench bench;
  const Whitened data = bench.white();
  const Eigen::MatrixXd basis = basis_of(bench, data);
  EXPECT_LT((basis.transpose() * data.residual()).norm(), kRounding * data.residual().norm());
}

TEST(Whitened, PartOfItLiesOutsideWhatTheModelSpansInThatPart) {
  const Bench bench;
  const Whitened data = bench.white();
  const Eigen::MatrixXd whole = basis_of(bench, data);
  std::vector<Eigen::Index> rows;
  for (Eigen::Index row = 0; row < data.rows(); ++row)
    if (row % 3 != 0 || row >= data.values()) rows.push_back(row);
  const Eigen::MatrixXd part = orthonormal(whole(rows, Eigen::all));
  const Eigen::MatrixXd columns = Eigen::MatrixXd::Random(std::ssize(rows), 4);
  const Eigen::MatrixXd expected = columns - part * (part.transpose() * columns);
  EXPECT_LT((data.outside_in(rows, columns) - expected).norm(), kRounding * columns.norm());
}

TEST(Whitened, ShowsOfOneProfileWhatColumnsOfAllRowsDo) {
  const Whitened data = Bench().white();
  for (std::size_t i = 0; i < data.observations(); ++i) {
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(data.rows(), 3);
    columns.middleRows(data.first_row(i), data.count(i)).setRandom();
    const Whitened::Shown shown =
        data.shown_in(i, columns.middleRows(data.first_row(i), data.count(i)));
    const Eigen::MatrixXd outside = data.outside(columns);
    EXPECT_LT((shown.gram - shown.shared.transpose() * shown.shared - outside.transpose() * outside)
                  .norm(),
              kRounding * shown.gram.norm());
    EXPECT_LT((shown.products - outside.transpose() * data.residual()).norm(),
              kRounding * outside.norm() * data.residual().norm());
  }
}

/// Noise of the low band of the test's faces, mm: exponentially correlated noise averaged over 32
/// samples of 1 µm, σ² 2 (L/T)² (T/L - 1 + exp(-T/L)) with L = 0.1 mm and T = 0.032 mm, and white
/// noise over 32.
const double kLowBandNoise = [] {
  const double ratio = 0.032 / 0.1;
  const double kept = 2.0 / (ratio * ratio) * (ratio - 1.0 + std::exp(-ratio));
  return std::sqrt(std::pow(turning::kFaceNoise, 2) * kept +
                   std::pow(turning::kFaceWhiteNoise, 2) / 32.0);
}();

// A line that is left free only in part makes a noise of it; one that is left free leaves the noise
// model a gap in the spectrum it may put any noise into. Both made a cut count for nothing.
TEST(NoiseBeside, IsTheInstrumentsBesideFeedMarksAndAStrongLine) {
  for (const std::uint64_t seed : {111U, 114U, 3U, 4U})
    for (const char* name : {"clean", "slide_periodic"}) {
      RandomStream random(seed, name);
      const turning::Hidden hidden = turning::make_hidden(name, 30.0 * turning::kFaceNoise, random);
      const Problem problem = turning::face_problem();
      const std::vector<Profile> profiles = turning::make_faces(hidden, 3, kSharp, seed);
      const FittedModel declared = fit_declared(problem, profiles);
      for (const Noise& noise : noise_beside(declared.fit.linear, declared.model.gates)) {
        const double found = noise.standard_deviation() / std::sqrt(32.0);
        EXPECT_GT(found, 0.7 * kLowBandNoise) << name << ' ' << seed;  // some 100 free values
        // A texture and a long memory differ in the slow band, which is left free: the size of one
        // value about the mean of the trace is known to a half. What the nose makes of the line
        // stays.
        EXPECT_LT(found, (hidden.tool ? 2.5 : 1.6) * kLowBandNoise) << name << ' ' << seed;
      }
    }
}

/// That the noise is none but the likeliest, of the fine band alone and after the slow one has been
/// heard, over residuals of white noise and of what is added to it.
template <typename Slow>
std::pair<double, double> open_noises(Slow&& slow) {
  const Bench bench({"clean"}, 3, 3);
  Linearisation linear = bench.fitted.linear;
  std::pair<double, double> sum{0.0, 0.0};
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    RandomStream random(seed, "white");
    for (Eigen::VectorXd& residual : linear.residuals) {
      for (double& value : residual) value = 1e-5 * random.normal();
      residual += slow(random, residual.size());
    }
    const Gates gates;
    std::vector<Noise> noise = noise_beside(linear, gates);
    const std::vector<Noise::Alternative> before = noise[0].alternatives;
    sum.first += probability_of_others(noise);
    rule_out_by_whole(linear, gates, {}, noise);
    sum.second += probability_of_others(noise);
    double total = 0.0;
    const auto likeliest =
        std::ranges::max_element(before, {}, &Noise::Alternative::probability) - before.begin();
    for (std::size_t g = 0; g < before.size(); ++g) {
      const double now = noise[0].alternatives[g].probability;
      total += now;
      if (std::ssize(before) > 1 && static_cast<std::ptrdiff_t>(g) != likeliest)
        EXPECT_LE(now, before[g].probability);
    }
    EXPECT_NEAR(total, 1.0, 1e-12);
  }
  return sum;
}

// Of white noise the fine band leaves open what is slow, and the whole residual does not: half of
// the odds at least are gone. Where a random walk is in it, most of them stay.
TEST(RuleOutByWhole, HearsTheSlowBandOfNoiseThatIsWhite) {
  const auto white = open_noises(
      [](RandomStream&, Eigen::Index n) -> Eigen::VectorXd { return Eigen::VectorXd::Zero(n); });
  EXPECT_GT(white.first, 0.5);
  EXPECT_LT(white.second, 0.5 * white.first);
  const auto walking = open_noises([](RandomStream& random, Eigen::Index n) {
    Eigen::VectorXd walk(n);
    double at = 0.0;
    for (double& value : walk) value = at += 3e-6 * random.normal();
    return walk;
  });
  EXPECT_GT(walking.second, 0.5 * walking.first);
}

TEST(Projection, GainIsTheFallOfTheSumOfSquares) {
  const Bench bench;
  const Whitened data = bench.white();
  RandomStream random(4, "columns");
  Eigen::MatrixXd columns(data.rows(), 3);
  for (double& value : columns.reshaped()) value = random.normal();
  const Projection projection = project(data, columns);
  EXPECT_EQ(projection.rank, 3);

  // Without the columns the residual is data.residual(); with them, by one QR over everything.
  Eigen::MatrixXd white = columns;
  data.whiten(white);
  const Eigen::MatrixXd basis = basis_of(bench, data);
  Eigen::MatrixXd all(data.rows(), basis.cols() + 3);
  all << basis, white;
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(all);
  const Eigen::VectorXd solution = qr.solve(data.residual());
  const double left = (data.residual() - all * solution).squaredNorm();
  const double before = data.residual().squaredNorm();
  EXPECT_NEAR(projection.gain, before - left, kRounding * before);
  EXPECT_LT((projection.amplitudes - solution.tail(3)).norm(), 1e-7 * solution.tail(3).norm());
  EXPECT_NEAR(project_in(data, 0, columns).gain, projection.gain, kRounding * before);
}

TEST(Projection, ColumnsOfTheModelGainNothing) {
  const Bench bench;
  const Whitened data = bench.white();
  const Projection projection =
      project(data, stacked_columns(bench.model, bench.model.terms[0], {}, 0));
  EXPECT_EQ(projection.rank, 0);
  EXPECT_EQ(projection.gain, 0.0);
}

TEST(Refine, FindsTheBestShapeAScanFinds) {
  const double period = 3.1416;
  const Bench bench({"slide_periodic", [=](const turning::ToolPoint& p) {
                       return 0.1e-3 * std::cos(2.0 * kPi * p.x / period);
                     }});
  const Whitened data = bench.white();
  const Dictionary dictionary =
      make_dictionary(bench.model, faces::problem_of({"slide_periodic"}), 0);
  ASSERT_EQ(dictionary.candidates.size(), 1U);
  const std::vector<Finding> findings = search(data, {&dictionary.candidates[0]});
  const Refined refined = refine(bench.model, data, findings[0]);
  ASSERT_EQ(refined.shape.size(), 1U);
  EXPECT_GE(refined.projection.gain, findings[0].gain);
  double best = 0.0, at = 0.0;
  const double step = 1e-4 * period;
  for (int i = -300; i <= 300; ++i) {
    const double shape = period + step * i;
    const double gain =
        project(data, stacked_columns(bench.model, refined.candidate->term, {&shape, 1}, 0)).gain;
    if (gain > best) best = gain, at = shape;
  }
  EXPECT_NEAR(refined.shape[0], at, step);
  EXPECT_GE(refined.projection.gain, best * (1.0 - 1e-6));  // never below a point of the scan
}

// In single precision 160 products err by 1e-7 of the lengths of both, the gain by twice that of
// the square of the residual; columns may be larger than single precision holds.
TEST(LargestGains, InSinglePrecisionAreThoseOfTheSearch) {
  const Bench bench;
  const Whitened data = bench.white();
  Dictionary dictionary =
      make_dictionary(bench.model, problem_of({"slide_periodic", "thermal_drift", "cup"}), 0);
  for (Candidate& candidate : dictionary.candidates) {
    for (const double scale : {1.0, 1e45}) {
      candidate.columns = std::make_shared<Eigen::MatrixXd>(scale * *candidate.columns);
      const double gain =
          largest_gains(data, {&candidate}, Eigen::MatrixXf(data.residual().cast<float>()))[0];
      const double whole = -search(data, {&candidate})[0].delta_bic;
      EXPECT_EQ(std::isfinite(gain), std::isfinite(whole)) << candidate.name();  // or the model's
      if (std::isfinite(gain))
        EXPECT_NEAR(gain, whole, 1e-6 * data.residual().squaredNorm()) << candidate.name();
    }
  }
}

TEST(Calibration, PValueAndThresholdAreInverse) {
  const Calibration calibration{-7.5, 3.25};
  for (const double p : {1e-6, 0.01, 0.2, 0.9})
    EXPECT_NEAR(calibration.p_value(calibration.threshold(p)), p, 1e-12);
  // Gumbel distribution: 1 - exp(-1) of it lies above its location.
  EXPECT_NEAR(calibration.p_value(calibration.location), 1.0 - std::exp(-1.0), 1e-12);
  const Calibration heavy{-7.5, 3.25, -0.25};
  for (const double p : {1e-6, 0.01, 0.2, 0.9})
    EXPECT_NEAR(heavy.p_value(heavy.threshold(p)), p, 1e-12);
  // Before where the distribution of heavy tail begins, location + scale / shape.
  EXPECT_EQ(heavy.p_value(-21.0), 1.0);
}

/// Values with an extreme-value distribution, as its quantiles of uniform numbers.
std::vector<double> extremes(double shape, std::size_t count, RandomStream& random) {
  const Calibration truth{10.0, 2.0, shape};
  std::vector<double> out(count);
  for (double& value : out) value = truth.threshold(1.0 - random.uniform());
  return out;
}

// The test of one in twenty: of 400 sets 20 ± 4.4, in five standard deviations 1 to 42.
TEST(FitExtremes, LeavesTheGumbelDistributionForHeavierTailsOnly) {
  RandomStream random(20261124, "extremes");
  int gumbel = 0, heavy = 0;
  for (int set = 0; set < 400; ++set) {
    if (fit_extremes(extremes(0.0, 99, random)).shape != 0.0) ++gumbel;
    if (fit_extremes(extremes(-0.3, 99, random)).shape != 0.0) ++heavy;
  }
  EXPECT_GE(gumbel, 1);
  EXPECT_LE(gumbel, 42);
  EXPECT_GE(heavy, 360);  // k / its standard error, 0.3 sqrt(99 / 0.5633): 4
}

// Hosking, Wallis and Wood (1985): of 2000 values k is within 0.03 with a standard deviation of
// about 0.02, location and scale within 0.05; five of them.
TEST(FitExtremes, FindsTheParametersOfAHeavyTail) {
  RandomStream random(20261124, "parameters");
  const Calibration found = fit_extremes(extremes(-0.2, 2000, random));
  EXPECT_NEAR(found.shape, -0.2, 0.1);
  EXPECT_NEAR(found.location, 10.0, 0.25);
  EXPECT_NEAR(found.scale, 2.0, 0.25);
}

TEST(FitExtremes, OfValuesThatAreAllTheSameIsAStep) {
  const Calibration found = fit_extremes(std::vector<double>(99, -3.0));
  EXPECT_EQ(found.p_value(-2.0), 0.0);
  EXPECT_EQ(found.p_value(-4.0), 1.0);
}

TEST(NullResiduals, AreOutsideTheModelAndRepeat) {
  const Bench bench;
  const Whitened data = bench.white();
  const Eigen::MatrixXd null = null_residuals(data, {});
  EXPECT_LT((basis_of(bench, data).transpose() * null).cwiseAbs().maxCoeff(), kRounding);
  EXPECT_EQ(null, null_residuals(data, {}));
  EXPECT_NE(null.col(0), null.col(1));
}

// Noise as known: the squares of null residuals are χ² with as many degrees of freedom as there
// are rows beside the basis.
TEST(NullResiduals, HaveTheSizeOfWhiteNoise) {
  const Bench bench;
  const Whitened data = bench.white();
  Gates gates;
  gates.resamples = 200;
  const auto freedom = static_cast<double>(data.rows() - basis_of(bench, data).cols());
  const double mean = null_residuals(data, gates).colwise().squaredNorm().mean();
  // Five standard deviations of the mean of 200: 6e-7 of correct programs fail.
  EXPECT_NEAR(mean, freedom, 5.0 * std::sqrt(2.0 * freedom / gates.resamples));
}

// Kolmogorov-Smirnov on 60 p-values of pure noise with known correlation: distance 0.21 is exceeded
// with a probability of 1 % if they are uniform.
TEST(LackOfFit, HasUniformPValuesWhereNothingIsMissing) {
  const Bench bench;
  const Noise noise = first_order(0.4, 5e-5);
  Linearisation linear = bench.fitted.linear;
  std::vector<double> p_values;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    RandomStream random(seed, "lack of fit");
    Eigen::MatrixXd rows(linear.residuals[0].size(), 1);
    for (double& value : rows.reshaped()) value = random.normal();
    noise.colour(rows);
    linear.residuals[0] = rows.col(0);
    p_values.push_back(lack_of_fit(linear, {noise}).p_value);
  }
  std::sort(p_values.begin(), p_values.end());
  double distance = 0.0;
  for (std::size_t i = 0; i < p_values.size(); ++i) {
    const double n = static_cast<double>(p_values.size());
    distance = std::max({distance, std::abs(p_values[i] - static_cast<double>(i) / n),
                         std::abs(p_values[i] - static_cast<double>(i + 1) / n)});
  }
  EXPECT_LT(distance, 0.21);
}

TEST(LackOfFit, SeesASlowWave) {
  const Bench bench;
  const Noise noise = first_order(0.4, 5e-5);
  Linearisation linear = bench.fitted.linear;
  const Eigen::Index n = linear.residuals[0].size();
  for (Eigen::Index i = 0; i < n; ++i)
    linear.residuals[0][i] =
        5e-4 * std::cos(10.0 * kPi * static_cast<double>(i) / static_cast<double>(n));
  EXPECT_TRUE(lack_of_fit(linear, {noise}).significant({}));
}

/// Limits of one cut whose noise has this innovation.
std::vector<DetectionLimit> limits_at(const Bench& bench, const Dictionary& dictionary,
                                      double innovation) {
  Candidates candidates;
  for (const Candidate& candidate : dictionary.candidates) candidates.push_back(&candidate);
  const Whitened data = bench.white(first_order(0.4, innovation));
  return detection_limits({bench.model, bench.fitted}, data, data.noise(), candidates, {20.0, 2.0});
}

TEST(DetectionLimit, IsTheSizeWhoseGainPassesTheGateInFourOfFive) {
  const Bench bench;
  const Dictionary dictionary = make_dictionary(bench.model, problem_of({"feed_marks"}), 0);
  const std::vector<DetectionLimit> limits = limits_at(bench, dictionary, 5e-5);
  ASSERT_EQ(limits.size(), 1U);
  const Whitened data = bench.white();
  const Candidate& marks = dictionary.candidates[0];
  const Eigen::VectorXd one = marks.term.effect->from_parameters(Eigen::VectorXd::Ones(1));
  const double norm = data.outside(stacked_columns(bench.model, marks.term, {}, 0) * one).norm();
  const double gate = penalty(data, 1) + Calibration{20.0, 2.0}.threshold(0.01);
  // 0.8416: normal deviate of 80 %; of the gate's square root the other tail is below 1e-8.
  EXPECT_NEAR(limits[0].value.value() * norm, std::sqrt(gate) + 0.8416, 1e-4);
}

// In noise of a millimetre nothing below a hundred times the range of the face would be found.
TEST(DetectionLimit, IsNoneBeyondAHundredTimesTheRangeOfAProfile) {
  const Bench bench;
  const Dictionary dictionary =
      make_dictionary(bench.model, problem_of({"feed_marks", "thermal_drift"}), 0);
  EXPECT_EQ(limits_at(bench, dictionary, 5e-5).size(), 2U);
  EXPECT_TRUE(limits_at(bench, dictionary, 1.0).empty());
}

TEST(DetectionLimit, GrowsWithTheNoise) {
  const Bench bench;
  const Dictionary dictionary = make_dictionary(
      bench.model, problem_of({"feed_marks", "thermal_drift", "slide_periodic", "step"}), 0);
  const std::vector<DetectionLimit> quiet = limits_at(bench, dictionary, 5e-5);
  const std::vector<DetectionLimit> noisy = limits_at(bench, dictionary, 1e-4);
  ASSERT_EQ(quiet.size(), 4U);
  for (std::size_t i = 0; i < quiet.size(); ++i) {
    SCOPED_TRACE(quiet[i].effect);
    EXPECT_NEAR(noisy[i].value.value(), 2.0 * quiet[i].value.value(), kRounding * *quiet[i].value);
    EXPECT_EQ(quiet[i].by_shape.empty(), quiet[i].at.empty());
    for (std::size_t k = 0; k < quiet[i].by_shape.size(); ++k) {
      const double size = quiet[i].by_shape[k].value.value();
      EXPECT_NEAR(noisy[i].by_shape[k].value.value(), 2.0 * size, kRounding * size);
    }
    EXPECT_TRUE(std::ranges::is_sorted(quiet[i].by_shape, {}, &LimitAtShape::shape));
  }
}

}  // namespace
}  // namespace slideway
