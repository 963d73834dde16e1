#pragma once

#include <functional>
#include <span>
#include <vector>

#include "slideway/base/random.hpp"

/// How a face comes about and how it is read, for data whose truth is known.
///
/// This follows the process, not the model of the program under test, and shares no code with it: a
/// tool runs along a spiral in time, every revolution leaves one groove on each half of the face,
/// of overlapping grooves the lowest is left, and a stylus reads the result with its own errors.
/// Effects that are locked to time, to revolutions, to cutting distance or to the slide thus show
/// up where the process puts them, aliasing, feed marks and clipped vibration included.
///
///   r_j = R - f q  (cut inward)  or  f q  (outward),   q = j + 1/2 on the half X < 0
///   z(X) = min_j [ e(tool at groove j) + (|X| - r_j)² / (2 ρ) ]     nose radius ρ, f feed per turn
///
/// Lengths and heights in mm, angles rad, times s.
namespace slideway::turning {

/// Where the tool is, on every clock an error may be locked to.
struct ToolPoint {
  double t = 0.0;  // machining time, s, from Cut::start_s on
  double r = 0.0;  // distance from the spindle axis; below 0 where the tool has passed it
  double x = 0.0;  // coordinate of the slide
  double k = 0.0;  // revolutions of the spindle, t rpm / 60
  double s = 0.0;  // distance cut along the spiral; 0 for slide readings
};

/// Height of the tool tip above its ideal path, mm. It is asked once per groove and in the order of
/// time, so it may carry a state (random_vibration does).
using Error = std::function<double(const ToolPoint&)>;

// --- the machine -----------------------------------------------------------------------------

/// Coefficients of a two-carriage lathe: straightness Σ b_k x^k of the X carriage, Σ c_k z^k of the
/// Z carriage, squareness of the two. The geometry is written out by hand, as the reference for the
/// program's kinematic chain.
struct Carriage {
  std::vector<double> b;    // b_0, b_1, ...
  std::vector<double> c;    // c_0, c_1, ...
  double squareness = 0.0;  // Δβxz, rad
  double z_mm = 0.0;
  double overhang_mm = 0.0;  // from the carriage's reference point to the tool tip, along X
};

/// Σ a_k u^k and its derivative.
double polynomial(std::span<const double> a, double u);
double derivative(std::span<const double> a, double u);

/// Eq. (16) at its word: Σ b_k x^k - (Σ k b_k x^(k-1) + Σ k c_k z^(k-1) + Δβxz) r.
double one_lever(const Carriage& carriage, const ToolPoint& tool);

/// Rigid-body order: the pitch turns the overhang, the squareness the travel:
/// Σ b_k x^k - (Σ k b_k x^(k-1) + Σ k c_k z^(k-1)) overhang - Δβxz r.
double two_levers(const Carriage& carriage, const ToolPoint& tool);

/// A cos(2π hz t + phase).
Error forced_vibration(double amplitude_mm, double hz, double phase = 0.0);

/// Stationary Gaussian vibration, autocorrelation exp(-|Δt| / correlation_s); 0: independent.
Error random_vibration(double standard_deviation_mm, double correlation_s, std::uint64_t seed);

/// Sum of errors, asked in the order given.
Error sum(std::vector<Error> errors);

// --- the cut ---------------------------------------------------------------------------------

struct Cut {
  double radius_mm = 10.0;
  double feed_mm_per_min = 2.0;
  double spindle_rpm = 110.0;
  bool inward = true;
  double nose_radius_mm = 1.0;
  double spindle_position_mm = 0.0;  // slide coordinate of the spindle axis
  double start_s = 0.0;              // clock time at which the cut starts
};

/// A turned face, along one diameter. The tool comes from one revolution outside the cut and leaves
/// it by one (the centre is passed by one feed); the clocks stand still until the cut starts.
class Face {
 public:
  Face(const Cut& cut, const Error& tool_error);

  /// Height at X, mm, where X < 0 is the half opposite the azimuth X > 0 lies on.
  [[nodiscard]] double height(double X) const;

 private:
  struct Half {
    std::vector<double> heights;  // of the grooves, outward
    double first_r = 0.0;
  };
  Half halves_[2];
  double feed_mm_ = 0.0;  // per revolution
  double nose_radius_mm_ = 0.0;
  double lowest_ = 0.0;
};

// --- the instruments -------------------------------------------------------------------------

/// Noise of a reading, in its unit (mm, rad). Correlated part: exp(-|Δs| / correlation_mm).
struct Noise {
  double white = 0.0;
  double correlated = 0.0;
  double correlation_mm = 1.0;
  double quantum = 0.0;  // resolution the reading is rounded to; 0: none
};

/// A profilometer. The datum error is a function of X and of the time on the instrument.
struct Stylus {
  double center_mm = 0.0;  // trace position of the spindle axis
  double traverse_mm_per_s = 0.5;
  double offset_mm = 0.0;
  double tilt = 0.0;
  std::function<double(double X, double m)> datum;
  Noise noise;
};

/// Reads the face at these (increasing) trace positions. mm
std::vector<double> trace(const Face& face, std::span<const double> positions, const Stylus& stylus,
                          RandomStream& random);

/// How the carriage runs while it is read, and what the instrument cannot know.
struct Pass {
  double feed_mm_per_min = 600.0;
  double spindle_rpm = 0.0;
  bool outward = true;  // time runs along increasing position
  double start_s = 0.0;
  double zero = 0.0;  // constant of the instrument, mm or rad
  double tilt = 0.0;  // alignment of an interferometer's axis (heights)
  Noise noise;
};

/// Heights of the slide at these positions, as an interferometer with straightness optics or an
/// indicator on a test bar reads them. mm
std::vector<double> slide_heights(const Error& error, std::span<const double> positions,
                                  const Pass& pass, RandomStream& random);

/// Slopes over a base whose centre stands at these positions, as a bridge mirror before an
/// autocollimator or a level reads them. rad
std::vector<double> slide_slopes(const Error& error, std::span<const double> positions,
                                 double base_mm, const Pass& pass, RandomStream& random);

}  // namespace slideway::turning
