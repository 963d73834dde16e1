#pragma once

#include <cstddef>
#include <string>

#include "slideway/identify/result.hpp"

namespace slideway {

struct RoundedPair {
  std::string value, uncertainty;
};

/// A value rounded to the place of its uncertainty, which has two significant digits (GUM 7.2.6):
/// rounded(10.05762, 0.027) is "10.058", "0.027". Plain decimals. A value of more than twelve
/// digits beside its uncertainty, or an exact one (uncertainty 0), has twelve significant digits.
/// @throws std::logic_error  one of the two is not finite, or the uncertainty is negative
RoundedPair rounded(double value, double uncertainty);

/// The pair as text: "10.058 ± 0.027", and with a common power of ten where the larger of the two
/// is below 1e-3 or above 1e5: "(2.8000 ± 0.0022)e-06".
/// @throws std::logic_error  as rounded()
std::string with_uncertainty(double value, double uncertainty);

/// How every output writes a result: "2.80 ± 0.20", "2.8 (no uncertainty)", "not determined".
/// @param unit  what it is counted in, in its own unit: 1e-6 writes rad as µrad
std::string value_text(const QuantityValue& result, double unit = 1.0);

/// Whether a result has a finite value and a finite uncertainty.
bool is_known(const QuantityValue& result);

/// `value` with that many digits behind the point (0 or more); never "-0".
/// @throws std::logic_error  it is not finite
std::string fixed_point(double value, int decimals);

/// A probability as JSON has it: none is 0, one that underflows is the smallest normal double.
double written_probability(double p);

/// `value` with that many significant digits, in plain decimals below a million: "1890".
/// @throws std::logic_error  it is not finite
std::string to_digits(double value, int digits);

}  // namespace slideway
