#include "slideway/signal/decomposition.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "downsample.hpp"
#include "interior_blocks.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/parallel.hpp"
#include "slideway/base/wide.hpp"

namespace slideway {
namespace {

using Index = std::ptrdiff_t;

Decomposition whole_decomposition(const Wavelet& wavelet, Boundary boundary, int levels,
                                  std::span<const double> signal) {
  Decomposition parts;
  parts.details.resize(static_cast<std::size_t>(levels));
  Band low;
  for (Band& detail : parts.details) {
    parts.lengths.push_back(signal.size());
    dwt(wavelet, boundary, signal, low, &detail);
    parts.approximation.swap(low);
    signal = parts.approximation;
  }
  return parts;
}

// The decomposition of a long signal. Near the ends the coefficients are those of the signal
// without its interior. The interior does not depend on the boundary: a part goes through all
// levels while it is in the cache.
class LongTransform {
 public:
  LongTransform(const Wavelet& wavelet, Boundary boundary, int levels,
                std::span<const double> signal)
      : wavelet_(wavelet),
        boundary_(boundary),
        levels_(levels),
        signal_(signal),
        taps_(wavelet.taps()),
        start_(window_start(boundary, taps_)),
        blocks_(taps_, levels, signal.size()) {}

  [[nodiscard]] bool is_long() const {
    return std::ssize(signal_) >= kLong && blocks_.omitted_blocks() > 0;
  }

  [[nodiscard]] Decomposition decomposition() const {
    const Decomposition ends = whole_decomposition(wavelet_, boundary_, levels_,
                                                   blocks_.without_interior(signal_, levels_));

    Decomposition out;
    out.details.resize(ends.details.size());
    for (int j = 1; j <= levels_; ++j) {
      out.lengths.push_back(ends.lengths[j - 1] + (blocks_.omitted_blocks() << (levels_ - j + 1)));
      copy_ends(ends.details[j - 1], levels_ - j, out.details[j - 1]);
    }
    copy_ends(ends.approximation, 0, out.approximation);

    const Index size = std::max<Index>(kPart >> levels_, 4 * taps_);
    const auto count =
        static_cast<std::size_t>(blocks_.total_blocks() - 2 * blocks_.boundary_blocks());
    const auto transform = [&](std::size_t /*task*/, std::size_t begin, std::size_t end) {
      Scratch scratch;
      const Index last = blocks_.boundary_blocks() + static_cast<Index>(end);
      for (Index at = blocks_.boundary_blocks() + static_cast<Index>(begin); at < last; at += size)
        transform_part(at, std::min(last, at + size), scratch, out);
    };
    parallel_parts(count, static_cast<std::size_t>(kPartsOfTask * size), transform);
    return out;
  }

 private:
  static constexpr Index kPart = 4096, kPartsOfTask = 16, kLong = 1 << 16;  // samples

  using Scratch = std::array<Band, 2>;

  // Coefficients of one level, 2^finer of them a block.
  void copy_ends(const Band& ends, int finer, Band& out) const {
    const Index count = blocks_.boundary_blocks() << finer, gap = blocks_.omitted_blocks() << finer;
    out.resize(ends.size() + static_cast<std::size_t>(gap));
    std::copy_n(ends.begin(), count, out.begin());
    const Index behind = (blocks_.total_blocks() - blocks_.boundary_blocks()) << finer;
    std::copy(ends.begin() + (behind - gap), ends.end(), out.begin() + behind);
  }

  // Blocks first ... last - 1. Of level k - 1 the outputs from ... to - 1 of level k need
  // 2 from + start ... 2 (to - 1) + start + taps - 1, which are more than the part's own.
  void transform_part(Index first, Index last, Scratch& scratch, Decomposition& out) const {
    std::array<Index, InteriorBlocks::kMostLevels + 1> from, to;
    from[levels_] = first;
    to[levels_] = last;
    for (int k = levels_; k > 0; --k) {
      from[k - 1] = 2 * from[k] + start_;
      to[k - 1] = 2 * (to[k] - 1) + start_ + taps_;
    }
    const double* x = signal_.data() + from[0];
    for (int k = 1; k <= levels_; ++k) {
      const Index own = first << (levels_ - k), own_end = last << (levels_ - k);
      double* low = out.approximation.data() + first;
      if (k < levels_) {
        scratch[k % 2].resize(static_cast<std::size_t>(to[k] - from[k]));
        low = scratch[k % 2].data();
      }
      const auto filter = [&](Index begin, Index end, double* high) {
        const FilterPair pair{wavelet_.decompose_low.data(),
                              high == nullptr ? nullptr : wavelet_.decompose_high.data(),
                              low + (begin - from[k]), high};
        wide([&] { convolve(pair, taps_, x + 2 * (begin - from[k]), end - begin); });
      };
      filter(from[k], own, nullptr);
      filter(own, own_end, out.details[k - 1].data() + own);
      filter(own_end, to[k], nullptr);
      x = low;
    }
  }

  const Wavelet& wavelet_;
  Boundary boundary_;
  int levels_;
  std::span<const double> signal_;
  Index taps_, start_;
  InteriorBlocks blocks_;
};

}  // namespace

Decomposition decompose(const Wavelet& wavelet, Boundary boundary, int levels,
                        std::span<const double> signal) {
  if (levels < 0)
    throw UsageError("level " + std::to_string(levels) + ": accepted: 0 or a positive number");
  if (levels == 0) return {.approximation = Band(signal.begin(), signal.end())};
  const LongTransform transform(wavelet, boundary, levels, signal);
  return transform.is_long() ? transform.decomposition()
                             : whole_decomposition(wavelet, boundary, levels, signal);
}

}  // namespace slideway
