#pragma once

#include <span>

namespace slideway {

struct Statistics {
  double mean = 0.0;
  double deviation = 0.0;  // rms about the mean
  double least = 0.0, largest = 0.0;
};

/// Of numbers of any size and count, in parts whose moments are combined (Chan, Golub and LeVeque
/// 1983). REQUIRES at least one.
Statistics statistics_of(std::span<const double> values);

/// The upper of the two in the middle of an even number. They change their order. REQUIRES at least
/// one.
double median(std::span<double> values);

/// Standard deviation of normal values of mean 0, by the median of their sizes: a few may be far
/// larger. REQUIRES at least one.
double deviation_of_most(std::span<const double> values);

}  // namespace slideway
