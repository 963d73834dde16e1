#include "slideway/base/minimum.hpp"

#include <boost/math/tools/minima.hpp>

namespace slideway {

double place_of_minimum(const std::function<double(double)>& function, double low, double high) {
  constexpr int kBits = 10;
  return boost::math::tools::brent_find_minima(function, low, high, kBits).first;
}

}  // namespace slideway
