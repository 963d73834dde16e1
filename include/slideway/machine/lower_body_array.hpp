#pragma once

#include <span>
#include <vector>

namespace slideway {

/// Lower-body array of a multi-body system, Eq. (1):
///
///   L^n(j) = L(L^(n-1)(j)),  L^0(j) = j,  L^n(0) = 0
///
/// Body 0 is the inertial body. Any tree is allowed.
class LowerBodyArray {
 public:
  /// @param lower  lower[j-1] = L(j) for j = 1, 2, ...
  /// @throws UsageError  an index out of range, or a cycle (named body by body)
  explicit LowerBodyArray(std::span<const int> lower);

  [[nodiscard]] int size() const { return static_cast<int>(lower_.size()) - 1; }

  /// L^n(j). REQUIRES 0 <= j <= size(), n >= 0.
  [[nodiscard]] int operator()(int j, int n = 1) const;

  /// Bodies on the way from body 0 (left out) up to body k (included), Eq. (3)'s order.
  [[nodiscard]] std::vector<int> path(int k) const;

 private:
  std::vector<int> lower_;  // lower_[0] = 0
};

}  // namespace slideway
