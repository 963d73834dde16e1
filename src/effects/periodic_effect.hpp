#pragma once

#include <utility>
#include <vector>

#include "slideway/effects/effect.hpp"
#include "variable_range.hpp"

namespace slideway {

// Two lines this part of a cycle apart over the whole reading are one to a search: the line between
// them loses a tenth of its power at most.
inline constexpr double kCyclesPerStep = 1.0 / 3.0;

struct PeriodicSpec {
  Description description;
  Parameter rate;  // the period, or the number of cycles per unit of the variable
  bool rate_is_period = true;
  VariableReading reading = nullptr;
  std::pair<double, double> (*range)(const Stations&) = nullptr;
  bool (*applies_to)(const Setup&) = is_height;
};

// h = A cos(2πq + φ) with q = v / period or v * frequency, v the variable. The amplitudes are A cos
// φ on cos 2πq and -A sin φ on sin 2πq; the parameters amplitude_um, period or frequency,
// phase_rad.
class PeriodicEffect : public Effect {
 public:
  explicit PeriodicEffect(PeriodicSpec spec);

  [[nodiscard]] const Description& description() const override { return spec_.description; }
  [[nodiscard]] const std::vector<Parameter>& parameters() const override { return parameters_; }
  [[nodiscard]] int amplitudes() const override { return 2; }
  [[nodiscard]] const std::vector<Shape>& shapes() const override { return shapes_; }
  [[nodiscard]] std::pair<double, double> search_range(int shape,
                                                       const Stations& stations) const override;
  [[nodiscard]] double resolution(int shape, double value, const Stations& stations) const override;
  [[nodiscard]] bool applies_to(const Setup& setup) const override;
  void columns(const Stations& stations, std::span<const double> shape,
               Eigen::Ref<Eigen::MatrixXd> out) const override;
  void columns_of_shapes(const Stations& stations, std::span<const std::vector<double>> shapes,
                         Eigen::Ref<Eigen::MatrixXd> out) const override;
  void derivatives(const Stations& stations, std::span<const double> shape,
                   Eigen::Ref<Eigen::MatrixXd> out) const override;
  [[nodiscard]] std::vector<LineBand> lines(const Stations& stations,
                                            std::span<const double> shape) const override;
  [[nodiscard]] ParameterValues parameter_values(const Eigen::VectorXd& amplitudes,
                                                 std::span<const double> shape) const override;
  [[nodiscard]] Eigen::VectorXd from_parameters(const Eigen::VectorXd& values) const override;
  [[nodiscard]] bool linear_parameters() const override { return false; }

 private:
  [[nodiscard]] double cycles(std::span<const double> shape) const;  // per unit of the variable

  PeriodicSpec spec_;
  std::vector<Parameter> parameters_;
  std::vector<Shape> shapes_;
};

// Periods from 4 samples to twice what the profile covers of the variable.
std::pair<double, double> period_range(const Stations& stations, VariableReading reading);

}  // namespace slideway
