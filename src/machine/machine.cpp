#include "slideway/machine/machine.hpp"

#include <algorithm>
#include <utility>

#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"

namespace slideway {
namespace {

std::vector<int> lower_of(const std::vector<Body>& bodies) {
  if (bodies.empty()) throw UsageError("machine: no body; at least the one that carries the tool");
  std::vector<int> lower;
  for (const Body& body : bodies) lower.push_back(body.lower);
  return lower;
}

// Branch from the bed to the tool with the nominal motion of every body on it. The frame of a body
// seen from its lower body is  squareness * nominal * error motion.
struct Chain {
  std::vector<int> path;           // bodies in Eq. (3)'s order
  std::vector<Transform> nominal;  // of path[i]
  Eigen::Vector4d tool;            // in the frame of the last body
};

Chain chain_at(const Machine& machine, const Pose& pose) {
  Chain chain;
  chain.path = machine.lower_bodies().path(machine.lower_bodies().size());
  chain.nominal.assign(chain.path.size(), Transform::Identity());
  const bool split = machine.lever() == Lever::split;
  chain.tool << (split ? pose.overhang : pose.radius), 0.0, 0.0, 1.0;
  if (!split) return chain;
  // With several carriages along one axis the lowest of them makes the travel.
  bool x_done = false;
  bool z_done = false;
  for (std::size_t i = 0; i < chain.path.size(); ++i) {
    const Axis axis = machine.bodies()[chain.path[i] - 1].axis;
    if (axis == Axis::x && !std::exchange(x_done, true))
      chain.nominal[i] = translation(pose.radius - pose.overhang, 0.0, 0.0);
    if (axis == Axis::z && !std::exchange(z_done, true))
      chain.nominal[i] = translation(0.0, 0.0, pose.z);
  }
  return chain;
}

Transform squareness_transform(double angle) { return exact_transform({.beta = angle}); }

// What first_order_transform() adds to the identity: linear in the motion.
Transform generator(const ErrorMotion& motion) {
  return first_order_transform(motion) - Transform::Identity();
}

// First-order displacement of the tool by the errors of body path[at]: the nominal product with the
// generators of its errors inserted where the errors sit.
Eigen::Vector3d displacement(const Chain& chain, std::size_t at, const BodyErrors& errors) {
  const Transform squareness = generator({.beta = errors.squareness});
  Eigen::Vector4d point = chain.tool;
  for (std::size_t i = chain.path.size() - 1; i > at; --i) point = chain.nominal[i] * point;
  point = chain.nominal[at] * (generator(errors.motion) * point) +
          squareness * (chain.nominal[at] * point);
  for (std::size_t i = at; i-- > 0;) point = chain.nominal[i] * point;
  return point.head<3>();
}

double height_displacement(const Machine& machine, int body, const Pose& pose,
                           const BodyErrors& errors) {
  const Chain chain = chain_at(machine, pose);
  const auto found = std::find(chain.path.begin(), chain.path.end(), body);
  if (found == chain.path.end()) return 0.0;  // a side branch does not carry the tool
  return displacement(chain, found - chain.path.begin(), errors).z();
}

ErrorMotion unit_motion(Component component) {
  switch (component) {
    case Component::x:
      return {.x = 1.0};
    case Component::y:
      return {.y = 1.0};
    case Component::z:
      return {.z = 1.0};
    case Component::alpha:
      return {.alpha = 1.0};
    case Component::beta:
      return {.beta = 1.0};
    case Component::gamma:
      return {.gamma = 1.0};
  }
  return {};
}

}  // namespace

Machine::Machine(std::vector<Body> bodies, Lever lever)
    : bodies_(std::move(bodies)), lever_(lever), lower_bodies_(lower_of(bodies_)) {
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (bodies_[i].name == bodies_[j].name)
        throw UsageError("machine: bodies " + std::to_string(j + 1) + " and " +
                         std::to_string(i + 1) + " are both named '" + bodies_[i].name +
                         "'; every body needs a name of its own");
}

std::vector<Body> Machine::paper_lathe() {
  return {{"x_carriage", 0, Axis::x}, {"z_carriage", 1, Axis::z}};
}

int Machine::body(const std::string& name) const {
  std::vector<std::string> names;
  for (const Body& body : bodies_) names.push_back(body.name);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw UsageError("machine: no body '" + name + "'" + did_you_mean(name, names) +
                     "; there are " + joined(names));
  return static_cast<int>(found - names.begin()) + 1;
}

std::vector<int> Machine::carriages(Axis axis) const {
  std::vector<int> found;
  for (const int body : lower_bodies_.path(lower_bodies_.size()))
    if (bodies_[body - 1].axis == axis) found.push_back(body);
  return found;
}

Eigen::Vector3d Machine::volumetric_error(const Pose& pose,
                                          std::span<const BodyErrors> errors) const {
  const Chain chain = chain_at(*this, pose);
  Transform actual = Transform::Identity();
  Transform nominal = Transform::Identity();
  for (std::size_t i = 0; i < chain.path.size(); ++i) {
    const BodyErrors& body = errors[chain.path[i] - 1];
    actual = actual * squareness_transform(body.squareness) * chain.nominal[i] *
             exact_transform(body.motion);
    nominal = nominal * chain.nominal[i];
  }
  // The difference of the transforms first: the tool's own coordinates would hide small errors.
  return ((actual - nominal) * chain.tool).head<3>();
}

Eigen::Vector3d Machine::volumetric_error_first_order(const Pose& pose,
                                                      std::span<const BodyErrors> errors) const {
  const Chain chain = chain_at(*this, pose);
  Eigen::Vector3d error = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < chain.path.size(); ++i)
    error += displacement(chain, i, errors[chain.path[i] - 1]);
  return error;
}

double Machine::height_sensitivity(int body, Component component, const Pose& pose) const {
  return height_displacement(*this, body, pose, {.motion = unit_motion(component)});
}

double Machine::squareness_sensitivity(int body, const Pose& pose) const {
  return height_displacement(*this, body, pose, {.motion = {}, .squareness = 1.0});
}

std::string error_name(Axis axis, Component component) {
  constexpr std::string_view kComponents = "XYZABC";
  constexpr std::string_view kAxes = "XYZ";
  return std::string("E_") + kComponents[static_cast<std::size_t>(component)] +
         kAxes[static_cast<std::size_t>(axis)];
}

}  // namespace slideway
