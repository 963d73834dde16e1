#include "slideway/effects/effect.hpp"

#include <algorithm>
#include <cmath>

namespace slideway {

double FaceSlope::at(double radius_mm) const {
  const auto last = static_cast<double>(values.size() - 1);
  const double place = std::min(radius_mm / spacing_mm, last);
  const auto below = static_cast<std::size_t>(std::min(std::floor(place), last - 1.0));
  return std::lerp(values[below], values[below + 1], place - static_cast<double>(below));
}

double FaceSlope::rms() const {
  double square = 0.0;
  for (const double value : values) square += value * value;
  return std::sqrt(square / static_cast<double>(values.size()));
}

std::pair<double, double> Effect::search_range(int shape, const Stations& /*stations*/) const {
  const Parameter& parameter = parameters()[shapes()[shape].parameter];
  return {parameter.lower, parameter.upper};
}

double Effect::resolution(int shape, double value, const Stations& stations) const {
  constexpr double kSteps = 40.0;
  const auto [low, high] = search_range(shape, stations);
  return shapes()[shape].logarithmic ? value * std::log(high / low) / kSteps
                                     : (high - low) / kSteps;
}

std::vector<std::string> Effect::lacking(const Setup& setup) const {
  return missing_for(description().variable, setup);
}

std::vector<std::string> Effect::lacking_together(
    const std::vector<const Setup*>& /*setups*/) const {
  return {};
}

std::vector<std::string> Effect::lacking_to_be_told(
    const std::vector<const Setup*>& /*setups*/) const {
  return {};
}

void Effect::columns_of_shapes(const Stations& stations,
                               std::span<const std::vector<double>> shapes,
                               Eigen::Ref<Eigen::MatrixXd> out) const {
  for (std::size_t s = 0; s < shapes.size(); ++s)
    columns(stations, shapes[s],
            out.middleCols(static_cast<Eigen::Index>(s) * amplitudes(), amplitudes()));
}

void Effect::derivatives(const Stations& /*stations*/, std::span<const double> /*shape*/,
                         Eigen::Ref<Eigen::MatrixXd> out) const {
  out.setZero();
}

std::vector<LineBand> Effect::lines(const Stations& /*stations*/,
                                    std::span<const double> /*shape*/) const {
  return {};
}

void Effect::add_body_errors(const Pose& /*pose*/, double /*slide_mm*/,
                             const Eigen::VectorXd& /*amplitudes*/,
                             std::span<BodyErrors> /*errors*/) const {}

std::string Effect::advice(const UndeterminedPart& /*part*/) const { return ""; }

std::vector<EffectOptions> Effect::hypotheses(const EffectOptions* declared) const {
  if (declared) return {};
  return {EffectOptions{}};
}

std::optional<ShownBySamples> Effect::shown_by(const Stations& /*stations*/,
                                               std::span<const double> /*values*/,
                                               double /*significance*/) const {
  return std::nullopt;
}

std::string Effect::fault(const Stations& /*stations*/) const { return ""; }

Departures Effect::departures() const { return {}; }

std::vector<std::string> Effect::lacking_of_machine(const TravelRange& /*range*/) const {
  return {};
}

Eigen::MatrixXd along_slide(const Effect& effect, const Machine& machine, const Eigen::VectorXd& x,
                            Quantity quantity, std::span<const double> shape) {
  Setup setup;
  setup.kind = Kind::slide;
  setup.quantity = quantity;
  setup.first_mm = x.minCoeff();
  setup.last_mm = x.maxCoeff();
  Eigen::MatrixXd columns(x.size(), effect.amplitudes());
  const std::span<const double> positions(x.data(), static_cast<std::size_t>(x.size()));
  effect.columns({positions, setup, machine}, shape, columns);
  return columns;
}

}  // namespace slideway
