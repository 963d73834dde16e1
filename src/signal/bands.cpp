#include "slideway/signal/bands.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>

#include "interior_blocks.hpp"
#include "slideway/base/parallel.hpp"
#include "slideway/base/wide.hpp"
#include "slideway/signal/decomposition.hpp"
#include "upsample.hpp"

namespace slideway {
namespace {

using Index = std::ptrdiff_t;

// Levels of scratch memory that take turns.
using Scratch = std::array<Band, 2>;

// Coefficients of level lengths.size() up to full length, the other filter's being zeros.
void to_full_length(const Wavelet& wavelet, Boundary boundary, std::span<const std::size_t> lengths,
                    std::span<const double> low, std::span<const double> high, Scratch& scratch,
                    Band& band) {
  for (std::size_t j = lengths.size(); j > 0; --j) {
    Band& finer = j == 1 ? band : scratch[j % 2];
    finer.resize(lengths[j - 1]);
    inverse_dwt(wavelet, boundary, low, high, finer);
    low = finer;
    high = {};
  }
}

void resize(Bands& bands, std::size_t levels, std::size_t n) {
  for (auto* each : {&bands.approximations, &bands.details}) {
    each->resize(levels);
    for (Band& band : *each) band.resize(n);
  }
}

Bands whole_bands(const Wavelet& wavelet, Boundary boundary, const Decomposition& parts) {
  Bands bands;
  resize(bands, parts.details.size(), parts.lengths[0]);
  const std::span<const std::size_t> lengths(parts.lengths);
  Scratch scratch;
  to_full_length(wavelet, boundary, lengths, parts.approximation, {}, scratch,
                 bands.approximations.back());
  for (std::size_t j = 0; j < parts.details.size(); ++j)
    to_full_length(wavelet, boundary, lengths.first(j + 1), {}, parts.details[j], scratch,
                   bands.details[j]);
  for (std::size_t j = parts.details.size() - 1; j > 0; --j)  // a_(j-1) = a_j + d_j
    std::ranges::transform(bands.approximations[j], bands.details[j],
                           bands.approximations[j - 1].begin(), std::plus<>());
  return bands;
}

// The bands of a long signal. Near the ends they are those of the signal without its interior. The
// interior does not depend on the boundary: all bands of a part are made while it is in the cache.
class LongSignal {
 public:
  LongSignal(const Wavelet& wavelet, Boundary boundary, const Decomposition& parts)
      : wavelet_(wavelet),
        boundary_(boundary),
        parts_(parts),
        levels_(static_cast<Index>(parts.details.size())),
        half_(wavelet.taps() / 2),
        shift_(upsampling_shift(boundary, half_)),
        blocks_(wavelet.taps(), levels_, parts.lengths[0]) {}

  [[nodiscard]] bool is_long() const { return size() >= kLong && blocks_.omitted_blocks() > 0; }

  [[nodiscard]] Bands bands() const {
    Bands out;
    resize(out, static_cast<std::size_t>(levels_), static_cast<std::size_t>(size()));
    // After the samples that depend on the boundary, at the start of a pair.
    const Index first = (blocks_.boundary_blocks() << levels_) + shift_ % 2;
    const Index count = (size() - 2 * first) / 2 * 2;
    copy_ends(first, first + count, out);
    const auto make = [&](std::size_t /*task*/, std::size_t begin, std::size_t end) {
      Scratch scratch;
      const Index last = first + static_cast<Index>(end);
      for (Index at = first + static_cast<Index>(begin); at < last; at += kPart)
        make_part(at, std::min(last, at + kPart), scratch, out);
    };
    parallel_parts(static_cast<std::size_t>(count), kTask, make);
    return out;
  }

 private:
  static constexpr Index kPart = 1024, kTask = 64 * kPart, kLong = 16 * kPart;  // samples

  [[nodiscard]] Index size() const { return static_cast<Index>(parts_.lengths[0]); }

  void copy_ends(Index first, Index last, Bands& out) const {
    Decomposition parts;
    parts.approximation = blocks_.without_interior(parts_.approximation, 0);
    for (Index j = 1; j <= levels_; ++j) {
      parts.details.push_back(blocks_.without_interior(parts_.details[j - 1], levels_ - j));
      parts.lengths.push_back(
          parts_.lengths[j - 1] -
          static_cast<std::size_t>(blocks_.omitted_blocks() << (levels_ - j + 1)));
    }
    const Bands ends = whole_bands(wavelet_, boundary_, parts);
    const auto copy = [&](const std::vector<Band>& from, std::vector<Band>& to) {
      for (std::size_t j = 0; j < from.size(); ++j) {
        std::copy_n(from[j].begin(), first, to[j].begin());
        std::copy(from[j].end() - (size() - last), from[j].end(), to[j].begin() + last);
      }
    };
    copy(ends.approximations, out.approximations);
    copy(ends.details, out.details);
  }

  void make_part(Index first, Index last, Scratch& scratch, Bands& out) const {
    restore(wavelet_.reconstruct_low, parts_.approximation, levels_, first, last, scratch,
            Set{out.approximations.back().data() + first});
    for (Index j = levels_; j > 0; --j) {
      double* const detail = out.details[j - 1].data() + first;
      const auto put = [&](auto with) {
        restore(wavelet_.reconstruct_high, parts_.details[j - 1], j, first, last, scratch, with);
      };
      if (j > 1)  // a_(j-1) = a_j + d_j
        put(SetAndSum{detail, out.approximations[j - 1].data() + first,
                      out.approximations[j - 2].data() + first});
      else
        put(Set{detail});
    }
  }

  // Puts samples first ... last - 1 of the band that coefficients of a level make. Of level k - 1
  // the samples 2 i - shift and 2 i + 1 - shift need the coefficients i - half + 1 ... i of level
  // k.
  template <typename Put>
  void restore(std::span<const double> filter, std::span<const double> coefficients, Index level,
               Index first, Index last, Scratch& scratch, const Put& put) const {
    std::array<Index, InteriorBlocks::kMostLevels + 1> from, to;
    from[0] = first;
    to[0] = last;
    for (Index k = 1; k <= level; ++k) {
      from[k] = (from[k - 1] + shift_) / 2 - half_ + 1;
      to[k] = (to[k - 1] - 1 + shift_) / 2 + 1;
    }
    const double* c = coefficients.data() + from[level];
    for (Index k = level; k > 1; --k) {
      const Index pair = from[k] + half_ - 1, count = to[k] - pair, begin = 2 * pair - shift_;
      Band& finer = scratch[k % 2];
      finer.resize(static_cast<std::size_t>(2 * count));
      wide([&] { put_pairs(filter, c + half_ - 1, count, Set{finer.data()}); });
      c = finer.data() + (from[k - 1] - begin);
      filter = wavelet_.reconstruct_low;
    }
    wide([&] { put_pairs(filter, c + half_ - 1, (last - first) / 2, put); });
  }

  const Wavelet& wavelet_;
  Boundary boundary_;
  const Decomposition& parts_;
  Index levels_, half_, shift_;
  InteriorBlocks blocks_;
};

}  // namespace

Bands reconstruct_bands(const Wavelet& wavelet, Boundary boundary, int levels,
                        std::span<const double> signal) {
  const Decomposition parts = decompose(wavelet, boundary, levels, signal);
  if (parts.details.empty()) return {};
  const LongSignal long_signal(wavelet, boundary, parts);
  return long_signal.is_long() ? long_signal.bands() : whole_bands(wavelet, boundary, parts);
}

}  // namespace slideway
