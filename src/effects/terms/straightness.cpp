#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "../linear_effect.hpp"
#include "../locus.hpp"
#include "../request.hpp"
#include "../straightness_curve.hpp"
#include "slideway/base/wide.hpp"

namespace slideway {
namespace {

// u in [-1, 1] over the slide travel of all profiles.
struct Interval {
  double centre, half;
};

Interval interval_of(const TravelRange& range) {
  const double half = (range.slide_max - range.slide_min) / 2.0;
  return {(range.slide_min + range.slide_max) / 2.0, half > 0.0 ? half : 1.0};
}

// Column k: the coefficients of P_k(u) in powers of x, from
//   (k + 1) P_{k+1} = (2k + 1) u P_k - k P_{k-1}   and   u = (x - centre) / half.
ExtendedMatrix powers_from_legendre(int degree, const Interval& interval) {
  const long double half = interval.half;
  const long double shift = -static_cast<long double>(interval.centre) / half;
  ExtendedMatrix map = ExtendedMatrix::Zero(degree + 1, degree + 1);
  map(0, 0) = 1.0L;
  for (int k = 0; k < degree; ++k) {
    const long double next = k + 1;
    map.col(k + 1) = ((2 * k + 1) * shift / next) * map.col(k);
    map.col(k + 1).tail(degree) += ((2 * k + 1) / (half * next)) * map.col(k).head(degree);
    if (k > 0) map.col(k + 1) -= (k / next) * map.col(k - 1);
  }
  return map;
}

std::vector<Parameter> parameters_of(int first, int degree, const TravelRange& range) {
  std::vector<Parameter> parameters;
  for (int k = first; k <= degree; ++k) parameters.push_back(straightness_parameter(k, range));
  return parameters;
}

Description describe_straightness() {
  return {
      .name = "straightness",
      .plain_name = "straightness",
      .standard_name =
          "E_ZX, straightness error motion of X in the direction Z, with the pitch "
          "E_BX that follows from it (ISO 230-1)",
      .formula = "Δz1(x) - p_x Δz1'(x) with Δz1(x) = Σ b_k x^k, k = 0..n",
      .source = "Eqs. (10), (12), (14)",
      .cause = "the form of the guideway the X carriage follows; its slope pitches the carriage",
      .typical =
          "0.5 to 1 µm over 200 mm on an aerostatic slide: about 10 nm of curvature "
          "within 10 mm of travel, 2 to 10 µm over 600 mm on a conventional bed",
      .variable = IndependentVariable::slide,
      .confounded_with =
          "every smooth effect: b_2 with cup, tool_wear and a slow linear_drift or thermal_drift; "
          "with one lever p_x = x the coefficient b_1 vanishes, and b_0 is the "
          "offset of the trace (both are gauge: the reference line of ISO 230-1)",
      .confounded_effects = {"cup", "tool_wear", "linear_drift", "thermal_drift"},
      .separated_by =
          "a second feed or cutting direction (drift and wear change, straightness "
          "does not), a reading along the slide by autocollimator or straightedge "
          "reversal, a second overhang (pitch against straightness)",
      .motion = MotionError::straightness};
}

// b_first..b_n of Eq. (10); inside, Legendre polynomials over the travel.
class Straightness : public LinearEffect {
 public:
  Straightness(int body, int first, int degree, const TravelRange& range)
      : LinearEffect(describe_straightness(), parameters_of(first, degree, range),
                     powers_from_legendre(degree, interval_of(range))
                         .bottomRightCorner(degree + 1 - first, degree + 1 - first)),
        body_(body),
        first_(first),
        interval_(interval_of(range)) {
    for (int k = 0; k < degree || k == 0; ++k) {
      ahead_.push_back((2.0 * k + 1.0) / (k + 1.0));
      back_.push_back(k / (k + 1.0));
      rise_.push_back((2.0 * k + 1.0) / interval_.half);
    }
  }

  [[nodiscard]] bool applies_to(const Setup& setup) const override { return sees_carriage(setup); }

  void columns(const Stations& stations, std::span<const double> /*shape*/,
               Eigen::Ref<Eigen::MatrixXd> out) const override {
    const auto locus = [this](const Eigen::ArrayXd& x, Eigen::ArrayXXd& value,
                              Eigen::ArrayXXd& slope) { legendre(x, value, slope); };
    fill_from_locus(stations, carriage_reading(stations, body_, 1.0), locus, out, first_);
  }

