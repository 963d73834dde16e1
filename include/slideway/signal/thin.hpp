#pragma once

#include <span>
#include <vector>

/// Series reduced for plotting.
namespace slideway {

/// Indices, rising, of at most `limit` samples of series that share their positions: from each of
/// equal stretches where every series is lowest and highest, and both ends. All indices where there
/// are no more. REQUIRES at least one series, all of one length, 2 * #series + 2 <= limit.
std::vector<std::size_t> thinned(const std::vector<std::span<const double>>& series,
                                 std::size_t limit);

/// Lowest and highest value of each of `stretches` equal stretches (of each sample where there are
/// fewer).
struct Envelope {
  std::vector<double> low, high;
};
Envelope envelope(std::span<const double> series, std::size_t stretches);

}  // namespace slideway
