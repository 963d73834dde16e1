#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace slideway {

// The smallest product of 2, 3 and 5 that is at least so large: a length kissfft transforms fast.
std::size_t fast_length(std::size_t least);

// X_k = Σ_t x_t e^(-2πi k t / n), k = 0 ... n - 1.
std::vector<std::complex<double>> fourier(std::span<const double> values);

}  // namespace slideway
