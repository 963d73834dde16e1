#pragma once

#include <Eigen/Core>

#include "slideway/effects/effect.hpp"

namespace slideway {

// A sensitivity of the chain along a face. It is affine in r (the chain is a product of constant
// rotations and one travel), so two evaluations give it everywhere.
struct AlongCut {
  double at_centre = 0.0;
  double per_mm = 0.0;
  double operator()(double r) const { return at_centre + per_mm * r; }
};

template <typename Sensitivity>
AlongCut along_cut(const Setup& setup, Sensitivity&& sensitivity) {
  const auto at = [&](double radius) {
    return sensitivity(Pose{.radius = radius, .z = setup.z_mm, .overhang = setup.overhang_mm});
  };
  const double centre = at(0.0);
  return {centre, at(1.0) - centre};
}

// What a carriage does that follows a locus f(x): it rises by f and pitches by pitch_ratio * f'.
struct CarriageReading {
  AlongCut height;  // d(height of the face)/d(rise)
  AlongCut pitch;   // d(height of the face)/d(pitch)
  double pitch_ratio = 1.0;
};

CarriageReading carriage_reading(const Stations& stations, int body, double pitch_ratio);

// False for the slope of a face: no instrument of the project reads it.
bool sees_carriage(const Setup& setup);

// Fills `out` with what every kind of reading shows of the loci `basis(x, value, slope)`, which
// sets two rows of out.cols() numbers: f_j(x) and f_j'(x).
template <typename Basis>
void fill_from_locus(const Stations& stations, const CarriageReading& reading, Basis&& basis,
                     Eigen::Ref<Eigen::MatrixXd> out) {
  const Setup& setup = stations.setup();
  if (!sees_carriage(setup)) return void(out.setZero());
  Eigen::RowVectorXd value(out.cols());
  Eigen::RowVectorXd slope(out.cols());
  Eigen::RowVectorXd behind(out.cols());
  const double ratio = reading.pitch_ratio;
  for (Eigen::Index i = 0; i < stations.size(); ++i) {
    const double x = stations.slide(i);
    if (setup.quantity == Quantity::slope && setup.base_mm) {
      basis(x - *setup.base_mm / 2.0, behind, slope);
      basis(x + *setup.base_mm / 2.0, value, slope);
      out.row(i) = ratio / *setup.base_mm * (value - behind);
      continue;
    }
    basis(x, value, slope);
    if (setup.quantity == Quantity::slope) {
      out.row(i) = ratio * slope;
    } else if (setup.kind == Kind::slide) {
      out.row(i) = value;
    } else {
      const double r = stations.radius(i);
      out.row(i) = reading.height(r) * value + reading.pitch(r) * ratio * slope;
    }
  }
}

}  // namespace slideway