  void add_body_errors(const Pose& /*pose*/, double slide_mm, const Eigen::VectorXd& amplitudes,
                       std::span<BodyErrors> errors) const override {
    const Eigen::Index count = amplitudes.size();
    Eigen::ArrayXXd value(1, first_ + count), slope(1, first_ + count);
    legendre(Eigen::ArrayXd::Constant(1, slide_mm), value, slope);
    ErrorMotion& motion = errors[body_ - 1].motion;
    motion.z += value.rightCols(count).matrix().row(0).dot(amplitudes);
    motion.beta += slope.rightCols(count).matrix().row(0).dot(amplitudes);
  }

  [[nodiscard]] std::string advice(const UndeterminedPart& part) const override {
    return straightness_advice(*this, part);
  }

  // A higher degree is one more hypothesis each: the search takes the one that pays.
  [[nodiscard]] std::vector<EffectOptions> hypotheses(
      const EffectOptions* declared) const override {
    if (declared && declared->form == Form::curve) return {};
    EffectOptions options = declared ? *declared : EffectOptions{};
    const int known = declared ? *declared->degree : 1;  // b_0 and b_1 are the trace's own
    if (declared) options.above = known;
    std::vector<EffectOptions> out;
    for (const int more : {1, 2, 4, 6}) {
      options.degree = known + more;
      if (*options.degree <= kMostPolynomialDegree) out.push_back(options);
    }
    return out;
  }

  [[nodiscard]] double size(const Eigen::VectorXd& values) const override {
    // Peak of the largest term over the travel: the coefficients have different units.
    const double reach = std::abs(interval_.centre) + interval_.half;
    double largest = 0.0;
    for (Eigen::Index k = 0; k < values.size(); ++k)
      largest =
          std::max(largest, std::abs(values[k]) * std::pow(reach, static_cast<double>(first_ + k)));
    return largest;
  }

 private:
  // Columns of P_k((x - centre)/half) and of their slopes.
  void legendre(const Eigen::ArrayXd& x, Eigen::ArrayXXd& value, Eigen::ArrayXXd& slope) const {
    value.col(0) = 1.0;
    slope.col(0) = 0.0;
    if (value.cols() == 1) return;
    value.col(1) = (x - interval_.centre) / interval_.half;
    slope.col(1) = rise_[0];
    wide([&] {
      for (Eigen::Index k = 1; k + 1 < value.cols(); ++k) add_degree(k, value, slope);
    });
  }

  // Column k + 1 of P_k(u) and of its derivative by x, from those before; u is column 1.
  void add_degree(Eigen::Index k, Eigen::ArrayXXd& value, Eigen::ArrayXXd& slope) const {
    const double ahead = ahead_[k], back = back_[k], rise = rise_[k];
    const double *const u = value.col(1).data(), *const now = value.col(k).data();
    const double *const before = value.col(k - 1).data(), *const sloped = slope.col(k - 1).data();
    double *const next = value.col(k + 1).data(), *const slopes = slope.col(k + 1).data();
    for (Eigen::Index i = 0; i < value.rows(); ++i) {
      next[i] = ahead * u[i] * now[i] - back * before[i];
      slopes[i] = sloped[i] + rise * now[i];
    }
  }

  int body_;
  int first_;
  Interval interval_;
  // Legendre's recurrence: (k+1) P_(k+1) = (2k+1) u P_k - k P_(k-1), and its derivative by x.
  std::vector<double> ahead_, back_, rise_;
};

}  // namespace

std::unique_ptr<Effect> make_straightness(const Request& request) {
  if (request.options.form == Form::curve) {
    request.accept_only({"body", "form", "resolution_mm"});
    return make_curved_straightness(request.carriage(Axis::x), describe_straightness(),
                                    request.options, request.range);
  }
  request.accept_only({"body", "degree", "form"});
  const int first = request.options.above ? *request.options.above + 1 : 0;
  return std::make_unique<Straightness>(request.carriage(Axis::x), first,
                                        request.degree(first, kMostPolynomialDegree),
                                        request.range);
}

}  // namespace slideway
