#include "of_face.hpp"

#include <utility>

namespace slideway {

OfFace::OfFace(SingleAmplitudeSpec spec, std::shared_ptr<const FaceSlope> slope,
               DistanceOf distance)
    : SingleAmplitude(std::move(spec)), slope_(std::move(slope)), distance_(distance) {
  if (slope_ && slope_->rms() == 0.0) slope_ = nullptr;
}

void OfFace::columns(const Stations& stations, std::span<const double> shape,
                     Eigen::Ref<Eigen::MatrixXd> out) const {
  SingleAmplitude::columns(stations, shape, out);
  in_proportion(stations, out);
}

void OfFace::columns_of_shapes(const Stations& stations,
                               std::span<const std::vector<double>> shapes,
                               Eigen::Ref<Eigen::MatrixXd> out) const {
  SingleAmplitude::columns_of_shapes(stations, shapes, out);
  in_proportion(stations, out);
}

void OfFace::derivatives(const Stations& stations, std::span<const double> shape,
                         Eigen::Ref<Eigen::MatrixXd> out) const {
  SingleAmplitude::derivatives(stations, shape, out);
  in_proportion(stations, out);
}

ParameterValues OfFace::parameter_values(const Eigen::VectorXd& amplitudes,
                                         std::span<const double> shape) const {
  ParameterValues out = SingleAmplitude::parameter_values(amplitudes, shape);
  if (!slope_) return out;
  const double whole = slope_->rms(), ratio = amplitudes[0] / whole;
  const auto [value, derivative] = distance_(ratio);
  out.values[1] = value;
  out.jacobian.row(1) << derivative / whole, 0.0;
  out.by_slope = Eigen::Vector2d(0.0, -derivative * ratio / whole);
  return out;
}

void OfFace::in_proportion(const Stations& stations, Eigen::Ref<Eigen::MatrixXd> out) const {
  if (!slope_) return;
  const double whole = slope_->rms();
  for (Eigen::Index i = 0; i < stations.size(); ++i)
    out.row(i) *= slope_->at(stations.radius(i)) / whole;
}

}  // namespace slideway
