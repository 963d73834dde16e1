#pragma once

#include <span>
#include <vector>

/// Series reduced for plotting.
namespace slideway {

/// Indices, increasing, of at most `limit` samples of series with common positions: both ends, and
/// in each of equal intervals the minimum and maximum of every series. All indices if there are no
/// more than `limit`. REQUIRES at least one series, all of one length, 2 * #series + 2 <= limit.
std::vector<std::size_t> thinned(const std::vector<std::span<const double>>& series,
                                 std::size_t limit);

/// Minimum and maximum in each of `stretches` equal intervals (of each sample if there are fewer).
struct Envelope {
  std::vector<double> low, high;
};
Envelope envelope(std::span<const double> series, std::size_t stretches);

}  // namespace slideway
