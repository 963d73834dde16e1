#include "slideway/machine/transform.hpp"

#include <Eigen/Geometry>

namespace slideway {

Transform exact_transform(const ErrorMotion& motion) {
  const Eigen::Matrix3d rotation = (Eigen::AngleAxisd(motion.alpha, Eigen::Vector3d::UnitX()) *
                                    Eigen::AngleAxisd(motion.beta, Eigen::Vector3d::UnitY()) *
                                    Eigen::AngleAxisd(motion.gamma, Eigen::Vector3d::UnitZ()))
                                       .toRotationMatrix();
  Transform result = Transform::Identity();
  result.topLeftCorner<3, 3>() = rotation;
  return result * translation(motion.x, motion.y, motion.z);
}

Transform first_order_transform(const ErrorMotion& motion) {
  Transform result;
  result << 1.0, -motion.gamma, motion.beta, motion.x,  //
      motion.gamma, 1.0, -motion.alpha, motion.y,       //
      -motion.beta, motion.alpha, 1.0, motion.z,        //
      0.0, 0.0, 0.0, 1.0;
  return result;
}

Transform translation(double x, double y, double z) {
  Transform result = Transform::Identity();
  result.topRightCorner<3, 1>() << x, y, z;
  return result;
}

}  // namespace slideway
