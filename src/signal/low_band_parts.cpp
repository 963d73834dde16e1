#include "slideway/signal/low_band_parts.hpp"

#include <algorithm>
#include <vector>

#include "slideway/base/parallel.hpp"

namespace slideway {
namespace {

// Whether what lies beyond one end follows from the samples next to it.
bool is_local(Boundary boundary) {
  return boundary != Boundary::periodic && boundary != Boundary::periodization &&
         boundary != Boundary::antireflect;
}

// A part of the trace on its way through the levels; what is between takes its memory once.
//
// Of L levels with f taps coefficient j is made of the samples from 2^L j - (f - 2) (2^L - 1) up to
// 2^L (j + 1). A part therefore starts so much earlier, and what its own beginning spoils is
// dropped.
class Part {
 public:
  Part(const LowBand& low_band, const FillColumns& fill)
      : low_band_(low_band),
        wavelet_(daubechies(low_band.options().wavelet)),
        fill_(fill),
        block_(Eigen::Index{1} << low_band.options().level),
        early_(((wavelet_.taps() - 2) * (block_ - 1) + block_ - 1) / block_) {}

  // Coefficients `from` up to `to`.
  void transform(Eigen::Index from, Eigen::Index to, Eigen::MatrixXd& out) {
    const Eigen::Index skip = std::min(from, early_), first = (from - skip) * block_;
    const bool is_last = to == low_band_.values();
    const Eigen::Index points = (is_last ? low_band_.samples() : to * block_) - first;
    const LowBand::Samples samples = low_band_.samples_of(first, points);
    columns_.resize(samples.count, out.cols());
    fill_(samples.first, columns_);
    if (low_band_.resampled()) grid_.resize(static_cast<std::size_t>(points));
    for (Eigen::Index j = 0; j < out.cols(); ++j) {
      std::span<const double> band(columns_.col(j).data(),
                                   static_cast<std::size_t>(columns_.rows()));
      if (low_band_.resampled()) {
        low_band_.bring_to_grid(band, first, grid_);
        band = grid_;
      }
      levels_.resize(static_cast<std::size_t>(low_band_.options().level));
      for (Band& low : levels_) {
        dwt(wavelet_, low_band_.options().boundary, band, low, nullptr);
        band = low;
      }
      const auto count = static_cast<std::size_t>(to - from);
      std::ranges::copy(band.subspan(static_cast<std::size_t>(skip), count),
                        out.col(j).data() + from);
    }
  }

 private:
  const LowBand& low_band_;
  Wavelet wavelet_;
  const FillColumns& fill_;
  Eigen::Index block_, early_;
  Eigen::MatrixXd columns_;
  std::vector<double> grid_;
  std::vector<Band> levels_;
};

}  // namespace

Eigen::MatrixXd apply_in_parts(const LowBand& low_band, Eigen::Index samples, Eigen::Index count,
                               const FillColumns& fill) {
  constexpr Eigen::Index kSamples = 4096, kLeast = 64, kPerTask = 8;
  constexpr Eigen::Index kWhole = 1 << 16;  // samples that gain nothing by parts
  const LowBandOptions& options = low_band.options();
  const Eigen::Index values = low_band.values();
  const Eigen::Index size = std::max(kSamples >> options.level, kLeast);  // coefficients of a part
  const Eigen::Index parts = samples > kWhole && is_local(options.boundary) ? values / size : 0;
  if (parts < 2) {
    Eigen::MatrixXd columns(samples, count);
    fill(0, columns);
    return low_band.apply(columns);
  }
  Eigen::MatrixXd out(values, count);
  const auto transform = [&](std::size_t /*task*/, std::size_t first, std::size_t last) {
    Part part(low_band, fill);
    for (auto i = static_cast<Eigen::Index>(first); i < static_cast<Eigen::Index>(last); ++i)
      part.transform(i * size, i + 1 == parts ? values : (i + 1) * size, out);
  };
  parallel_parts(static_cast<std::size_t>(parts), kPerTask, transform);
  return out;
}

}  // namespace slideway
