#include <algorithm>

#include "../linear_effect.hpp"
#include "../locus.hpp"
#include "../request.hpp"
#include "slideway/base/error.hpp"

namespace slideway {
namespace {

// By Maxwell's and Betti's reciprocity the slope of an elastic beam under a travelling load is half
// the slope of the locus of the load.
constexpr double kPitchOfSag = 0.5;

Description describe_gantry_sag() {
  return {.name = "gantry_sag",
          .plain_name = "sag of the cross-beam",
          .standard_name = "E_ZX and E_BX of X from the elastic deflection of its beam (ISO 230-1)",
          .formula =
              "δ(x) - p_x δ'(x)/2 with δ(x) = A 16 x² (L - x)² / L⁴, L = span_mm; A counts "
              "positive away from the face",
          .source =
              "beam on two supports, load W at x: δ = W x² (L - x)² / (3 E I L); "
              "Maxwell and Betti for the half slope",
          .cause = "the weight of the carriage bends the cross-beam it travels on",
          .typical = "0.1 to 1 µm at mid-span of a 1 m beam; below 15 nm of slope over 10 mm",
          .variable = IndependentVariable::slide,
          .confounded_with = "straightness of degree 4 and above: same locus, twice the pitch",
          .confounded_effects = {"straightness"},
          .separated_by =
              "the ratio of pitch to straightness (half that of a rail), a mass added to "
              "the carriage, a second overhang"};
}

class GantrySag : public LinearEffect {
 public:
  GantrySag(int body, double span)
      : LinearEffect(describe_gantry_sag(), {{"sag_um", "A", "µm", 0.1}},
                     diagonal_map(1, kMicrometre)),
        body_(body),
        span_(span) {}

  [[nodiscard]] bool applies_to(const Setup& setup) const override { return sees_carriage(setup); }

  void columns(const Stations& stations, std::span<const double> /*shape*/,
               Eigen::Ref<Eigen::MatrixXd> out) const override {
    const auto locus = [this](const Eigen::ArrayXd& x, Eigen::ArrayXXd& value,
                              Eigen::ArrayXXd& slope) { sag(x, value, slope); };
    fill_from_locus(stations, carriage_reading(stations, body_, kPitchOfSag), locus, out);
  }

  void add_body_errors(const Pose& /*pose*/, double slide_mm, const Eigen::VectorXd& amplitudes,
                       std::span<BodyErrors> errors) const override {
    Eigen::ArrayXXd value(1, 1), slope(1, 1);
    sag(Eigen::ArrayXd::Constant(1, slide_mm), value, slope);
    errors[body_ - 1].motion.z += value(0, 0) * amplitudes[0];
    errors[body_ - 1].motion.beta += kPitchOfSag * slope(0, 0) * amplitudes[0];
  }

  [[nodiscard]] std::vector<std::string> lacking_of_machine(
      const TravelRange& range) const override {
    if (range.beam_span_mm > 0.0) return {};
    return {"span_mm"};
  }

 private:
  void sag(const Eigen::ArrayXd& x, Eigen::ArrayXXd& value, Eigen::ArrayXXd& slope) const {
    const Eigen::ArrayXd a = (x / span_).max(0.0).min(1.0);  // no beam, no sag outside the span
    value.col(0) = 16.0 * a * a * (1.0 - a) * (1.0 - a);
    slope.col(0) = 32.0 * a * (1.0 - a) * (1.0 - 2.0 * a) / span_;
  }

  int body_;
  double span_;
};

}  // namespace

std::unique_ptr<Effect> make_gantry_sag(const Request& request) {
  request.accept_only({"body", "span_mm"});
  const double span = request.options.span_mm.value_or(request.range.beam_span_mm);
  if (!(span > 0.0))
    throw UsageError("effect " + request.name +
                     ": 'span_mm' is needed, the distance between the supports of the beam; "
                     "accepted: a length above 0");
  return std::make_unique<GantrySag>(request.carriage(Axis::x), span);
}

}  // namespace slideway
