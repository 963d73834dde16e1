#include "checks.hpp"

#include <algorithm>
#include <cmath>

#include "residual.hpp"
#include "slideway/base/text.hpp"

namespace slideway {
namespace {

/// A good slide: 1 µm of straightness over 200 mm (air-bearing makers' figures).
constexpr double kGoodStraightness = 1.0 * kMicrometre;
constexpr double kGoodTravel = 200.0;
constexpr double kTold = 5.0;          // standard uncertainties
constexpr double kImplausible = 10.0;  // times the good slide's

/// Σ_k p_k x^k and its derivative, from the parameters `prefix`0, 1, ... of a term ("b", "c").
struct Polynomial {
  std::vector<double> coefficients;
  [[nodiscard]] double operator()(double x) const {
    double sum = 0.0;
    for (std::size_t k = coefficients.size(); k-- > 0;) sum = sum * x + coefficients[k];
    return sum;
  }
  [[nodiscard]] double slope(double x) const {
    double sum = 0.0;
    for (std::size_t k = coefficients.size(); k-- > 1;)
      sum = sum * x + static_cast<double>(k) * coefficients[k];
    return sum;
  }
};

const ModelTerm* find_term(const Model& model, const std::string& name) {
  for (const ModelTerm& term : model.terms)
    if (term.name == name) return &term;
  return nullptr;
}

Polynomial polynomial(const ModelTerm* term, const Solution& fit, std::size_t first_power) {
  Polynomial out;
  if (!term) return out;
  out.coefficients.assign(first_power, 0.0);
  for (std::size_t p = 0; p < term->effect->parameters().size(); ++p)
    out.coefficients.push_back(fit.parameters.values[term->first_parameter + p]);
  return out;
}

/// Largest |exact - first order| of the volumetric error's height at the fitted values, mm.
std::optional<double> neglected_height(const Model& model, const Solution& fit) {
  const Polynomial straightness = polynomial(find_term(model, "straightness"), fit, 0);
  const Polynomial vertical = polynomial(find_term(model, "vertical_straightness"), fit, 1);
  const ModelTerm* squareness = find_term(model, "squareness");
  const std::vector<int> x = model.machine.carriages(Axis::x), z = model.machine.carriages(Axis::z);
  std::optional<double> largest;
  for (const Observation* observation : fit.linear.observations) {
    const Setup& setup = observation->profile->setup;
    if (setup.kind != Kind::face || x.empty()) continue;
    const double reach = std::max(std::abs(setup.first_mm - setup.center_mm),
                                  std::abs(setup.last_mm - setup.center_mm));
    for (const double part : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      const Pose pose{part * reach, setup.z_mm, setup.overhang_mm};
      std::vector<BodyErrors> errors(model.machine.bodies().size());
      BodyErrors& carriage = errors[x.front() - 1];
      const double slide = setup.spindle_position_mm + pose.radius;
      carriage.motion.z = straightness(slide);
      carriage.motion.beta = straightness.slope(slide);
      if (squareness) carriage.squareness = fit.parameters.values[squareness->first_parameter];
      if (!z.empty()) errors[z.front() - 1].motion.beta = vertical.slope(setup.z_mm);
      const double gap = model.machine.volumetric_error(pose, errors).z() -
                         model.machine.volumetric_error_first_order(pose, errors).z();
      largest = std::max(largest.value_or(0.0), std::abs(gap));
    }
  }
  return largest;
}

/// Peak to valley of a curve about its least-squares line over [low, high].
double straightness_error(const Polynomial& curve, double low, double high) {
  constexpr int kPoints = 201;
  Eigen::VectorXd x(kPoints), y(kPoints);
  for (int i = 0; i < kPoints; ++i) {
    x[i] = low + (high - low) * i / (kPoints - 1);
    y[i] = curve(x[i]);
  }
  x.array() -= x.mean();
  y.array() -= y.mean();
  y -= x * (x.dot(y) / x.squaredNorm());
  return y.maxCoeff() - y.minCoeff();
}

/// Whether a curvature of the straightness is told from zero.
bool is_curved(const ModelResult& out) {
  return std::any_of(out.parameters.begin(), out.parameters.end(), [](const FittedParameter& p) {
    const bool curvature =
        p.name.starts_with("straightness") && !p.name.ends_with(".b0") && !p.name.ends_with(".b1");
    return curvature && p.value && p.standard_uncertainty &&
           std::abs(*p.value) > kTold * *p.standard_uncertainty;
  });
}

void check_plausibility(const Model& model, const Solution& fit, ModelResult& out) {
  const ModelTerm* term = find_term(model, "straightness");
  const double travel = model.range.slide_max - model.range.slide_min;
  if (!term || !(travel > 0.0)) return;
  bool face = false;
  for (const Observation* observation : fit.linear.observations)
    face = face || observation->profile->setup.kind == Kind::face;
  const double found =
      straightness_error(polynomial(term, fit, 0), model.range.slide_min, model.range.slide_max);
  const double part = travel / kGoodTravel;
  const double good = kGoodStraightness * (part < 1.0 ? part * part : part);
  if (!face || found < kImplausible * good || !is_curved(out)) return;
  out.implausible = "the fitted straightness is " + significant(found / kMicrometre, 2) +
                    " µm over " + significant(travel, 4) +
                    " mm; a slide of 1 µm per 200 mm makes " + significant(good / kMicrometre, 2) +
                    " µm there";
  out.notes.push_back(out.implausible + ": look for another cause before blaming the slide");
}

void explain_scaling(const Solution& fit, ModelResult& out) {
  const bool estimated = std::any_of(fit.noise.begin(), fit.noise.end(),
                                     [](const Noise& noise) { return !noise.declared; });
  const bool correlated = std::any_of(fit.noise.begin(), fit.noise.end(), [](const Noise& noise) {
    return noise.correlation.order() > 0;
  });
  out.notes.emplace_back(
      !estimated ? "uncertainties rest on the declared standard uncertainties, taken as white"
      : correlated
          ? "uncertainties are scaled by the residual and widened for its correlation (AR noise, "
            "restricted likelihood); coverage factors from Student's t for 95.45 %"
          : "uncertainties are scaled by the residual, without a correlation that widens them; "
            "coverage "
            "factors "
            "from Student's t for 95.45 %");
}

void explain_long_correlation(const Solution& fit, ModelResult& out) {
  for (std::size_t i = 0; i < fit.noise.size(); ++i) {
    const Profile& profile = *fit.linear.observations[i]->profile;
    const auto n = static_cast<double>(fit.linear.observations[i]->values.size());
    if (fit.noise[i].correlation.long_run_ratio() >= n)
      out.notes.push_back("profile '" + profile.name +
                          "': the residual is correlated over the whole trace; all its values "
                          "count as one observation, and a slow error that the model lacks would "
                          "look the same");
  }
}

}  // namespace

void add_checks(const Model& model, const Solution& fit, ModelResult& out) {
  if (const std::optional<double> gap = neglected_height(model, fit))
    out.neglected_um = *gap / kMicrometre;
  explain_scaling(fit, out);
  explain_long_correlation(fit, out);
  check_plausibility(model, fit, out);
  for (const Observation& observation : model.observations) {
    if (observation.low_band.resampled())
      out.notes.push_back("profile '" + observation.profile->name +
                          "': positions are not uniform; brought to a uniform grid for the wavelet "
                          "by linear interpolation, the model's columns likewise");
    if (observation.left_out() > 0)
      out.notes.push_back(
          "profile '" + observation.profile->name + "': " + std::to_string(observation.left_out()) +
          " of " + std::to_string(observation.values.size()) +
          " low-band values are left out: more than half of each stands in a gap, or "
          "it lies at a centre the tool's nose does not follow");
  }
}

}  // namespace slideway
