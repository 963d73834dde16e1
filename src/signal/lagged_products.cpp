#include "slideway/signal/lagged_products.hpp"

#include <algorithm>
#include <array>

#include "slideway/base/parallel.hpp"
#include "slideway/base/wide.hpp"

namespace slideway {
namespace {

using Index = std::ptrdiff_t;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr Index kMany = 40, kFew = 8;  // lags at once; many keep the processor busy

// out[l] += Σ x_t y_(t+l), t < count
template <Index Lags>
void add_products(const double* x, const double* y, Index count, double* out) {
  std::array<double, Lags> sums{};
  for (Index t = 0; t < count; ++t)
    for (Index l = 0; l < Lags; ++l) sums[l] += x[t] * y[t + l];
  for (Index l = 0; l < Lags; ++l) out[l] += sums[l];
}

double product(std::span<const double> x, std::span<const double> y, Index lag, Index from,
               Index to) {
  double sum = 0.0;
  for (Index t = from; t < to; ++t) sum += x[t] * y[t + lag];
  return sum;
}

Index columns_of(const ColumnParts& parts) {
  Index columns = 0;
  for (const auto& part : parts) columns += part.cols();
  return columns;
}

template <typename Rows>
void set_rows(const ColumnParts& parts, Index first, Rows&& rows) {
  Index column = 0;
  for (const auto& part : parts) {
    rows.middleCols(column, part.cols()) = part.middleRows(first, rows.rows());
    column += part.cols();
  }
}

// Sums of a block of rows, tile by tile: what a tile adds up stays in the registers.
class LaggedGrams {
 public:
  LaggedGrams(const ColumnParts& parts, Index most_lag)
      : parts_(parts),
        most_lag_(most_lag),
        columns_(columns_of(parts)),
        width_((columns_ + kTile - 1) / kTile * kTile),
        block_(RowMajor::Zero(kRows + most_lag, width_)),
        sums_(static_cast<std::size_t>(most_lag) + 1, RowMajor::Zero(width_, width_)) {}

  // The products of rows first ... last - 1 with those before them.
  void add(Index first, Index last) {
    for (; first < last; first += kRows) {
      const Index count = std::min(kRows, last - first);
      set_rows(parts_, first - most_lag_, block_.topLeftCorner(count + most_lag_, columns_));
      const double* now = block_.row(most_lag_).data();
      wide([&] {
        for (Index lag = 0; lag <= most_lag_; ++lag)
          for (Index i = 0; i < width_; i += kTile)
            for (Index j = 0; j < width_; j += kTile)
              add_tile(now + i, now - lag * width_ + j, count, sums_[lag].data() + i * width_ + j);
      });
    }
  }

  [[nodiscard]] Eigen::MatrixXd sum(Index lag) const {
    return sums_[lag].topLeftCorner(columns_, columns_);
  }

 private:
  static constexpr Index kRows = 256;  // that stay in the cache
  static constexpr Index kTile = 4;

  void add_tile(const double* left, const double* right, Index count, double* out) const {
    double sums[kTile][kTile] = {};
    for (Index t = 0; t < count; ++t, left += width_, right += width_)
      for (Index i = 0; i < kTile; ++i)
        for (Index j = 0; j < kTile; ++j) sums[i][j] += left[i] * right[j];
    for (Index i = 0; i < kTile; ++i)
      for (Index j = 0; j < kTile; ++j) out[i * width_ + j] += sums[i][j];
  }

  const ColumnParts& parts_;
  Index most_lag_, columns_, width_;
  RowMajor block_;
  std::vector<RowMajor> sums_;
};

}  // namespace

std::vector<double> lagged_products(std::span<const double> x, std::span<const double> y,
                                    Index first, std::size_t count) {
  constexpr Index kChunk = 4096;  // samples that stay in the cache for all lags
  const Index n = std::ssize(x), lags = static_cast<Index>(count);
  std::vector<double> out((count + kFew - 1) / kFew * kFew);
  const auto from = [](Index lag) { return std::max<Index>(0, -lag); };
  const auto to = [n](Index lag) { return std::max<Index>(0, std::min(n, n - lag)); };
  const auto at_once = [lags](Index l) { return l + kMany <= lags ? kMany : kFew; };
  // What all lags at once have, chunk by chunk; then what is left of each.
  for (Index chunk = 0; chunk < n; chunk += kChunk)
    for (Index l = 0; l < lags; l += at_once(l)) {
      const Index begin = std::max(chunk, from(first + l));
      const Index end = std::min(chunk + kChunk, to(first + l + at_once(l) - 1));
      if (end <= begin) continue;
      const double *const now = &x[begin], *const later = &y[begin + first + l];
      if (at_once(l) == kMany)
        wide([&] { add_products<kMany>(now, later, end - begin, &out[l]); });
      else
        add_products<kFew>(now, later, end - begin, &out[l]);
    }
  for (Index group = 0; group < lags; group += at_once(group)) {
    const Index begin = from(first + group);
    const Index end = std::max(begin, to(first + group + at_once(group) - 1));
    for (Index l = group; l < std::min(lags, group + at_once(group)); ++l) {
      const Index lag = first + l;
      out[l] += product(x, y, lag, from(lag), std::min(begin, to(lag))) +
                product(x, y, lag, std::max(end, from(lag)), to(lag));
    }
  }
  out.resize(count);
  return out;
}

std::vector<Eigen::MatrixXd> lagged_grams(const ColumnParts& parts, Eigen::Index most_lag) {
  constexpr std::size_t kPart = 1 << 14;  // rows that are worth a thread
  const auto count = static_cast<std::size_t>(parts.front().rows() - most_lag);
  std::vector<LaggedGrams> grams(std::max<std::size_t>(1, parts_of(count, kPart)),
                                 LaggedGrams(parts, most_lag));
  parallel_parts(count, kPart, [&](std::size_t part, std::size_t first, std::size_t last) {
    grams[part].add(most_lag + static_cast<Index>(first), most_lag + static_cast<Index>(last));
  });
  std::vector<Eigen::MatrixXd> out;
  for (Index lag = 0; lag <= most_lag; ++lag) {
    out.push_back(grams[0].sum(lag));
    for (std::size_t part = 1; part < grams.size(); ++part) out.back() += grams[part].sum(lag);
  }
  return out;
}

}  // namespace slideway
