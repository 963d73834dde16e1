#pragma once

#include <memory>

#include "linear_effect.hpp"

namespace slideway {

// What a trace beside the centre shows of the face it is on: in proportion to the slope z' of the
// face. Where that is known, the amplitude tells how far the trace is off, and the shape, which
// often no value shows, only how wide the form is.
class OfFace final : public SingleAmplitude {
 public:
  struct Distance {
    double value = 0.0, derivative = 0.0;  // mm, and by its argument
  };
  // How far off the trace is, of amplitude / z'_rms in mm.
  using DistanceOf = Distance (*)(double);

  OfFace(SingleAmplitudeSpec spec, std::shared_ptr<const FaceSlope> slope, DistanceOf distance);

  void columns(const Stations& stations, std::span<const double> shape,
               Eigen::Ref<Eigen::MatrixXd> out) const override;
  void columns_of_shapes(const Stations& stations, std::span<const std::vector<double>> shapes,
                         Eigen::Ref<Eigen::MatrixXd> out) const override;
  void derivatives(const Stations& stations, std::span<const double> shape,
                   Eigen::Ref<Eigen::MatrixXd> out) const override;
  [[nodiscard]] int decisive_parameter() const override { return slope_ ? 1 : 0; }
  [[nodiscard]] ParameterValues parameter_values(const Eigen::VectorXd& amplitudes,
                                                 std::span<const double> shape) const override;

 private:
  void in_proportion(const Stations& stations, Eigen::Ref<Eigen::MatrixXd> out) const;

  std::shared_ptr<const FaceSlope> slope_;
  DistanceOf distance_;
};

}  // namespace slideway
