#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "slideway/base/wide.hpp"
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

// The height itself, without a pitch: what is shorter than the carriage lifts it but the pads even
// out most of the slope.
inline CarriageReading height_only() { return {.height = {1.0, 0.0}, .pitch = {0.0, 0.0}}; }

CarriageReading carriage_reading(const Stations& stations, int body, double pitch_ratio);

// False for the slope of a face: no instrument of the project reads it.
bool sees_carriage(const Setup& setup);

// out = a b + c d
inline void sum_of_products(const double* a, const double* b, const double* c, const double* d,
                            Eigen::Index count, double* out) {
  for (Eigen::Index i = 0; i < count; ++i) out[i] = b[i] * a[i] + d[i] * c[i];
}

// Fills `out` with what every kind of reading shows of the loci `basis(x, value, slope)`, which
// sets a column of f_j(x) and one of f_j'(x) for each column of out, and for `unused` before the
// first, at as many x as there are rows.
template <typename Basis>
void fill_from_locus(const Stations& stations, const CarriageReading& reading, Basis&& basis,
                     Eigen::Ref<Eigen::MatrixXd> out, Eigen::Index unused = 0) {
  constexpr Eigen::Index kStrip = 256;  // samples: what the cache holds
  const Setup& setup = stations.setup();
  if (!sees_carriage(setup)) return void(out.setZero());
  const auto along = [](const AlongCut& cut, const Eigen::ArrayXd& r) {
    return cut.at_centre + cut.per_mm * r;
  };
  Eigen::ArrayXd x, r;
  Eigen::ArrayXXd value, slope, behind;
  const double ratio = reading.pitch_ratio;
  for (Eigen::Index first = 0; first < stations.size(); first += kStrip) {
    const Eigen::Index count = std::min(kStrip, stations.size() - first);
    x.resize(count);
    r.resize(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      x[i] = stations.slide(first + i);
      r[i] = stations.radius(first + i);
    }
    for (Eigen::ArrayXXd* each : {&value, &slope, &behind})
      each->resize(count, unused + out.cols());
    auto rows = out.middleRows(first, count).array();
    if (setup.quantity == Quantity::slope && setup.base_mm) {
      basis(Eigen::ArrayXd(x - *setup.base_mm / 2.0), behind, slope);
      basis(Eigen::ArrayXd(x + *setup.base_mm / 2.0), value, slope);
      rows = ratio / *setup.base_mm * (value - behind).rightCols(out.cols());
      continue;
    }
    basis(x, value, slope);
    if (setup.quantity == Quantity::slope) {
      rows = ratio * slope.rightCols(out.cols());
    } else if (setup.kind == Kind::slide) {
      rows = value.rightCols(out.cols());
    } else {
      const Eigen::ArrayXd height = along(reading.height, r);
      const Eigen::ArrayXd pitch = along(reading.pitch, r) * ratio;
      wide([&] {
        for (Eigen::Index j = 0; j < out.cols(); ++j)
          sum_of_products(height.data(), value.col(unused + j).data(), pitch.data(),
                          slope.col(unused + j).data(), count, out.col(j).data() + first);
      });
    }
  }
}

}  // namespace slideway
