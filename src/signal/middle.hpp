#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "slideway/signal/dwt.hpp"

namespace slideway {

// The middle of a long signal in blocks of 2^L samples: what comes of the ends over L levels, there
// and back, is the same without it.
class Middle {
 public:
  static constexpr std::ptrdiff_t kMostLevels =
      32;  // of a signal of more samples than memory holds

  Middle(std::ptrdiff_t taps, std::ptrdiff_t levels, std::size_t samples)
      : end_(taps + 2),
        blocks_(static_cast<std::ptrdiff_t>(samples) >> std::min(levels, kMostLevels)) {}

  // Blocks that know of an end, and of the whole signal; those left out, none if not positive.
  [[nodiscard]] std::ptrdiff_t end() const { return end_; }
  [[nodiscard]] std::ptrdiff_t blocks() const { return blocks_; }
  [[nodiscard]] std::ptrdiff_t left_out() const { return blocks_ - 4 * end_; }

  // Values without it, of which a block has 2^finer.
  [[nodiscard]] Band shortened(std::span<const double> values, std::ptrdiff_t finer) const {
    const std::ptrdiff_t before = (2 * end_) << finer, gap = left_out() << finer;
    Band out(values.begin(), values.begin() + before);
    out.insert(out.end(), values.begin() + before + gap, values.end());
    return out;
  }

 private:
  std::ptrdiff_t end_, blocks_;
};

}  // namespace slideway
