#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <string>
#include <vector>

#include "slideway/machine/lower_body_array.hpp"
#include "slideway/machine/transform.hpp"

/// The lathe as a multi-body system, and what each error of its bodies does to the tool.
///
/// Body 0 is bed, spindle and workpiece, at rest; the tool rides on the last body. Every other body
/// moves along one axis and has six component errors (ISO 230-1: E_XX ... E_CX for a body that
/// moves along X) and, between its lower body and its own motion, a squareness (a constant rotation
/// about Y).
namespace slideway {

enum class Axis { x, y, z };

/// The six component errors of Eq. (2), in the order of ErrorMotion's fields.
enum class Component { x, y, z, alpha, beta, gamma };

struct Body {
  std::string name;
  int lower = 0;  // L(1): index of the adjacent lower body, 0 is the bed
  Axis axis = Axis::x;
};

/// Which lever the angular errors act on (the paper's p_x, Eqs. 9, 14, 15, 16).
enum class Lever {
  paper,  // one p_x = r for every term: all errors sit in one frame, as in Eq. (4)
  split   // rigid-body order: squareness turns the whole travel (lever r), a pitch turns only what
          // the carriage carries (lever: the constant overhang of the tool tip)
};

/// Where the machine stands when it cuts the face at radius r; mm.
struct Pose {
  double radius = 0.0;
  double z = 0.0;
  double overhang = 0.0;  // used by Lever::split only
};

/// Errors of one body at one pose: component errors and the squareness below them.
struct BodyErrors {
  ErrorMotion motion;
  double squareness = 0.0;  // rad, about Y
};

class Machine {
 public:
  /// @param bodies  bodies 1, 2, ...; the tool rides on the last one
  /// @throws UsageError  no body, a lower index out of range, a cycle, a name used twice
  Machine(std::vector<Body> bodies, Lever lever);

  /// The paper's lathe (Fig. 1): x_carriage on the bed, z_carriage with the tool on it.
  static std::vector<Body> paper_lathe();

  [[nodiscard]] const std::vector<Body>& bodies() const { return bodies_; }
  [[nodiscard]] const LowerBodyArray& lower_bodies() const { return lower_bodies_; }
  [[nodiscard]] Lever lever() const { return lever_; }

  /// Index (1, 2, ...) of the body of that name. @throws UsageError listing the names there are.
  [[nodiscard]] int body(const std::string& name) const;

  /// Indices of the bodies on the branch from the bed to the tool that move along the axis.
  [[nodiscard]] std::vector<int> carriages(Axis axis) const;

  /// Volumetric error of Eq. (5), P_A - P, mm, for errors[j-1] of body j, with the exact transforms
  /// of Eq. (2) and the product of Eq. (3).
  [[nodiscard]] Eigen::Vector3d volumetric_error(const Pose& pose,
                                                 std::span<const BodyErrors> errors) const;

  /// The same to first order, Eqs. (4) and (5): linear in the errors.
  [[nodiscard]] Eigen::Vector3d volumetric_error_first_order(
      const Pose& pose, std::span<const BodyErrors> errors) const;

  /// dE_z/d(component) of a body: what its error does to the height of the face, to first order.
  /// mm/mm for translations, mm/rad for rotations. From the chain, not from a formula written
  /// again.
  [[nodiscard]] double height_sensitivity(int body, Component component, const Pose& pose) const;

  /// dE_z/d(squareness) of a body, mm/rad.
  [[nodiscard]] double squareness_sensitivity(int body, const Pose& pose) const;

 private:
  std::vector<Body> bodies_;
  Lever lever_;
  LowerBodyArray lower_bodies_;
};

/// ISO 230-1 name of a component error: error_name(Axis::x, Component::z) is "E_ZX".
std::string error_name(Axis axis, Component component);

}  // namespace slideway
