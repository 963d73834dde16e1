#include "linear_effect.hpp"

#include <Eigen/Dense>
#include <algorithm>

namespace slideway {

LinearEffect::LinearEffect(Description description, std::vector<Parameter> parameters,
                           ExtendedMatrix parameters_from_amplitudes, std::vector<Shape> shapes)
    : description_(std::move(description)),
      parameters_(std::move(parameters)),
      shapes_(std::move(shapes)),
      map_(std::move(parameters_from_amplitudes)) {}

ParameterValues LinearEffect::parameter_values(const Eigen::VectorXd& amplitudes,
                                               std::span<const double> shape) const {
  const Eigen::Index linear = map_.rows();
  const auto shapes = static_cast<Eigen::Index>(shape.size());
  ParameterValues result;
  result.values.resize(linear + shapes);
  result.values.head(linear) = (map_ * amplitudes.cast<long double>()).cast<double>();
  result.jacobian = Eigen::MatrixXd::Zero(linear + shapes, linear + shapes);
  result.jacobian.topLeftCorner(linear, linear) = map_.cast<double>();
  for (Eigen::Index i = 0; i < shapes; ++i) {
    result.values[linear + i] = shape[i];
    result.jacobian(linear + i, linear + i) = 1.0;
  }
  return result;
}

Eigen::VectorXd LinearEffect::from_parameters(const Eigen::VectorXd& values) const {
  Eigen::VectorXd result = values;
  const Eigen::Matrix<long double, Eigen::Dynamic, 1> linear =
      values.head(map_.rows()).cast<long double>();
  result.head(map_.rows()) = map_.triangularView<Eigen::Upper>().solve(linear).cast<double>();
  return result;
}

std::string power_of_mm(int exponent) {
  if (exponent == 0) return "1";
  return exponent == 1 ? "mm" : "mm^" + std::to_string(exponent);
}

ExtendedMatrix diagonal_map(Eigen::Index size, double unit) {
  return ExtendedMatrix::Identity(size, size) / static_cast<long double>(unit);
}

SingleAmplitude::SingleAmplitude(SingleAmplitudeSpec spec)
    : LinearEffect(spec.description,
                   spec.shape ? std::vector<Parameter>{spec.amplitude, spec.shape->parameter}
                              : std::vector<Parameter>{spec.amplitude},
                   diagonal_map(1, spec.unit),
                   spec.shape ? std::vector<Shape>{spec.shape->shape} : std::vector<Shape>{}),
      spec_(std::move(spec)) {}

std::pair<double, double> SingleAmplitude::search_range(int /*shape*/,
                                                        const Stations& stations) const {
  return within_bounds(spec_.shape->range(stations), spec_.shape->parameter);
}

bool SingleAmplitude::applies_to(const Setup& setup) const { return spec_.applies_to(setup); }

std::vector<std::string> SingleAmplitude::lacking(const Setup& setup) const {
  std::vector<std::string> keys = Effect::lacking(setup);
  if (spec_.needs_cut_radius && !setup.cut_radius_mm) keys.emplace_back("cut_radius_mm");
  return keys;
}

void SingleAmplitude::columns(const Stations& stations, std::span<const double> shape,
                              Eigen::Ref<Eigen::MatrixXd> out) const {
  if (!applies_to(stations.setup())) return void(out.setZero());
  const double p = shape.empty() ? 0.0 : shape[0];
  for (Eigen::Index i = 0; i < stations.size(); ++i)
    out(i, 0) = spec_.value(spec_.reading(stations, i), p);
}

void SingleAmplitude::columns_of_shapes(const Stations& stations,
                                        std::span<const std::vector<double>> shapes,
                                        Eigen::Ref<Eigen::MatrixXd> out) const {
  if (!applies_to(stations.setup())) return void(out.setZero());
  const Eigen::VectorXd q = readings(stations, spec_.reading);
  for (std::size_t s = 0; s < shapes.size(); ++s) {
    const double p = shapes[s].empty() ? 0.0 : shapes[s][0];
    for (Eigen::Index i = 0; i < q.size(); ++i)
      out(i, static_cast<Eigen::Index>(s)) = spec_.value(q[i], p);
  }
}

void SingleAmplitude::derivatives(const Stations& stations, std::span<const double> shape,
                                  Eigen::Ref<Eigen::MatrixXd> out) const {
  if (shape.empty() || shapes()[0].stepwise || !applies_to(stations.setup()))
    return void(out.setZero());
  for (Eigen::Index i = 0; i < stations.size(); ++i)
    out(i, 0) = spec_.shape->derivative(spec_.reading(stations, i), shape[0]);
}

std::pair<double, double> within_bounds(std::pair<double, double> range,
                                        const Parameter& parameter) {
  const double low = std::clamp(range.first, parameter.lower, parameter.upper);
  const double high = std::clamp(range.second, parameter.lower, parameter.upper);
  return {std::min(low, high), std::max(low, high)};
}

}  // namespace slideway
