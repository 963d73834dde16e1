#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

namespace slideway {

/// The numbers of a vector, where they lie. REQUIRES it to live as long.
inline std::span<const double> view(const Eigen::VectorXd& values) {
  return {values.data(), static_cast<std::size_t>(values.size())};
}

}  // namespace slideway
