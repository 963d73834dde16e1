#include "slideway/signal/low_band.hpp"

#include <gmock/gmock.h>

#include <Eigen/Dense>
#include <cmath>
#include <numeric>

#include "signal/noise.hpp"
#include "slideway/base/error.hpp"
#include "slideway/signal/bands.hpp"
#include "slideway/signal/decomposition.hpp"

namespace slideway::low_band_test {
namespace {

using testing::DoubleNear;
using testing::Each;
using testing::ElementsAreArray;
using testing::HasSubstr;
using testing::Pointwise;

std::vector<double> uniform(std::size_t n, double first = 10.0, double step = 0.03) {
  std::vector<double> positions(n);
  for (std::size_t i = 0; i < n; ++i) positions[i] = first + step * static_cast<double>(i);
  return positions;
}

// Steps from 0.4 to 1.6 of the mean one.
std::vector<double> uneven(std::size_t n) {
  std::vector<double> positions = uniform(n);
  for (std::size_t i = 0; i < n; ++i) positions[i] += 0.03 * 0.6 * std::sin(static_cast<double>(i));
  return positions;
}

std::vector<double> applied(const LowBand& low_band, const std::vector<double>& signal) {
  std::vector<double> coefficients(static_cast<std::size_t>(low_band.values()));
  low_band.apply(signal, coefficients);
  return coefficients;
}

template <typename Error, typename Call>
std::string message_of(Call call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(LowBand, IsTheLastApproximationOfTheDecomposition) {
  const std::vector<double> signal = white_noise(1001, "low band");
  const LowBand low_band({"db4", 3, Boundary::reflect}, uniform(1001));
  EXPECT_FALSE(low_band.resampled());
  EXPECT_EQ(low_band.samples(), 1001);
  EXPECT_THAT(
      applied(low_band, signal),
      ElementsAreArray(decompose(daubechies("db4"), Boundary::reflect, 3, signal).approximation));
}

// With samples missing the rest keeps its grid: where none is missing, the coefficients are those
// of the whole profile; a coefficient whose 32 samples are all gone is unmeasured, one that lost
// one is not.
TEST(LowBand, GapsLeaveTheOtherCoefficientsAlone) {
  const std::vector<double> positions = uniform(640);
  const std::vector<double> signal = white_noise(640, "gaps");
  std::vector<double> kept_positions, kept_signal;
  for (std::size_t i = 0; i < 640; ++i) {
    if ((i >= 190 && i < 260) || i == 400) continue;  // samples of blocks 5 to 8, one of block 12
    kept_positions.push_back(positions[i]);
    kept_signal.push_back(signal[i]);
  }
  const LowBand whole({}, positions), gapped({}, kept_positions);
  EXPECT_EQ(gapped.samples(), 640);
  ASSERT_EQ(gapped.values(), whole.values());
  EXPECT_THAT(gapped.unmeasured(), testing::ElementsAre(6, 7));
  const std::vector<double> expected = applied(whole, signal);
  const std::vector<double> found = applied(gapped, kept_signal);
  for (std::size_t j = 0; j < expected.size(); ++j)
    if ((j < 5 || j > 8) && j != 12) {
      EXPECT_NEAR(found[j], expected[j], 1e-11) << j;
    }
  // A straight line is what interpolation keeps.
  const std::vector<double> line = applied(gapped, kept_positions);
  EXPECT_THAT(line, Pointwise(DoubleNear(1e-10), applied(whole, positions)));
}

// Near the ends a symmetric boundary gives values that repeat others or stand for one reading.
// Those that are measured keep white noise white: the eigenvalues of their covariance, that of the
// rows of the transform (PyWavelets has the same), are near 1: from 0.69 to 1.75 for db8, of whose
// last value the extension makes a quarter. Those of all values are 0.003 to 8.
TEST(LowBand, WhiteNoiseStaysWhiteInTheMeasuredValues) {
  for (const LowBandOptions& options :
       {LowBandOptions{"db1", 3}, {"db1", 5}, {"db2", 3}, {"db4", 2}, {"db4", 3}, {"db8", 2}})
    for (const std::size_t n : {320, 321, 323, 326, 335}) {
      const LowBand low_band(options, uniform(n));
      const auto size = static_cast<Eigen::Index>(n);
      const Eigen::MatrixXd rows =
          low_band.apply(Eigen::MatrixXd(Eigen::MatrixXd::Identity(size, size)));
      std::vector<Eigen::Index> measured;
      for (Eigen::Index j = 0; j < low_band.values(); ++j)
        if (std::ranges::count(low_band.unmeasured(), j) == 0) measured.push_back(j);
      EXPECT_GE(std::ssize(measured), (size >> options.level) - 1) << options.wavelet << ' ' << n;
      const Eigen::MatrixXd kept = rows(measured, Eigen::all);
      const Eigen::VectorXd variances =
          Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(kept * kept.transpose()).eigenvalues();
      EXPECT_GT(variances.minCoeff(), 0.65) << options.wavelet << ' ' << n;
      EXPECT_LT(variances.maxCoeff(), 1.8) << options.wavelet << ' ' << n;
    }
}

// 103 samples of db1 at level 3: the last of 13 values has 7 of its 8 samples; of 97 it has one.
TEST(LowBand, ValueMostlyBeyondTheEndIsUnmeasured) {
  EXPECT_THAT(LowBand({"db1", 3, Boundary::symmetric}, uniform(103)).unmeasured(),
              testing::IsEmpty());
  EXPECT_THAT(LowBand({"db1", 3, Boundary::symmetric}, uniform(97)).unmeasured(),
              testing::ElementsAre(12));
  EXPECT_THAT(LowBand({"db4", 3, Boundary::periodization}, uniform(96)).unmeasured(),
              testing::IsEmpty());
}

// The ends of a long signal are found on a short one with the same ends.
TEST(LowBand, UnmeasuredValuesDoNotDependOnTheLength) {
  for (const std::size_t n : {0, 1, 5, 7}) {
    const LowBand one({"db4", 3, Boundary::symmetric}, uniform(248 + n)),
        longer({"db4", 3, Boundary::symmetric}, uniform(2480 + n));
    std::vector<Eigen::Index> from_end, of_longer;
    for (const Eigen::Index j : one.unmeasured())
      from_end.push_back(2 * j < one.values() ? j : j - one.values());
    for (const Eigen::Index j : longer.unmeasured())
      of_longer.push_back(2 * j < longer.values() ? j : j - longer.values());
    EXPECT_EQ(from_end, of_longer) << n;
  }
}

TEST(LowBand, ReconstructsTheApproximationAtFullLength) {
  const std::vector<double> signal = white_noise(333, "low band");
  const LowBand low_band({"db4", 3, Boundary::symmetric}, uniform(333));
  const Bands bands = reconstruct_bands(daubechies("db4"), Boundary::symmetric, 3, signal);
  EXPECT_THAT(low_band.reconstruct(applied(low_band, signal)),
              Pointwise(DoubleNear(1e-14), bands.approximations[2]));  // same sums, other order
}

TEST(LowBand, OfLevelZeroIsTheRawProfileWhateverItsPositions) {
  const std::vector<double> signal = white_noise(50, "raw");
  const LowBand low_band({"db4", 0, Boundary::symmetric}, uneven(50));
  EXPECT_FALSE(low_band.resampled());
  EXPECT_EQ(applied(low_band, signal), signal);
  EXPECT_EQ(low_band.reconstruct(signal), signal);
  EXPECT_EQ(low_band.positions(uneven(50)), uneven(50));
}

TEST(LowBand, ScalesAConstantByRootTwoPerLevel) {
  for (const char* wavelet : {"db1", "db4", "db19"})
    for (const Boundary boundary :
         {Boundary::constant, Boundary::symmetric, Boundary::periodic, Boundary::smooth,
          Boundary::periodization, Boundary::reflect, Boundary::antireflect})
      for (const bool even : {true, false}) {
        const LowBand low_band({wavelet, 5, boundary}, even ? uniform(777) : uneven(777));
        EXPECT_EQ(low_band.resampled(), !even);
        EXPECT_THAT(applied(low_band, std::vector<double>(777, 2.5)),
                    Each(DoubleNear(2.5 * std::pow(2.0, 2.5), 1e-12)));  // 5 levels of 38 products
      }
}

TEST(LowBand, KeepsTheStandardDeviationOfWhiteNoise) {
  constexpr std::size_t kSamples = 64 * 1024;
  const std::vector<double> signal = white_noise(kSamples, "sigma");
  for (const char* wavelet : {"db1", "db4", "db10"}) {
    const LowBand low_band({wavelet, 5, Boundary::periodization}, uniform(kSamples));
    const std::vector<double> low = applied(low_band, signal);
    ASSERT_EQ(low.size(), kSamples / 32);
    const double square = std::inner_product(low.begin(), low.end(), low.begin(), 0.0);
    // Chi-square with 2048 degrees of freedom: relative standard deviation sqrt(2 / 2048) = 0.031;
    // four of them are a false alarm in 16,000.
    EXPECT_NEAR(square / static_cast<double>(low.size()), 1.0, 0.125) << wavelet;
  }
}

TEST(LowBand, IsLinearOnUnevenPositionsToo) {
  const std::vector<double> a = white_noise(500, "a");
  const std::vector<double> b = white_noise(500, "b");
  std::vector<double> sum(500);
  for (std::size_t i = 0; i < 500; ++i) sum[i] = 3.0 * a[i] - 0.5 * b[i];
  for (const auto& positions : {uniform(500), uneven(500)})
    for (const Boundary boundary : {Boundary::symmetric, Boundary::smooth, Boundary::zero}) {
      const LowBand low_band({"db3", 4, boundary}, positions);
      std::vector<double> expected = applied(low_band, a);
      const std::vector<double> low_b = applied(low_band, b);
      for (std::size_t k = 0; k < expected.size(); ++k)
        expected[k] = 3.0 * expected[k] - 0.5 * low_b[k];
      // Rounding of values of some 10, or 1e3 where noise is extrapolated by its last slope.
      EXPECT_THAT(applied(low_band, sum),
                  Pointwise(DoubleNear(1e-14 * std::max(10.0, largest(expected))), expected));
    }
}

TEST(LowBand, AppliesToEveryColumnOfAMatrix) {
  for (const auto& positions : {uniform(200), uneven(200)}) {
    const LowBand low_band({"db2", 3, Boundary::symmetric}, positions);
    Eigen::MatrixXd columns(200, 3);
    for (int j = 0; j < 3; ++j) {
      const std::vector<double> signal = white_noise(200, std::to_string(j));
      columns.col(j) = Eigen::Map<const Eigen::VectorXd>(signal.data(), 200);
    }
    const Eigen::MatrixXd low = low_band.apply(columns);
    ASSERT_EQ(low.rows(), low_band.values());
    for (int j = 0; j < 3; ++j)
      EXPECT_THAT(applied(low_band, white_noise(200, std::to_string(j))),
                  ElementsAreArray(low.col(j).data(), static_cast<std::size_t>(low.rows())));
  }
}

TEST(LowBand, BringsAStraightLineToTheUniformGridExactly) {
  const std::vector<double> positions = uneven(400);
  std::vector<double> grid(400), line(400), on_grid(400);
  for (std::size_t i = 0; i < 400; ++i) {
    grid[i] = positions[0] + static_cast<double>(i) * (positions[399] - positions[0]) / 399.0;
    line[i] = 2.0 + 3.0 * positions[i];
    on_grid[i] = 2.0 + 3.0 * grid[i];
  }
  const LowBandOptions options{"db4", 3, Boundary::symmetric};
  const std::vector<double> expected = applied(LowBand(options, grid), on_grid);
  EXPECT_THAT(applied(LowBand(options, positions), line),
              Pointwise(DoubleNear(1e-12), expected));  // values of some 200
}

TEST(LowBand, ReadsAFallingTraceAsItReadsTheRisingOne) {
  std::vector<double> positions = uneven(300);
  const std::vector<double> signal = white_noise(300, "falling");
  const LowBandOptions options{"db1", 2, Boundary::symmetric};
  const std::vector<double> rising = applied(LowBand(options, positions), signal);
  for (double& position : positions) position = -position;
  const LowBand falling(options, positions);
  EXPECT_TRUE(falling.resampled());
  EXPECT_EQ(applied(falling, signal), rising);
}

TEST(LowBand, TakesStepsOffByAThousandthAsUniform) {
  std::vector<double> positions = uniform(100);
  positions[50] += 0.9e-3 * 0.03;
  EXPECT_FALSE(LowBand({}, positions).resampled());
  positions[50] += 0.2e-3 * 0.03;
  EXPECT_TRUE(LowBand({}, positions).resampled());
}

TEST(LowBand, PositionsOfDb1AreTheMeansOfTheBlocks) {
  const std::vector<double> positions = uniform(64, 0.0, 1.0);
  const LowBand low_band({"db1", 4, Boundary::symmetric}, positions);
  EXPECT_THAT(low_band.positions(positions),
              Pointwise(DoubleNear(1e-13), std::vector{7.5, 23.5, 39.5, 55.5}));
}

TEST(LowBand, PositionsStayWithinTheTrace) {
  for (int i = 0; i <= static_cast<int>(Boundary::antireflect); ++i)
    for (const auto& positions : {uneven(400), uniform(400, 5.0, -0.02)}) {
      const LowBand low_band({"db6", 4, static_cast<Boundary>(i)}, positions);
      const auto [least, largest] = std::minmax(positions.front(), positions.back());
      for (const double position : low_band.positions(positions)) {
        EXPECT_GE(position, least);
        EXPECT_LE(position, largest);
      }
    }
}

TEST(LowBand, RefusesFewerSamplesThanTheLevelNeeds) {
  EXPECT_EQ(message_of<DataError>([] {
              LowBand({"db1", 5, Boundary::symmetric}, uniform(20));
            }),
            "low band: 20 samples, level 5 needs at least 32; accepted: level <= 4");
  EXPECT_EQ(message_of<DataError>([] {
              LowBand({"db1", 0, Boundary::symmetric}, {});
            }),
            "low band: 0 samples; accepted: at least 1");
  EXPECT_THAT(message_of<DataError>([] {
                LowBand({"db1", 200, Boundary::zero}, uniform(20));
              }),
              HasSubstr("accepted: level <= 4"));
  EXPECT_NO_THROW(LowBand({"db19", 5, Boundary::symmetric}, uniform(32)));
}

TEST(LowBand, RefusesALevelBelowZeroAndUnknownWavelets) {
  EXPECT_THROW(LowBand({"db1", -1, Boundary::symmetric}, uniform(20)), UsageError);
  EXPECT_THROW(LowBand({"sym4", 1, Boundary::symmetric}, uniform(20)), UsageError);
}

TEST(LowBand, RefusesPositionsThatTurnBackOrAreNoNumbers) {
  std::vector<double> positions = uniform(20, 0.0, 1.0);
  positions[7] = 6.0;
  EXPECT_EQ(message_of<DataError>([&] {
              LowBand({"db1", 2, Boundary::symmetric}, positions);
            }),
            "low band: position 6 mm of sample 8 after 6 mm; accepted: positions that only rise or "
            "only fall");
  positions[7] = std::nan("");
  EXPECT_THROW(LowBand({"db1", 2, Boundary::symmetric}, positions), DataError);
}

}  // namespace
}  // namespace slideway::low_band_test
