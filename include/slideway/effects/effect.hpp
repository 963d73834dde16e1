#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "slideway/profile/setup.hpp"

/// Every error of the machine, the carriage's own and those nobody declared, is an Effect: for the
/// stations of a profile it gives columns, and what it adds to the profile is
///
///   h(i) = Σ_j  column_j(i; shape) * amplitude_j
///
/// linear in the amplitudes, non-linear in zero or more shape parameters (a time constant, a
/// period, a position). Amplitudes are an inner basis chosen for the numerics (Legendre
/// polynomials, cosine and sine); users meet `parameters`, in the units of the problem file, and
/// the effect converts between the two.
namespace slideway {

struct Parameter {
  std::string name;    // "b2", "time_constant_s"
  std::string symbol;  // "b_2", "τ"
  std::string unit;    // "mm^-1", "s"
  double scale = 1.0;  // ordinary size, in the unit: what an optimiser should call a step of one
  double lower =
      -std::numeric_limits<double>::infinity();  // physically possible range, in the unit
  double upper = std::numeric_limits<double>::infinity();
  /// In a direction of parameter space that the data do not determine, the parameter with the
  /// highest of these is set to 0 and the others take its part.
  int gauge = 2;
  /// Fixed by a convention, not by data: the reference line of ISO 230-1 takes offset and slope of
  /// a straightness.
  bool by_convention = false;
};

/// Errors of the carriages, by their ISO 230-1 names for the paper's lathe.
enum class MotionError {
  none,                   // not of a carriage
  straightness,           // E_ZX with the pitch E_BX that follows from it, Eqs. (10), (12)
  vertical_straightness,  // E_BZ, the pitch that follows from E_XZ, Eq. (13)
  squareness              // E_B(0C)X, Eq. (15)
};

/// What a person wants to know about an effect.
struct Description {
  std::string name;           // as in the problem file
  std::string plain_name;     // what a workshop calls it: "spindle run-out"
  std::string standard_name;  // ISO 230-1 / 230-3 / 230-7 term, with the symbol where there is one
  std::string formula;        // "A (1 - exp(-t/τ))"
  std::string source;         // "Eq. (15)", "ISO 230-3"
  std::string cause;          // what makes it
  std::string typical;        // "5 to 50 µm/m on a precision lathe"
  IndependentVariable variable = IndependentVariable::radius;
  std::string confounded_with;                       // in words
  std::vector<std::string> confounded_effects = {};  // those of the catalogue among it
  std::string separated_by;
  MotionError motion = MotionError::none;
  /// Grows without bound, or bends sharply, towards the spindle axis, where the nose of a tool
  /// cannot follow it.
  bool steep_at_centre = false;
  /// Its form is that of a measured cause, not of a law with free shapes: where both fit, it
  /// outranks what is no error of the carriages.
  bool measured = false;
  /// An error of what measures: each instrument has a size of its own, which its traces share.
  bool of_instrument = false;
  /// Its form is that of the face it is in: TravelRange::face_slope.
  bool of_face = false;
  /// Of a turned face, the same along every trace of a surface: one of them cannot have it without
  /// the others.
  bool axisymmetric = false;
  /// Every cut has it, by the kinematics: not whether it is there is in question, but its size.
  /// What has no name is no rival of it.
  bool kinematic = false;
};

/// One shape parameter: which of the parameters it is, and where to look for it.
struct Shape {
  int parameter = 0;         // index into parameters()
  bool logarithmic = false;  // search and step on a log scale
  bool stepwise = false;     // columns are piecewise constant in it: scanned, not differentiated
  /// A correction of higher order: 0 on a search grid, moved from there once those before it are.
  bool higher_order = false;
  bool may_begin = false;  // its lower end is a law of its own, not where the search ended

  /// The optimiser's view of a value and back: its logarithm where it is logarithmic.
  [[nodiscard]] double inner(double value) const { return logarithmic ? std::log(value) : value; }
  [[nodiscard]] double outer(double value) const { return logarithmic ? std::exp(value) : value; }
};

/// Values of an effect's parameters and how they move with amplitudes and shape.
struct ParameterValues {
  Eigen::VectorXd values;    // #parameters, in the units of parameters()
  Eigen::MatrixXd jacobian;  // #parameters by (#amplitudes + #shapes)
  Eigen::VectorXd by_slope;  // change with z'_rms of the face, a rad; empty: none
};

/// z'(r) of a face that crosses the spindle axis, as the errors of the carriages make it.
struct FaceSlope {
  double spacing_mm = 1.0;
  std::vector<double> values;  // rad, at r = 0, spacing, 2 spacing, ...; at least two

