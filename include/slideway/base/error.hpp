#pragma once

#include <stdexcept>
#include <string>

/// Exceptions of the library. Expected outcomes (not converged, rank deficient, inconsistent) are
/// values, never exceptions. Every message is one line: the place, what is wrong, what is accepted.
namespace slideway {

/// The message as it is up to kLongestMessage bytes, else its two ends: a file may hold a text of
/// any length where a word belongs.
std::string bounded_message(const std::string& message);

inline constexpr std::size_t kLongestMessage = 2000;

/// A fault of the caller or of the problem file; exit code 2 of the program.
struct UsageError : std::runtime_error {
  explicit UsageError(const std::string& what) : std::runtime_error(bounded_message(what)) {}
};

/// A data file that cannot be read or is invalid; exit code 3.
struct DataError : std::runtime_error {
  explicit DataError(const std::string& what) : std::runtime_error(bounded_message(what)) {}
};

}  // namespace slideway
