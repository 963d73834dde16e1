#include "straightness_curve.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "linear_effect.hpp"
#include "locus.hpp"

namespace slideway {
namespace {

constexpr int kLine = 2;         // b_0 and b_1
constexpr int kOverhanging = 3;  // cubic B-splines beyond one for each piece
constexpr double kMostPieces = 117.0;
constexpr double kPieces = 80.0;  // where no resolution is asked for

// The four cubic B-splines that are not zero at a place u in [0, 1] of a piece, and d/du.
struct Splines {
  double value[4], slope[4];

  explicit Splines(double u)
      : value{std::pow(1.0 - u, 3) / 6.0, (u * u * (3.0 * u - 6.0) + 4.0) / 6.0,
              (u * (u * (3.0 - 3.0 * u) + 3.0) + 1.0) / 6.0, u * u * u / 6.0},
        slope{-0.5 * (1.0 - u) * (1.0 - u), u * (1.5 * u - 2.0), u * (1.0 - 1.5 * u) + 0.5,
              0.5 * u * u} {}
};

class CurvedStraightness : public Effect {
 public:
  CurvedStraightness(int body, Description description, double pieces, const TravelRange& range)
      : description_(std::move(description)),
        parameters_{straightness_parameter(0, range), straightness_parameter(1, range)},
        body_(body),
        first_(range.slide_min),
        step_(std::max(range.slide_max - range.slide_min, 1e-9) / pieces),
        pieces_(static_cast<Eigen::Index>(pieces)) {}

  [[nodiscard]] const Description& description() const override { return description_; }
  [[nodiscard]] const std::vector<Parameter>& parameters() const override { return parameters_; }
  [[nodiscard]] int amplitudes() const override {
    return kLine + static_cast<int>(pieces_) + kOverhanging;
  }
  [[nodiscard]] const std::vector<Shape>& shapes() const override { return shapes_; }
  [[nodiscard]] bool applies_to(const Setup& setup) const override { return sees_carriage(setup); }

  // A B-spline curve whose coefficients are a straight line's values at these places is that line.
  [[nodiscard]] std::optional<Knots> knots() const override {
    const Eigen::Index count = pieces_ + kOverhanging;
    const auto last = static_cast<double>(count - 2);
    return Knots{kLine, first_ + step_ * Eigen::VectorXd::LinSpaced(count, -1.0, last).array()};
  }

  void columns(const Stations& stations, std::span<const double> /*shape*/,
               Eigen::Ref<Eigen::MatrixXd> out) const override {
    const auto locus = [this](const Eigen::ArrayXd& x, Eigen::ArrayXXd& value,
                              Eigen::ArrayXXd& slope) { fill(x, value, slope); };
    fill_from_locus(stations, carriage_reading(stations, body_, 1.0), locus, out);
  }

  void add_body_errors(const Pose& /*pose*/, double slide_mm, const Eigen::VectorXd& amplitudes,
                       std::span<BodyErrors> errors) const override {
    Eigen::ArrayXXd value(1, amplitudes.size()), slope(1, amplitudes.size());
    fill(Eigen::ArrayXd::Constant(1, slide_mm), value, slope);
    ErrorMotion& motion = errors[body_ - 1].motion;
    motion.z += value.matrix().row(0).dot(amplitudes);
    motion.beta += slope.matrix().row(0).dot(amplitudes);
  }

  [[nodiscard]] ParameterValues parameter_values(const Eigen::VectorXd& amplitudes,
                                                 std::span<const double> /*shape*/) const override {
    return {amplitudes.head(kLine), Eigen::MatrixXd::Identity(kLine, amplitudes.size())};
  }

  [[nodiscard]] Eigen::VectorXd from_parameters(const Eigen::VectorXd& values) const override {
    Eigen::VectorXd out = Eigen::VectorXd::Zero(amplitudes());
    out.head(kLine) = values;
    return out;
  }

  [[nodiscard]] std::string advice(const UndeterminedPart& part) const override {
    return straightness_advice(*this, part);
  }

 private:
  void fill(const Eigen::ArrayXd& x, Eigen::ArrayXXd& value, Eigen::ArrayXXd& slope) const {
    value.setZero();
    slope.setZero();
    value.col(0) = 1.0;
    value.col(1) = x;
    slope.col(1) = 1.0;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const double place = (x[i] - first_) / step_;
      const auto piece =
          static_cast<Eigen::Index>(std::clamp(place, 0.0, static_cast<double>(pieces_ - 1)));
      const Splines at(place - static_cast<double>(piece));
      for (Eigen::Index j = 0; j < 4; ++j) {
        value(i, kLine + piece + j) = at.value[j];
        slope(i, kLine + piece + j) = at.slope[j] / step_;
      }
    }
  }

  Description description_;
  std::vector<Parameter> parameters_;
  std::vector<Shape> shapes_;
  int body_;
  double first_, step_;
  Eigen::Index pieces_;
};

bool has(const UndeterminedPart& part, MotionError motion) {
  return std::ranges::any_of(
      part.others, [&](const Effect* other) { return other->description().motion == motion; });
}

}  // namespace

std::unique_ptr<Effect> make_curved_straightness(int body, Description description,
                                                 const EffectOptions& options,
                                                 const TravelRange& range) {
  const double travel = range.slide_max - range.slide_min;
  const double asked = options.resolution_mm ? std::ceil(travel / *options.resolution_mm) : kPieces;
  description.formula =
      "Δz1(x) - p_x Δz1'(x) with Δz1(x) = b_0 + b_1 x + a Gaussian process in x (Matérn), whose "
      "size, length and roughness are estimated with the fit";
  return std::make_unique<CurvedStraightness>(body, std::move(description),
                                              std::clamp(asked, 1.0, kMostPieces), range);
}

Parameter straightness_parameter(int degree, const TravelRange& range) {
  const double reach = std::max({std::abs(range.slide_min), std::abs(range.slide_max), 1.0});
  const std::string index = std::to_string(degree);
  return {.name = "b" + index,
          .symbol = "b_" + index,
          .unit = power_of_mm(1 - degree),
          .scale = kMicrometre * std::pow(reach, -degree),
          .gauge = degree == 0   ? 5
                   : degree == 1 ? 4
                                 : 1,
          .by_convention = degree <= 1};
}

std::string straightness_advice(const Effect& straightness, const UndeterminedPart& part) {
  const auto conventional = [&](const std::string& name) {
    const auto own = std::ranges::find(straightness.parameters(), name, &Parameter::name);
    return own->by_convention;
  };
  if (part.others.empty() && std::ranges::all_of(part.own, conventional))
    return "offset and slope of a straightness are fixed by its reference line (ISO 230-1), not by "
           "these data; no measurement is needed";
  if (has(part, MotionError::vertical_straightness)) return "";  // that has its own advice
  if (has(part, MotionError::squareness))
    return "the squareness is the slope of the face: give the slope of the straightness by a prior "
           "(an autocollimator against the spindle axis), or measure the squareness itself "
           "(run-out, Eq. 21)";
  if (part.model_has_others)
    return "one profile cannot tell them apart: read the straightness along the slide (kind = "
           "\"slide\"), give a prior, or cut with another feed or direction";
  return "";
}

}  // namespace slideway