  /// Straight between the values. REQUIRES radius_mm >= 0.
  [[nodiscard]] double at(double radius_mm) const;
  [[nodiscard]] double rms() const;
};

/// When the stations of a profile were read.
struct ReadingWindow {
  std::string profile;
  double from_s = 0.0, to_s = 0.0;
};

/// What an effect must know of all profiles together before it can choose its inner basis.
struct TravelRange {
  double slide_min = 0.0, slide_max = 1.0;  // mm, over all profiles
  double z_min = 0.0, z_max = 0.0;          // mm
  double coarsest_feed_mm = 0.0;            // largest feed per turn; 0: unknown
  double beam_span_mm = 0.0;                // between the supports of the cross-beam; 0: unknown
  std::vector<ReadingWindow> read;          // of the profiles whose times are known
  std::shared_ptr<const FaceSlope> face_slope = nullptr;  // as a fit has it; null: unknown
};

/// How the form of a slide is described.
enum class Form { polynomial, curve };

/// Amplitudes that are values of a Gaussian process at places along the slide. How long and how
/// large it is comes from the data, together with the fit (curve_prior.hpp).
struct Knots {
  Eigen::Index first = 0;        // amplitude of the first knot
  Eigen::VectorXd positions_mm;  // slide coordinates, evenly spaced, rising; one for each amplitude
};

class Effect;
struct Departures;

/// Makes an effect that is not in the catalogue: a user's own.
using EffectFactory =
    std::function<std::unique_ptr<Effect>(const Machine& machine, const TravelRange& range)>;

/// What the problem file says of a declared effect, besides its name.
struct EffectOptions {
  std::optional<std::string> body = std::nullopt;
  std::optional<int> degree = std::nullopt;
  std::optional<double> span_mm = std::nullopt;  // between the supports of a beam
  /// Only the terms above this degree: what a search adds to a declared effect.
  std::optional<int> above = std::nullopt;
  /// Names of the profiles it acts in; empty: all.
  std::vector<std::string> profiles = {};
  std::optional<Form> form = std::nullopt;             // of a straightness: a polynomial
  std::optional<double> resolution_mm = std::nullopt;  // of a curve: between its knots
  std::vector<int> harmonics = {};                     // of feed marks in one cut, rising
  bool each_half = false;  // of them: each half of a diameter has its own
  EffectFactory own = {};  // makes an effect that is not in the catalogue; empty: it is
  /// The same one with fewer shapes: laws that a search says where they explain as much.
  std::vector<EffectFactory> simpler = {};
};

/// A normal prior on one parameter, in the parameter's unit.
struct Prior {
  std::string parameter;
  double value = 0.0;
  double standard_uncertainty = 0.0;
};

/// What the samples of one profile show of an effect for certain, before any search.
struct ShownBySamples {
  EffectOptions options;
  std::vector<Prior> values;  // of its parameters, by the samples
  std::vector<int> bounded;   // harmonics that they do not show: their values are 0 within a bound
  double p_value = 1.0;       // that noise does so
  bool may_be_whole = false;  // whether the effect without options may have made them
};

/// Rates between which a line of an effect lies, in cycles over one profile: the resolution of the
/// profile's spectrum is 1.
struct LineBand {
  double low = 0.0, high = 0.0;
};

/// A direction in parameter space that the data do not determine, as one of its effects sees it.
struct UndeterminedPart {
  std::vector<std::string> own;       // parameters of the effect in it
  std::vector<const Effect*> others;  // the other effects in it
  bool model_has_others = false;      // whether or not they are in it
};

class Effect {
 public:
  virtual ~Effect() = default;

  [[nodiscard]] virtual const Description& description() const = 0;
  [[nodiscard]] virtual const std::vector<Parameter>& parameters() const = 0;
  [[nodiscard]] virtual int amplitudes() const = 0;
  [[nodiscard]] virtual const std::vector<Shape>& shapes() const = 0;

  /// Range a shape parameter is searched in for these data, in its unit: what the profile can show
  /// (a period between two samples and the travel, a step inside the cut).
  /// REQUIRES 0 <= shape < #shapes, applies_to(stations.setup()), lacking(stations.setup()) empty.
  [[nodiscard]] virtual std::pair<double, double> search_range(int shape,
                                                               const Stations& stations) const;

  /// Change of a shape parameter at `value` that changes the columns visibly, in its unit: the step
  /// of a search grid. By default 1/40 of the (logarithmic) search range. REQUIRES as
  /// search_range().
  [[nodiscard]] virtual double resolution(int shape, double value, const Stations& stations) const;

  /// False where the reading cannot see the effect at all (a slope reading and a drift of height):
  /// its columns are then zero.
  [[nodiscard]] virtual bool applies_to(const Setup& setup) const = 0;

  /// Keys of the problem file this profile lacks for the effect's variable; see missing_for().
  [[nodiscard]] virtual std::vector<std::string> lacking(const Setup& setup) const;

  /// What all the profiles it acts in lack together ("azimuth_deg of at least three traces").
  [[nodiscard]] virtual std::vector<std::string> lacking_together(
      const std::vector<const Setup*>& setups) const;

  /// What they lack for the effect to be told from what one of them has by itself: with less it may
  /// explain the data, and no other name stands alone beside it, but it is not said.
  [[nodiscard]] virtual std::vector<std::string> lacking_to_be_told(
      const std::vector<const Setup*>& setups) const;

