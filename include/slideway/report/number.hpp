#pragma once

#include <cstddef>
#include <string>

namespace slideway {

struct RoundedPair {
  std::string value, uncertainty;
};

/// A value rounded to the place of its uncertainty, which has two significant digits (GUM 7.2.6):
/// rounded(10.05762, 0.027) is "10.058", "0.027". Plain decimals; only where the two lie further
/// apart than the digits of a double are both in scientific form. An exact value (uncertainty 0) is
/// written in full.
/// @throws std::logic_error  one of the two is not finite, or the uncertainty is negative
RoundedPair rounded(double value, double uncertainty);

/// The pair as text: "10.058 ± 0.027", and with a common power of ten where the larger of the two
/// is below 1e-3 or above 1e5: "(2.8000 ± 0.0022)e-06".
/// @throws std::logic_error  as rounded()
std::string with_uncertainty(double value, double uncertainty);

/// `value` with that many digits behind the point (0 or more); never "-0".
/// @throws std::logic_error  it is not finite
std::string fixed_point(double value, int decimals);

/// `value` with that many significant digits, in plain decimals below a million: "1890".
/// @throws std::logic_error  it is not finite
std::string to_digits(double value, int digits);

}  // namespace slideway
