#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "slideway/signal/dwt.hpp"

namespace slideway {

// A long signal in blocks of 2^L samples. Over L levels, forward and back, the boundary extension
// affects boundary_blocks() at either end only, so that the coefficients near the ends are those of
// the signal without its interior.
class InteriorBlocks {
 public:
  static constexpr std::ptrdiff_t kMostLevels =
      32;  // of a signal of more samples than memory holds

  InteriorBlocks(std::ptrdiff_t taps, std::ptrdiff_t levels, std::size_t samples)
      : boundary_(taps + 2),
        total_(static_cast<std::ptrdiff_t>(samples) >> std::min(levels, kMostLevels)) {}

  [[nodiscard]] std::ptrdiff_t boundary_blocks() const { return boundary_; }
  [[nodiscard]] std::ptrdiff_t total_blocks() const { return total_; }
  // Blocks that without_interior() leaves out; none if not positive.
  [[nodiscard]] std::ptrdiff_t omitted_blocks() const { return total_ - 4 * boundary_; }

  // Values without the interior. A block has 2^finer of them.
  [[nodiscard]] Band without_interior(std::span<const double> values, std::ptrdiff_t finer) const {
    const std::ptrdiff_t before = (2 * boundary_) << finer, gap = omitted_blocks() << finer;
    Band out(values.begin(), values.begin() + before);
    out.insert(out.end(), values.begin() + before + gap, values.end());
    return out;
  }

 private:
  std::ptrdiff_t boundary_, total_;
};

}  // namespace slideway
