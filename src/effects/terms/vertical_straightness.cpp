#include <algorithm>
#include <cmath>

#include "../linear_effect.hpp"
#include "../locus.hpp"
#include "../request.hpp"
#include "../variable_range.hpp"

namespace slideway {
namespace {

double reach_of(const TravelRange& range) {
  return std::max({std::abs(range.z_min), std::abs(range.z_max), 1.0});
}

ExtendedMatrix map_of(int degree, double reach) {
  ExtendedMatrix map = ExtendedMatrix::Identity(degree, degree);
  for (int k = 1; k < degree; ++k) map(k, k) = map(k - 1, k - 1) / reach;
  return map;
}

std::vector<Parameter> parameters_of(int degree, double reach) {
  std::vector<Parameter> parameters;
  for (int k = 1; k <= degree; ++k) {
    const std::string index = std::to_string(k);
    parameters.push_back({.name = "c" + index,
                          .symbol = "c_" + index,
                          .unit = power_of_mm(1 - k),
                          .scale = 1e-5 * std::pow(reach, 1 - k),
                          .gauge = 3});
  }
  return parameters;
}

Description describe_vertical_straightness() {
  return {.name = "vertical_straightness",
          .plain_name = "vertical straightness",
          .standard_name = "E_BZ, pitch of Z about Y, from the straightness E_XZ (ISO 230-1)",
          .formula = "-Δβ2(z) p_x with Δβ2(z) = Σ k c_k z^(k-1), k = 1..m",
          .source = "Eqs. (13), (14)",
          .cause =
              "the form of the guideway the Z carriage follows: its slope at the height of the "
              "face tilts the tool",
          .typical = "1 to 50 µrad over the Z travel",
          .variable = IndependentVariable::radius,
          .confounded_with =
              "squareness: at one z level only Σ k c_k z^(k-1) + Δβxz is seen, and "
              "c_1 and Δβxz are one column at any number of levels (one lever)",
          .confounded_effects = {"squareness"},
          .separated_by =
              "faces at m or more z levels for c_2 .. c_m; the split lever with two "
              "overhangs, or a direct measurement of one of the two, for c_1",
          .motion = MotionError::vertical_straightness};
}

// c_1..c_m of Eq. (13); inside, powers of z over the largest |z| there is.
class VerticalStraightness : public LinearEffect {
 public:
  VerticalStraightness(int body, int degree, double reach)
      : LinearEffect(describe_vertical_straightness(), parameters_of(degree, reach),
                     map_of(degree, reach)),
        body_(body),
        reach_(reach) {}

  [[nodiscard]] bool applies_to(const Setup& setup) const override { return is_face_height(setup); }

  void columns(const Stations& stations, std::span<const double> /*shape*/,
               Eigen::Ref<Eigen::MatrixXd> out) const override {
    if (!applies_to(stations.setup())) return void(out.setZero());
    const AlongCut lever = along_cut(stations.setup(), [&](const Pose& pose) {
      return stations.machine().height_sensitivity(body_, Component::beta, pose);
    });
    const Eigen::RowVectorXd pitch = pitch_at(stations.setup().z_mm);
    for (Eigen::Index i = 0; i < stations.size(); ++i)
      out.row(i) = lever(stations.radius(i)) * pitch;
  }

  [[nodiscard]] double size(const Eigen::VectorXd& values) const override {
    double largest = 0.0;
    for (Eigen::Index k = 0; k < values.size(); ++k)
      largest = std::max(largest, std::abs(values[k]) * static_cast<double>(k + 1) *
                                      std::pow(reach_, static_cast<double>(k)));
    return largest;
  }

  void add_body_errors(const Pose& pose, double /*slide_mm*/, const Eigen::VectorXd& amplitudes,
                       std::span<BodyErrors> errors) const override {
    errors[body_ - 1].motion.beta += pitch_at(pose.z).dot(amplitudes);
  }

  [[nodiscard]] std::string advice(const UndeterminedPart& part) const override {
    const bool square = std::ranges::any_of(part.others, [](const Effect* other) {
      return other->description().motion == MotionError::squareness;
    });
    if (square && std::ranges::count(part.own, "c1") > 0)
      return "read Z's straightness along Z, or measure the squareness (Eq. 21); "
             "no face can tell c_1 from the squareness: both make a cone";
    if (square)
      return "cut faces at more Z levels (z_mm): each further level determines one more c_k";
    return "cut faces at more Z levels (z_mm), with an offset that levelling has not removed or "
           "with lever = \"paper\"; read the straightness of the Z carriage along Z";
  }

  // A second degree is the first that a squareness does not make.
  [[nodiscard]] std::vector<EffectOptions> hypotheses(
      const EffectOptions* declared) const override {
    if (declared) return {};
    return {EffectOptions{.degree = 2}};
  }

 private:
  // d pitch / d amplitude: k (z/reach)^(k-1).
  [[nodiscard]] Eigen::RowVectorXd pitch_at(double z) const {
    Eigen::RowVectorXd pitch(amplitudes());
    double power = 1.0;
    for (Eigen::Index k = 0; k < pitch.size(); ++k) {
      pitch[k] = static_cast<double>(k + 1) * power;
      power *= z / reach_;
    }
    return pitch;
  }

  int body_;
  double reach_;
};

}  // namespace

std::unique_ptr<Effect> make_vertical_straightness(const Request& request) {
  request.accept_only({"body", "degree"});
  return std::make_unique<VerticalStraightness>(request.carriage(Axis::z), request.degree(1, 20),
                                                reach_of(request.range));
}

}  // namespace slideway
