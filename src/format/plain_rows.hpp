#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "fast_number.hpp"

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace slideway {

#ifdef __SSE2__
// A row of numbers between delimiters and nothing else, as instruments write them: read in half the
// time of others, because the ends of all its digits are found at once.
class PlainRow {
 public:
  static constexpr std::ptrdiff_t kBefore = 17, kRoom = 64;  // bytes that are looked at
  static constexpr unsigned kAtOnce = 16;                    // digits

  // REQUIRES kBefore bytes before `at` and kRoom from there on.
  PlainRow(const char* at, char decimal) : row_(at), decimal_(decimal) {
    for (std::size_t part = 0; part < 3; ++part) {
      const __m128i digits_last = _mm_add_epi8(load(at + 16 * part), _mm_set1_epi8(127 - '9'));
      const int others = _mm_movemask_epi8(_mm_cmplt_epi8(digits_last, _mm_set1_epi8(127 - 9)));
      others_ |= static_cast<std::uint64_t>(others) << (16 * part);
    }
  }

  // Reads the next number, which `mark` must follow (a newline after a carriage return too); false
  // if it is not as plain.
  bool read(char mark, double& value) {
    const char* const text = row_ + at_;
    const char* digit = text;
    const std::size_t minus = pass_sign(digit);
    const auto first = static_cast<unsigned>(digit - row_);
    others_ &= others_ - (first - at_);
    unsigned end = next_end(), fraction = 0, count = end - first, unmoved = 2 * kAtOnce;
    if (row_[end] == decimal_) {
      const unsigned point = end;
      others_ &= others_ - 1;
      end = next_end();
      fraction = unmoved = end - point - 1;
      count += fraction;
    }
    const bool is_crlf = mark == '\n' && row_[end] == '\r';
    if (row_[end + (is_crlf ? 1 : 0)] != mark || count == 0) return false;
    others_ &= others_ - 1;
    at_ = end + (is_crlf ? 2 : 1);
    if (count > kAtOnce) return read_long(text, end, count, unmoved, fraction, value);
    const std::uint64_t mantissa = digits(row_ + end, count, unmoved);
    value = kSigns[minus] *
            (mantissa <= kLargestExact
                 ? static_cast<double>(static_cast<std::int64_t>(mantissa)) / kPowersOfTen[fraction]
                 : scaled(mantissa, -static_cast<std::ptrdiff_t>(fraction)));
    return true;
  }
  [[nodiscard]] const char* at() const { return row_ + at_; }

 private:
  static __m128i load(const void* at) { return _mm_loadu_si128(static_cast<const __m128i*>(at)); }
  [[nodiscard]] unsigned next_end() const {
    return static_cast<unsigned>(std::countr_zero(others_));
  }

  // A number of 17 digits and more before `end`, zeros in front too.
  [[gnu::noinline]] bool read_long(const char* text, unsigned end, unsigned count, unsigned unmoved,
                                   unsigned fraction, double& value) const {
    constexpr std::uint64_t kRadix = 10'000'000'000'000'000U;
    const char* const digits_end = row_ + end;
    if (count <= 2 * kAtOnce && fraction <= -kLeastScale) {
      const std::uint64_t before =
          unmoved < kAtOnce ? digits(digits_end - kAtOnce - 1, count - kAtOnce, kAtOnce)
                            : digits(digits_end - kAtOnce, count - kAtOnce, unmoved - kAtOnce);
      if (before < ~std::uint64_t{0} / kRadix) {
        const std::uint64_t mantissa = before * kRadix + digits(digits_end, kAtOnce, unmoved);
        value =
            scaled(mantissa, -static_cast<std::ptrdiff_t>(fraction)) * kSigns[*text == '-' ? 1 : 0];
        return true;
      }
    }
    return read_number(text, row_ + kRoom, decimal_, value) != nullptr;
  }

  // The 1 to 16 digits before `end`, with a mark among them before the last `unmoved`; none if
  // those are as many.
  static std::uint64_t digits(const char* end, unsigned count, unsigned unmoved) {
    static constexpr auto kLast = [] {  // from [n] on: a mask of the last n of 16 bytes
      std::array<unsigned char, 3 * kAtOnce> masks{};
      for (std::size_t i = kAtOnce; i < masks.size(); ++i) masks[i] = 0x0f;
      return masks;
    }();
    const __m128i after = load(&kLast[unmoved]), all = load(&kLast[count]);
    const __m128i bytes = _mm_or_si128(_mm_and_si128(after, load(end - 16)),
                                       _mm_and_si128(_mm_andnot_si128(after, all), load(end - 17)));
    const __m128i used = _mm_and_si128(bytes, all);
    const __m128i tens =
        _mm_mullo_epi16(_mm_and_si128(used, _mm_set1_epi16(0xff)), _mm_set1_epi16(10));
    const __m128i twos = _mm_add_epi16(tens, _mm_srli_epi16(used, 8));
    const __m128i fours = _mm_madd_epi16(twos, _mm_set1_epi32(1 << 16 | 100));
    const __m128i eights =
        _mm_madd_epi16(_mm_packs_epi32(fours, fours), _mm_set1_epi32(1 << 16 | 10000));
    const auto both = static_cast<std::uint64_t>(_mm_cvtsi128_si64(eights));
    return (both & 0xffffffffU) * 100'000'000 + (both >> 32U);
  }

  const char* row_;
  char decimal_;
  unsigned at_ = 0;
  std::uint64_t others_ = ~0ULL << 48U;  // a bit for every byte of the row that is no digit
};
#endif

}  // namespace slideway
