#include "shape_lattice.hpp"

#include <algorithm>

namespace slideway {

ShapeLattice::ShapeLattice(std::vector<std::vector<double>> axes)
    : axes_(std::move(axes)), points_{{}} {
  for (const std::vector<double>& axis : axes_) {
    std::vector<std::vector<double>> longer;
    for (const std::vector<double>& point : points_)
      for (const double value : axis) {
        longer.push_back(point);
        longer.back().push_back(value);
      }
    points_ = std::move(longer);
  }
}

Eigen::Index ShapeLattice::stride(std::size_t axis) const {
  Eigen::Index out = 1;
  for (std::size_t inner = axis + 1; inner < axes_.size(); ++inner) out *= std::ssize(axes_[inner]);
  return out;
}

Eigen::Index ShapeLattice::place(Eigen::Index point, std::size_t axis) const {
  return point / stride(axis) % std::ssize(axes_[axis]);
}

std::pair<double, double> ShapeLattice::neighbours(Eigen::Index point, std::size_t axis) const {
  const std::vector<double>& values = axes_[axis];
  const Eigen::Index at = place(point, axis), last = std::ssize(values) - 1;
  return {values[static_cast<std::size_t>(std::max<Eigen::Index>(at - 1, 0))],
          values[static_cast<std::size_t>(std::min(at + 1, last))]};
}

std::vector<Eigen::Index> ShapeLattice::around(Eigen::Index point) const {
  std::vector<Eigen::Index> out{point};
  for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
    const Eigen::Index at = place(point, axis);
    if (at > 0) out.push_back(point - stride(axis));
    if (at + 1 < std::ssize(axes_[axis])) out.push_back(point + stride(axis));
  }
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<double> ShapeLattice::middle() const {
  std::vector<double> out;
  for (const std::vector<double>& axis : axes_) out.push_back(axis[axis.size() / 2]);
  return out;
}

}  // namespace slideway
