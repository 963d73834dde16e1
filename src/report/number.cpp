#include "slideway/report/number.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "slideway/base/text.hpp"

namespace slideway {
namespace {

constexpr int kMostDigits = 12;  // of a value; a double carries 15, arithmetic loses some

std::string in_format(double value, std::chars_format format, int precision) {
  std::array<char, 800> buffer{};  // the longest double in fixed form has 309 + 1 + 326 characters
  const auto end =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, format, precision).ptr;
  return {buffer.data(), end};
}

/// Exponent the number has once it is rounded to that many digits behind the leading one.
int exponent_of(double value, int precision) {
  const std::string text = in_format(value, std::chars_format::scientific, precision);
  const char* first = text.data() + text.find('e') + 1;
  if (*first == '+') ++first;
  int exponent = 0;
  std::from_chars(first, text.data() + text.size(), exponent);
  return exponent;
}

/// Rounded to a multiple of 10^place, plain decimals, never "-0".
std::string at_place(double value, int place) {
  if (place > 0) {
    const double unit = std::pow(10.0, place);
    value = std::nearbyint(value / unit) * unit;
  }
  std::string text = in_format(value, std::chars_format::fixed, std::max(0, -place));
  if (text.front() == '-' && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  return text;
}

double scaled(double value, int exponent) {  // powers up to 1e22 are exact, so one rounding only
  return exponent > 0 ? value / std::pow(10.0, exponent) : value * std::pow(10.0, -exponent);
}

std::string joined_pair(const RoundedPair& pair) { return pair.value + " ± " + pair.uncertainty; }

}  // namespace

RoundedPair rounded(double value, double uncertainty) {
  if (!std::isfinite(value) || !std::isfinite(uncertainty) || uncertainty < 0.0)
    throw std::logic_error(
        "rounded: value and uncertainty must be finite, uncertainty not below 0");
  if (uncertainty == 0.0) return {significant(value + 0.0, kMostDigits), "0"};
  const int place = exponent_of(uncertainty, 1) - 1;
  const int leading = value == 0.0 ? place : exponent_of(value, 0);
  if (leading - place >= kMostDigits)
    return {significant(value, kMostDigits),
            in_format(uncertainty, std::chars_format::scientific, 1)};
  if (leading < place - 1) value = 0.0;
  return {at_place(value, place), at_place(uncertainty, place)};
}

bool is_known(const QuantityValue& result) {
  return result.value && std::isfinite(*result.value) && result.expanded_uncertainty &&
         std::isfinite(*result.expanded_uncertainty);
}

std::string value_text(const QuantityValue& result, double unit) {
  const double value = result.value.value_or(NAN) / unit;
  const double uncertainty = std::abs(result.expanded_uncertainty.value_or(NAN)) / unit;
  if (!std::isfinite(value)) return "not determined";
  if (!std::isfinite(uncertainty)) return to_digits(value, 4) + " (no uncertainty)";
  return with_uncertainty(value, uncertainty);
}

std::string fixed_point(double value, int decimals) {
  if (!std::isfinite(value)) throw std::logic_error("fixed_point: the value is not finite");
  return at_place(value, -decimals);
}

double written_probability(double p) { return std::max(p, std::numeric_limits<double>::min()); }

std::string to_digits(double value, int digits) {
  if (!std::isfinite(value)) throw std::logic_error("to_digits: the value is not finite");
  return significant(value + 0.0, digits);  // never "-0"
}

std::string with_uncertainty(double value, double uncertainty) {
  const RoundedPair plain = rounded(value, uncertainty);
  const double magnitude = std::max(std::abs(value), uncertainty);
  if (magnitude == 0.0 || uncertainty == 0.0 || (magnitude >= 1e-3 && magnitude <= 1e5))
    return joined_pair(plain);
  if (plain.uncertainty.find('e') != std::string::npos) return joined_pair(plain);

  const int place = exponent_of(uncertainty, 1) - 1;
  const int digits = exponent_of(magnitude, kMostDigits) - place;  // behind the leading one
  const int exponent = exponent_of(magnitude, std::max(1, digits));
  const std::string power = in_format(std::pow(10.0, exponent), std::chars_format::scientific, 0);
  std::string text = "(";
  text += joined_pair(rounded(scaled(value, exponent), scaled(uncertainty, exponent)));
  text += ")";
  return text + power.substr(1);
}

}  // namespace slideway
