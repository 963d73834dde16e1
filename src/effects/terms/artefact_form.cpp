#include <algorithm>
#include <string>

#include "../linear_effect.hpp"
#include "../locus.hpp"
#include "../request.hpp"
#include "../variable_range.hpp"

namespace slideway {
namespace {

constexpr int kFirst = 2;  // an offset and a tilt are the trace's own

Description describe_artefact_form() {
  return {.name = "artefact_form",
          .plain_name = "form of the artefact",
          .standard_name =
              "straightness deviation of the reference artefact (ISO 230-1, "
              "straightedge method)",
          .formula =
              "±Σ a_k P_k(u), k = 2..n, - where the reading is reversed; P_k Legendre "
              "polynomials, u from -1 to 1 over the travel",
          .source = "ISO 230-1, reversal method",
          .cause =
              "the straightedge that the slide was read against is not straight, or the guide "
              "of the instrument is not",
          .typical = "0.5 to 5 µm over 1 m (granite straightedges)",
          .variable = IndependentVariable::slide,
          .confounded_with = "the straightness of the slide (exactly, without a reversal)",
          .confounded_effects = {"straightness"},
          .separated_by =
              "the same line read again with the straightedge turned over about its "
              "length by 180° (reversed = true): the form of the slide keeps its sign",
          .of_instrument = true};
}

std::vector<Parameter> parameters_of(int degree) {
  std::vector<Parameter> out;
  for (int k = kFirst; k <= degree; ++k) {
    const std::string order = std::to_string(k);
    out.push_back({"a" + order + "_um", "a_" + order, "µm", 0.1});
  }
  return out;
}

class ArtefactForm : public LinearEffect {
 public:
  ArtefactForm(int degree, const TravelRange& range)
      : LinearEffect(describe_artefact_form(), parameters_of(degree),
                     diagonal_map(degree + 1 - kFirst, kMicrometre)),
        centre_((range.slide_min + range.slide_max) / 2.0),
        half_(std::max((range.slide_max - range.slide_min) / 2.0, 1e-9)) {}

  [[nodiscard]] bool applies_to(const Setup& setup) const override {
    return setup.kind == Kind::slide;
  }

  [[nodiscard]] std::vector<std::string> lacking_together(
      const std::vector<const Setup*>& setups) const override {
    return lacking_of_reversal(setups);
  }

  void columns(const Stations& stations, std::span<const double> /*shape*/,
               Eigen::Ref<Eigen::MatrixXd> out) const override {
    if (!applies_to(stations.setup())) return void(out.setZero());
    const auto locus = [this](const Eigen::ArrayXd& x, Eigen::ArrayXXd& value,
                              Eigen::ArrayXXd& slope) { legendre(x, value, slope); };
    fill_from_locus(stations, height_only(), locus, out, kFirst);
    out *= sign_of_instrument(stations.setup());
  }

  [[nodiscard]] std::vector<EffectOptions> hypotheses(
      const EffectOptions* declared) const override {
    if (declared) return {};
    std::vector<EffectOptions> out;
    for (const int degree : {2, 3, 5}) out.push_back({.degree = degree});
    return out;
  }

  [[nodiscard]] double size(const Eigen::VectorXd& values) const override {
    return values.cwiseAbs().maxCoeff();
  }

 private:
  // (k + 1) P_{k+1} = (2k + 1) u P_k - k P_{k-1};  P'_{k+1} = P'_{k-1} + (2k + 1) P_k
  void legendre(const Eigen::ArrayXd& x, Eigen::ArrayXXd& value, Eigen::ArrayXXd& slope) const {
    const Eigen::ArrayXd u = (x - centre_) / half_;
    value.col(0) = 1.0;
    slope.col(0) = 0.0;
    value.col(1) = u;
    slope.col(1) = 1.0 / half_;
    for (Eigen::Index k = 1; k + 1 < value.cols(); ++k) {
      const auto n = static_cast<double>(k);
      value.col(k + 1) = ((2.0 * n + 1.0) * u * value.col(k) - n * value.col(k - 1)) / (n + 1.0);
      slope.col(k + 1) = slope.col(k - 1) + (2.0 * n + 1.0) / half_ * value.col(k);
    }
  }

  double centre_, half_;
};

}  // namespace

std::unique_ptr<Effect> make_artefact_form(const Request& request) {
  request.accept_only({"degree"});
  return std::make_unique<ArtefactForm>(request.degree(kFirst, kMostPolynomialDegree),
                                        request.range);
}

}  // namespace slideway
