#pragma once

#include <stdexcept>

/// What the library throws. Expected outcomes (not converged, rank deficient, inconsistent) are
/// values, never exceptions. Every message is one line and says where, what is wrong, and what is
/// accepted.
namespace slideway {

/// The caller's or the problem file's fault; the program ends with exit code 2.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A data file that cannot be read or holds what it must not; exit code 3.
struct DataError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace slideway
