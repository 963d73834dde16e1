#pragma once

#include <functional>

namespace slideway {

/// Where a function of one number is least between two places, by Brent's method, to a thousandth
/// of their distance. REQUIRES low < high, one minimum between them.
double place_of_minimum(const std::function<double(double)>& function, double low, double high);

}  // namespace slideway
