#include "../linear_effect.hpp"
#include "../locus.hpp"
#include "../request.hpp"
#include "../variable_range.hpp"

namespace slideway {
namespace {

Description describe_squareness() {
  return {.name = "squareness",
          .plain_name = "squareness",
          .standard_name =
              "E_B(0C)X, squareness of X motion to the spindle axis average line "
              "(ISO 230-1)",
          .formula = "-Δβxz p_x",
          .source = "Eq. (15)",
          .cause =
              "the X guideway is not at a right angle to the spindle axis: the face becomes a "
              "cone",
          .typical = "5 to 50 µrad on a precision lathe: 50 to 500 nm over a radius of 10 mm",
          .variable = IndependentVariable::radius,
          .confounded_with =
              "the tilt of the trace on a radius; c_1 of vertical_straightness; "
              "linear_drift at one feed",
          .confounded_effects = {"vertical_straightness", "linear_drift"},
          .separated_by =
              "a trace over the full diameter (cone against tilt), a second feed "
              "(linear_drift), cuts from both sides of the axis (the cone changes sign)",
          .motion = MotionError::squareness};
}

class Squareness : public LinearEffect {
 public:
  explicit Squareness(int body)
      : LinearEffect(
            describe_squareness(),
            {{.name = "dbeta_xz", .symbol = "Δβxz", .unit = "rad", .scale = 1e-5, .gauge = 0}},
            diagonal_map(1, 1.0)),
        body_(body) {}

  [[nodiscard]] bool applies_to(const Setup& setup) const override { return is_face_height(setup); }

  void columns(const Stations& stations, std::span<const double> /*shape*/,
               Eigen::Ref<Eigen::MatrixXd> out) const override {
    if (!applies_to(stations.setup())) return void(out.setZero());
    const AlongCut lever = along_cut(stations.setup(), [&](const Pose& pose) {
      return stations.machine().squareness_sensitivity(body_, pose);
    });
    for (Eigen::Index i = 0; i < stations.size(); ++i) out(i, 0) = lever(stations.radius(i));
  }

  void add_body_errors(const Pose& /*pose*/, double /*slide_mm*/, const Eigen::VectorXd& amplitudes,
                       std::span<BodyErrors> errors) const override {
    errors[body_ - 1].squareness += amplitudes[0];
  }

  [[nodiscard]] std::string advice(const UndeterminedPart& part) const override {
    if (!part.others.empty()) return "";
    return "levelling has removed it: trace a full diameter (the squareness comes back as a cone), "
           "or keep the tilt against the spindle axis (free = [\"offset\"])";
  }

 private:
  int body_;
};

}  // namespace

std::unique_ptr<Effect> make_squareness(const Request& request) {
  request.accept_only({"body"});
  return std::make_unique<Squareness>(request.carriage(Axis::x));
}

}  // namespace slideway
