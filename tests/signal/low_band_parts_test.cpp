#include "slideway/signal/low_band_parts.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <string>
#include <vector>

namespace slideway::low_band_parts_test {
namespace {

std::vector<double> uniform(Eigen::Index n) {
  std::vector<double> positions;
  for (Eigen::Index i = 0; i < n; ++i) positions.push_back(0.03 * static_cast<double>(i));
  return positions;
}

double wave(Eigen::Index i, Eigen::Index column) {
  return std::sin(1e-3 * static_cast<double>(i * (column + 1))) + 1e-3 * static_cast<double>(i % 7);
}

void fill(Eigen::Index first, Eigen::Ref<Eigen::MatrixXd> rows) {
  for (Eigen::Index j = 0; j < rows.cols(); ++j)
    for (Eigen::Index i = 0; i < rows.rows(); ++i) rows(i, j) = wave(first + i, j);
}

// Exactly: a part sees the same numbers in the same order as the whole.
TEST(ApplyInParts, IsTheTransformOfTheWholeToTheLastBit) {
  for (const std::string wavelet : {"db1", "db4", "db19"})
    for (const std::string_view boundary :
         {"symmetric", "smooth", "zero", "reflect", "periodic", "periodization", "antireflect"})
      for (const Eigen::Index n : {70'000, 70'001, 70'031, 300'000}) {
        const LowBand low_band({wavelet, 5, slideway::boundary(boundary)}, uniform(n));
        Eigen::MatrixXd whole(n, 2);
        fill(0, whole);
        EXPECT_EQ(apply_in_parts(low_band, n, 2, fill), low_band.apply(whole))
            << wavelet << ' ' << boundary << ' ' << n;
      }
}

TEST(ApplyInParts, TakesNoLevelAndManyLevels) {
  const Eigen::Index n = 80'000;
  const std::vector<double> positions = uniform(n);
  Eigen::MatrixXd whole(n, 1);
  fill(0, whole);
  for (const int level : {0, 1, 10})
    EXPECT_EQ(apply_in_parts(LowBand({"db4", level}, positions), n, 1, fill),
              LowBand({"db4", level}, positions).apply(whole));
}

// Positions that are not uniform, with gaps longer than a part, rising and falling: the same to the
// last bit, and never more samples at once than a part and its start are made of.
TEST(ApplyInParts, BringsPositionsToAGridPartByPart) {
  constexpr Eigen::Index kMostAtOnce = 8192;
  std::vector<double> uneven = uniform(80'000), gaps = uniform(80'000);
  for (double& position : uneven) position += 0.3 * std::sin(position);
  for (std::size_t i = 30'000; i < gaps.size(); ++i) gaps[i] += i < 50'000 ? 240.0 : 240.09;
  std::vector<double> falling = gaps;
  for (double& position : falling) position = -position;
  for (const std::vector<double>& positions : {uneven, gaps, falling}) {
    const LowBand low_band({"db4", 5}, positions);
    ASSERT_TRUE(low_band.resampled());
    std::atomic<Eigen::Index> most = 0;
    const auto watched = [&](Eigen::Index first, Eigen::Ref<Eigen::MatrixXd> rows) {
      Eigen::Index before = most;
      while (before < rows.rows() && !most.compare_exchange_weak(before, rows.rows())) continue;
      fill(first, rows);
    };
    const auto n = std::ssize(positions);
    Eigen::MatrixXd whole(n, 2);
    fill(0, whole);
    EXPECT_EQ(apply_in_parts(low_band, n, 2, watched), low_band.apply(whole));
    EXPECT_LE(most, kMostAtOnce);
  }
}

}  // namespace
}  // namespace slideway::low_band_parts_test
