#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace slideway {

/// Points a search looks at in the space of an effect's shape parameters: the product of one rising
/// axis for each of them, the last one running fastest. Without an axis, one point without shapes.
class ShapeLattice {
 public:
  explicit ShapeLattice(std::vector<std::vector<double>> axes = {});

  [[nodiscard]] const std::vector<std::vector<double>>& axes() const { return axes_; }
  [[nodiscard]] const std::vector<std::vector<double>>& points() const { return points_; }

  /// The values on an axis before and after that of a point; its own at an end.
  [[nodiscard]] std::pair<double, double> neighbours(Eigen::Index point, std::size_t axis) const;

  /// The point and those next to it along every axis, in order.
  [[nodiscard]] std::vector<Eigen::Index> around(Eigen::Index point) const;

  /// The point in the middle of every axis.
  [[nodiscard]] std::vector<double> middle() const;

 private:
  /// How many points an axis advances by from one value to the next, and where a point is on it.
  [[nodiscard]] Eigen::Index stride(std::size_t axis) const;
  [[nodiscard]] Eigen::Index place(Eigen::Index point, std::size_t axis) const;

  std::vector<std::vector<double>> axes_;
  std::vector<std::vector<double>> points_;
};

}  // namespace slideway
