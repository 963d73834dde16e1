#pragma once

#include <stdexcept>

/// Exceptions of the library. Expected outcomes (not converged, rank deficient, inconsistent) are
/// values, never exceptions. Every message is one line: the place, what is wrong, what is accepted.
namespace slideway {

/// A fault of the caller or of the problem file; exit code 2 of the program.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A data file that cannot be read or is invalid; exit code 3.
struct DataError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace slideway
