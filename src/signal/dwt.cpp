#include "slideway/signal/dwt.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <type_traits>

#include "downsample.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/wide.hpp"
#include "upsample.hpp"

namespace slideway {
namespace {

using Index = std::ptrdiff_t;

Index floor_mod(Index i, Index period) {
  const Index remainder = i % period;
  return remainder < 0 ? remainder + period : remainder;
}

// The signal gone on beyond its ends, for any index.
class Extension {
 public:
  Extension(std::span<const double> signal, Boundary boundary)
      : x_(signal.data()), n_(std::ssize(signal)), boundary_(boundary) {
    // What reflects about an end sample or goes on by a slope needs two samples.
    const bool needs_two = boundary == Boundary::smooth || boundary == Boundary::reflect ||
                           boundary == Boundary::antireflect;
    if (n_ == 1 && needs_two) boundary_ = Boundary::constant;
  }

  double operator()(Index i) const {
    if (i >= 0 && i < n_) return x_[i];
    switch (boundary_) {
      case Boundary::zero:
        return 0.0;
      case Boundary::constant:
        return x_[i < 0 ? 0 : n_ - 1];
      case Boundary::symmetric:
        return mirrored(i, 1.0);
      case Boundary::antisymmetric:
        return mirrored(i, -1.0);
      case Boundary::periodic:
        return x_[floor_mod(i, n_)];
      case Boundary::periodization:
        return x_[std::min(floor_mod(i, n_ + n_ % 2), n_ - 1)];
      case Boundary::smooth:
        return on_the_slope(i);
      case Boundary::reflect: {
        const Index k = floor_mod(i, 2 * n_ - 2);
        return x_[std::min(k, 2 * n_ - 2 - k)];
      }
      case Boundary::antireflect:
        return turned_about_the_ends(i);
    }
    return 0.0;
  }

 private:
  double mirrored(Index i, double sign) const {
    const Index k = floor_mod(i, 2 * n_);
    return k < n_ ? x_[k] : sign * x_[2 * n_ - 1 - k];
  }

  double on_the_slope(Index i) const {
    if (i < 0) return x_[0] - static_cast<double>(i) * (x_[0] - x_[1]);
    return x_[n_ - 1] + static_cast<double>(i - n_ + 1) * (x_[n_ - 1] - x_[n_ - 2]);
  }

  double turned_about_the_ends(Index i) const {
    const Index period = 2 * n_ - 2;
    const Index k = floor_mod(i, period);
    const double first = x_[0];
    const double last = x_[n_ - 1];
    const double rise = 2.0 * (last - first);
    const Index periods = (i - k) / period;
    return (k < n_ ? x_[k] : 2.0 * last - x_[period - k]) + static_cast<double>(periods) * rise;
  }

