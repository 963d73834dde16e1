#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "slideway/base/units.hpp"
#include "slideway/machine/machine.hpp"

namespace slideway {

enum class Kind {
  face,  // a face-turned surface
  slide  // a reading taken along the slide itself
};
enum class Quantity { height, slope };
enum class CutDirection { inward, outward };

/// When the stations of a profile were read; straight between them, constant beyond.
struct ReadingTimes {
  std::vector<double> positions_mm;  // strictly increasing
  std::vector<double> times_s;       // as many, in any order: a reading may run either way, or rest

  [[nodiscard]] double at(double position_mm) const;
};

/// How one profile was cut and measured. Lengths mm, times s.
struct Setup {
  Kind kind = Kind::face;
  Quantity quantity = Quantity::height;
  std::optional<double>
      base_mm;             // slope over a base: foot spacing; the position is the base's centre
  double center_mm = 0.0;  // where the spindle axis lies in the trace
  double spindle_position_mm = 0.0;
  double z_mm = 0.0;
  double overhang_mm = 0.0;
  std::optional<double> feed_mm_per_min;
  std::optional<double> spindle_rpm;
  std::optional<CutDirection> cut_direction;
  std::optional<double>
      cut_radius_mm;  // of a face; set to the largest r of the trace when left out
  double start_s = 0.0;
  std::optional<double> traverse_mm_per_s;
  std::shared_ptr<const ReadingTimes> reading_times;  // null: unknown
  std::optional<double> nose_radius_mm;               // of the tool that cut a face
  bool reversed = false;     // of a slide: what is the instrument's has the other sign
  double azimuth_deg = 0.0;  // of a face: direction of the trace, X > 0, on the workpiece
  double first_mm = 0.0;     // smallest and largest trace position
  double last_mm = 0.0;

  /// f, mm; none where feed or spindle speed is not known.
  [[nodiscard]] std::optional<double> feed_per_revolution() const {
    if (!feed_mm_per_min || !spindle_rpm) return std::nullopt;
    return *feed_mm_per_min / *spindle_rpm;
  }
};

/// Largest amplitude, mm, of a harmonic of the grooves that the nose of a tool leaves, H = f²/(8
/// r_ε) deep: of the first one H/2, that of the wave a stylus makes of ridges as round as the
/// grooves; of the others 8 H/(π h)², twice that of parabolas, as the edge of a tool is convex.
/// None where feed per revolution or nose radius is not known.
std::optional<double> largest_feed_mark(const Setup& setup, int harmonic);

/// Which way the slide travelled: as declared; of a reading along the slide its times say it as
/// well. None where neither does.
std::optional<CutDirection> travel_direction(const Setup& setup);

/// The independent variable of an effect: what its form is a function of, one per kind of cause.
enum class IndependentVariable {
  radius,
  slide,
  time,
  revolution,
  distance,
  trace,
  measuring_time,
  reading_time
};

/// As the literature of the project has it: r x t k s X m t_read.
std::string_view symbol(IndependentVariable variable);

/// Keys of the problem file a profile lacks before that variable is known, e.g.
/// {"feed_mm_per_min", "cut_direction"}; empty if it is known.
std::vector<std::string> missing_for(IndependentVariable variable, const Setup& setup);

/// The samples of a profile (or a part of them) with their independent variables.
///
/// A view: positions and setup must outlive it.
class Stations {
 public:
  Stations(std::span<const double> positions, const Setup& setup, const Machine& machine)
      : positions_(positions), setup_(&setup), machine_(&machine) {}

  [[nodiscard]] Eigen::Index size() const { return static_cast<Eigen::Index>(positions_.size()); }
  [[nodiscard]] const Setup& setup() const { return *setup_; }
  [[nodiscard]] const Machine& machine() const { return *machine_; }
  [[nodiscard]] std::span<const double> positions() const { return positions_; }

  /// X, position in the trace from the spindle axis (face) or from its origin (slide), mm.
  [[nodiscard]] double trace(Eigen::Index i) const {
    return setup_->kind == Kind::face ? positions_[i] - setup_->center_mm : positions_[i];
  }
  /// r = |s - center_mm| of a face; the slide coordinate of a slide reading; mm.
  [[nodiscard]] double radius(Eigen::Index i) const {
    return setup_->kind == Kind::face ? std::abs(trace(i)) : positions_[i];
  }
  /// x, slide coordinate: spindle_position_mm + r of a face; the position of a slide reading; mm.
  [[nodiscard]] double slide(Eigen::Index i) const {
    return setup_->kind == Kind::face ? setup_->spindle_position_mm + radius(i) : positions_[i];
  }
  /// t, machining time, s. REQUIRES missing_for(IndependentVariable::time, setup) empty.
  [[nodiscard]] double time(Eigen::Index i) const;
  /// k = t rpm / 60, revolutions. REQUIRES IndependentVariable::revolution known.
  [[nodiscard]] double revolution(Eigen::Index i) const {
    return time(i) * *setup_->spindle_rpm / kMinute;
  }
  /// s, cutting distance along the spiral, mm: π (R² - r²) / f inward, π r² / f outward, with the
  /// feed per revolution f. REQUIRES IndependentVariable::distance known.
  [[nodiscard]] double distance(Eigen::Index i) const;
  /// m = (X - first) / traverse, s: time on the instrument. REQUIRES
  /// IndependentVariable::measuring_time known.
  [[nodiscard]] double measuring_time(Eigen::Index i) const {
    return (positions_[i] - setup_->first_mm) / *setup_->traverse_mm_per_s;
  }
  /// When the station was read, s of the session's clock. REQUIRES
  /// IndependentVariable::reading_time known.
  [[nodiscard]] double reading_time(Eigen::Index i) const {
    return setup_->reading_times->at(positions_[i]);
  }

 private:
  std::span<const double> positions_;
  const Setup* setup_;
  const Machine* machine_;
};

}  // namespace slideway