  /// Fills `out` (#stations by #amplitudes): mm per unit of amplitude for heights, rad for slopes.
  /// Finite for every shape inside the bounds. REQUIRES lacking(stations.setup()) empty.
  virtual void columns(const Stations& stations, std::span<const double> shape,
                       Eigen::Ref<Eigen::MatrixXd> out) const = 0;

  /// The columns of several shapes side by side: #stations by (#shapes #amplitudes).
  virtual void columns_of_shapes(const Stations& stations,
                                 std::span<const std::vector<double>> shapes,
                                 Eigen::Ref<Eigen::MatrixXd> out) const;

  /// Fills `out` (#stations by #shapes #amplitudes) with the derivatives of the columns by each
  /// shape, side by side; zero for a stepwise shape.
  virtual void derivatives(const Stations& stations, std::span<const double> shape,
                           Eigen::Ref<Eigen::MatrixXd> out) const;

  /// The amplitudes that are a process along the slide; by default none.
  [[nodiscard]] virtual std::optional<Knots> knots() const { return std::nullopt; }

  /// Parameters from amplitudes and shape, with the Jacobian.
  [[nodiscard]] virtual ParameterValues parameter_values(const Eigen::VectorXd& amplitudes,
                                                         std::span<const double> shape) const = 0;

  /// The reverse: amplitudes (first) and shape (behind them) from parameter values.
  [[nodiscard]] virtual Eigen::VectorXd from_parameters(const Eigen::VectorXd& values) const = 0;

  /// Lines of the effect's spectrum in a profile; empty: it has none. REQUIRES as search_range().
  [[nodiscard]] virtual std::vector<LineBand> lines(const Stations& stations,
                                                    std::span<const double> shape) const;

  /// True if parameter_values() is linear in the amplitudes (no phase, no modulus).
  [[nodiscard]] virtual bool linear_parameters() const { return true; }

  /// True if size() is a parameter itself, not the largest of several.
  [[nodiscard]] bool has_one_size() const { return amplitudes() == 1 || !linear_parameters(); }

  /// Size of the effect as one number in the unit of the first parameter: |amplitude|, or the
  /// modulus of cosine and sine parts.
  [[nodiscard]] virtual double size(const Eigen::VectorXd& parameter_values) const {
    return std::abs(parameter_values[0]);
  }

  /// Which parameter must be known to some of its uncertainties before the effect may be named. The
  /// first, unless that and a shape tell the same together.
  [[nodiscard]] virtual int decisive_parameter() const { return 0; }

  [[nodiscard]] bool is_carriage() const { return description().motion != MotionError::none; }

  /// Adds what the effect does to the bodies of the machine (errors[j-1] of body j) when the slide
  /// stands at `slide_mm`. Nothing, unless it is an error of a body.
  virtual void add_body_errors(const Pose& pose, double slide_mm, const Eigen::VectorXd& amplitudes,
                               std::span<BodyErrors> errors) const;

  /// What to measure so that a direction it takes part in becomes determined; "": nothing that is
  /// special to this effect.
  [[nodiscard]] virtual std::string advice(const UndeterminedPart& part) const;

  /// The hypotheses about itself a search tries. By default the effect as it is where it is not
  /// declared, and none where it is; an effect with a degree has one for each degree to be tried.
  /// @param declared  the options it is declared with, or null
  [[nodiscard]] virtual std::vector<EffectOptions> hypotheses(const EffectOptions* declared) const;

  /// What the samples of one profile show of it, where they resolve what its low band does not.
  /// None by default. REQUIRES as columns().
  /// @param values        #stations: heights, mm, or slopes, rad
  /// @param significance  of the test that it is there
  [[nodiscard]] virtual std::optional<ShownBySamples> shown_by(const Stations& stations,
                                                               std::span<const double> values,
                                                               double significance) const;

  /// Why its columns cannot be used on a profile, with the place; "": they can. REQUIRES as
  /// search_range().
  [[nodiscard]] virtual std::string fault(const Stations& stations) const;

  /// No parts: its cause and its law are taken as they are.
  [[nodiscard]] virtual Departures departures() const;

  /// Keys of [machine] the effect cannot do without and the problem does not give.
  [[nodiscard]] virtual std::vector<std::string> lacking_of_machine(const TravelRange& range) const;
};

/// What the cause of an effect, or its law, may differ by from what it is taken as.
struct Departures {
  /// The law: each part is as large as the effect itself. Else each is a standard deviation.
  bool of_law = false;
  std::vector<std::unique_ptr<Effect>> parts = {};  // independent, of the effect's amplitudes
};

/// Columns of an effect in a reading along the slide itself, at slide coordinates x: heights in mm,
/// or local slopes in rad, per unit of amplitude.
Eigen::MatrixXd along_slide(const Effect& effect, const Machine& machine, const Eigen::VectorXd& x,
                            Quantity quantity, std::span<const double> shape = {});

}  // namespace slideway
