#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "slideway/effects/effect.hpp"
#include "variable_range.hpp"

namespace slideway {

// Extended precision: the change from Legendre polynomials to powers cancels digits.
using ExtendedMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

// An effect whose parameters are an upper triangular matrix times its amplitudes, followed by the
// shape parameters as they are.
class LinearEffect : public Effect {
 public:
  LinearEffect(Description description, std::vector<Parameter> parameters,
               ExtendedMatrix parameters_from_amplitudes, std::vector<Shape> shapes = {});

  [[nodiscard]] const Description& description() const override { return description_; }
  [[nodiscard]] const std::vector<Parameter>& parameters() const override { return parameters_; }
  [[nodiscard]] int amplitudes() const override { return static_cast<int>(map_.cols()); }
  [[nodiscard]] const std::vector<Shape>& shapes() const override { return shapes_; }
  [[nodiscard]] ParameterValues parameter_values(const Eigen::VectorXd& amplitudes,
                                                 std::span<const double> shape) const override;
  [[nodiscard]] Eigen::VectorXd from_parameters(const Eigen::VectorXd& values) const override;

 private:
  Description description_;
  std::vector<Parameter> parameters_;
  std::vector<Shape> shapes_;
  ExtendedMatrix map_;
};

// "mm^-2", "1", "mm"
std::string power_of_mm(int exponent);

// d parameter / d amplitude for an amplitude in mm (rad, ...) and a parameter whose unit is `unit`.
ExtendedMatrix diagonal_map(Eigen::Index size, double unit);

// The one shape parameter of a SingleAmplitude.
struct ShapeSpec {
  Parameter parameter;
  Shape shape;
  double (*derivative)(double q, double shape) = nullptr;  // unless stepwise
  std::pair<double, double> (*range)(const Stations&) = nullptr;
};

struct SingleAmplitudeSpec {
  Description description;
  Parameter amplitude;
  double unit = kMicrometre;  // the unit of the amplitude's parameter in mm, s
  VariableReading reading = nullptr;
  double (*value)(double q, double shape) = [](double q, double) { return q; };
  bool (*applies_to)(const Setup&) = nullptr;
  bool needs_cut_radius = false;
  std::optional<ShapeSpec> shape = std::nullopt;
};

// h = A * value(q; shape) of the independent variable q: one amplitude, at most one shape
// parameter.
class SingleAmplitude : public LinearEffect {
 public:
  explicit SingleAmplitude(SingleAmplitudeSpec spec);

  [[nodiscard]] std::pair<double, double> search_range(int shape,
                                                       const Stations& stations) const override;
  [[nodiscard]] bool applies_to(const Setup& setup) const override;
  [[nodiscard]] std::vector<std::string> lacking(const Setup& setup) const override;
  void columns(const Stations& stations, std::span<const double> shape,
               Eigen::Ref<Eigen::MatrixXd> out) const override;
  void columns_of_shapes(const Stations& stations, std::span<const std::vector<double>> shapes,
                         Eigen::Ref<Eigen::MatrixXd> out) const override;
  void derivatives(const Stations& stations, std::span<const double> shape,
                   Eigen::Ref<Eigen::MatrixXd> out) const override;

 private:
  SingleAmplitudeSpec spec_;
};

// A search range inside the bounds of its parameter, never empty.
std::pair<double, double> within_bounds(std::pair<double, double> range,
                                        const Parameter& parameter);

}  // namespace slideway