  const double* x_;
  Index n_;
  Boundary boundary_;
};

// Both filters, or the low one, and the dyadic decimation. The filters' window of output o is
// x[start + 2 o] onwards; only windows that reach beyond an end ask for the extension.
void downsample(const Wavelet& wavelet, Boundary boundary, std::span<const double> signal,
                Band& low, Band* high) {
  const Index n = std::ssize(signal);
  const Index taps = wavelet.taps();
  low.resize(dwt_length(signal.size(), static_cast<int>(taps), boundary));
  if (high != nullptr) high->resize(low.size());
  const Index count = std::ssize(low);
  const Index start = window_start(boundary, taps);
  const Index first_inside = std::min((1 - start) / 2, count);
  const Index end_inside = std::max(first_inside, (n - taps - start + 2) / 2);
  const auto outputs = [&](Index o) {
    const bool both = high != nullptr;
    return FilterPair{wavelet.decompose_low.data(), both ? wavelet.decompose_high.data() : nullptr,
                      low.data() + o, both ? high->data() + o : nullptr};
  };

  std::vector<double> window(static_cast<std::size_t>(taps));
  const Extension extended(signal, boundary);
  const auto at_an_end = [&](Index o) {
    for (Index k = 0; k < taps; ++k) window[k] = extended(start + 2 * o + k);
    convolve(outputs(o), taps, window.data(), 1);
  };
  for (Index o = 0; o < first_inside; ++o) at_an_end(o);
  if (end_inside > first_inside)
    wide([&] {
      convolve(outputs(first_inside), taps, signal.data() + start + 2 * first_inside,
               end_inside - first_inside);
    });
  for (Index o = end_inside; o < count; ++o) at_an_end(o);
}

// Sets the signal to the dyadic upsampling of c, or adds it. The transform is orthonormal on a
// circle of twice as many samples as coefficients under periodization, hence the indices that wrap
// there.
template <typename Put>
void upsample(std::span<const double> filter, Boundary boundary, std::span<const double> c,
              std::span<double> signal) {
  if (c.empty()) return;
  const Index n = std::ssize(signal);
  const Index size = std::ssize(c);
  const Index half = std::ssize(filter) / 2;
  const bool wraps = boundary == Boundary::periodization;
  const Index shift = upsampling_shift(boundary, half);
  const double* f = filter.data();

  const auto at_an_end = [&](Index m) {
    const Index i = (m + shift) / 2;
    if (std::is_same_v<Put, Set>) signal[m] = 0.0;
    for (Index j = 0; j < half; ++j) {
      const Index k = wraps ? floor_mod(i - j, size) : i - j;
      if (k >= 0 && k < size) signal[m] += f[2 * j + (m + shift) % 2] * c[k];
    }
  };
  const Index first = std::max(half - 1, (shift + 1) / 2);  // whole pairs, no index below 0
  const Index end = std::max(first, std::min(size, (n + shift) / 2));
  for (Index m = 0; m < std::min(n, 2 * first - shift); ++m) at_an_end(m);
  if (end > first)
    wide([&] {
      put_pairs(filter, c.data() + first, end - first, Put{signal.data() + 2 * first - shift});
    });
  for (Index m = 2 * end - shift; m < n; ++m) at_an_end(m);
}

}  // namespace

Boundary boundary(std::string_view name) {
  int index = 0;
  for (std::string_view rest = kBoundaries; !rest.empty(); ++index) {
    const std::string_view word = rest.substr(0, rest.find(' '));
    if (word == name) return static_cast<Boundary>(index);
    rest.remove_prefix(std::min(word.size() + 1, rest.size()));
  }
  throw UsageError("boundary '" + std::string(name) +
                   "' is unknown; accepted: " + std::string(kBoundaries));
}

std::string_view name(Boundary boundary) {
  std::string_view rest = kBoundaries;
  for (int index = static_cast<int>(boundary); index > 0; --index)
    rest.remove_prefix(rest.find(' ') + 1);
  return rest.substr(0, rest.find(' '));
}

std::size_t dwt_length(std::size_t n, int taps, Boundary boundary) {
  if (boundary == Boundary::periodization) return (n + 1) / 2;
  return (n + static_cast<std::size_t>(taps) - 1) / 2;
}

void dwt(const Wavelet& wavelet, Boundary boundary, std::span<const double> signal, Band& low,
         Band* high) {
  if (signal.empty()) throw DataError("signal: 0 samples; accepted: at least 1");
  downsample(wavelet, boundary, signal, low, high);
}

void inverse_dwt(const Wavelet& wavelet, Boundary boundary, std::span<const double> low,
                 std::span<const double> high, std::span<double> signal) {
  if (low.empty() && high.empty()) std::ranges::fill(signal, 0.0);
  upsample<Set>(wavelet.reconstruct_low, boundary, low, signal);
  if (low.empty())
    upsample<Set>(wavelet.reconstruct_high, boundary, high, signal);
  else
    upsample<Add>(wavelet.reconstruct_high, boundary, high, signal);
}

}  // namespace slideway
