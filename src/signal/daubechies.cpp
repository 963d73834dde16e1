#include "slideway/signal/daubechies.hpp"

#include <algorithm>
#include <array>
#include <boost/math/filters/daubechies.hpp>
#include <utility>

#include "slideway/base/error.hpp"

namespace slideway {
namespace {

constexpr std::size_t kLargest = 19;

template <unsigned N>
std::vector<double> scaling_filter() {
  const auto taps = boost::math::filters::daubechies_scaling_filter<double, N>();
  return {taps.begin(), taps.end()};
}

template <unsigned... I>
constexpr auto scaling_filters(std::integer_sequence<unsigned, I...>) {
  return std::array{&scaling_filter<I + 1>...};
}

constexpr auto kScalingFilters = scaling_filters(std::make_integer_sequence<unsigned, kLargest>{});

}  // namespace

Wavelet daubechies(std::string_view name) {
  for (std::size_t n = 1; n <= kLargest; ++n) {
    if (name != "db" + std::to_string(n)) continue;
    Wavelet wavelet;
    wavelet.name = name;
    wavelet.reconstruct_low = kScalingFilters[n - 1]();
    const std::vector<double>& low = wavelet.reconstruct_low;
    wavelet.decompose_low.assign(low.rbegin(), low.rend());
    for (std::size_t k = 0; k < low.size(); ++k)
      wavelet.decompose_high.push_back(k % 2 == 0 ? -low[k] : low[k]);
    wavelet.reconstruct_high.assign(wavelet.decompose_high.rbegin(), wavelet.decompose_high.rend());
    return wavelet;
  }
  throw UsageError("wavelet '" + std::string(name) + "' is unknown; accepted: db1 ... db" +
                   std::to_string(kLargest));
}

}  // namespace slideway
