#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

namespace slideway {

/// A span over the elements of a vector, which must outlive it.
inline std::span<const double> view(const Eigen::VectorXd& values) {
  return {values.data(), static_cast<std::size_t>(values.size())};
}

}  // namespace slideway
