#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "slideway/base/record.hpp"
#include "slideway/profile/profile.hpp"

/// A fitted model as plain values, as result.hpp has them.
namespace slideway {

enum class MicroUnit { um, urad };
template <>
inline constexpr std::array<std::string_view, 2> kTexts<MicroUnit>{"um", "urad"};

/// A value with its unit and its uncertainty (GUM 2.2, 6.2): U = k u, k Student's factor for a
/// coverage of 95.45 % at ν degrees of freedom.
struct QuantityValue {
  std::optional<double> value;
  std::string unit;
  std::optional<double> standard_uncertainty;  // u
  std::optional<double> expanded_uncertainty;  // U
  std::optional<double> coverage_factor;       // k
  std::optional<double> degrees_of_freedom;    // ν; none beside a k: infinitely many
};

/// A parameter of the model; without a value where the data do not determine it.
struct FittedParameter : QuantityValue {
  std::string name, symbol, standard_name;
  bool identifiable = true;
  bool at_bound = false;
  std::vector<std::string> if_no;  // effects that have its columns: it holds if none of them acts
};

/// A direction in parameter space: name -> coefficient.
using Combination = std::vector<std::pair<std::string, double>>;

struct UndeterminedDirection {
  Combination combination;  // unit length; moving along it changes no prediction
  std::string advice;       // which measurement would determine it
};

/// What the data do say of parameters they cannot tell apart: Σ coefficient * parameter.
struct DeterminedCombination : QuantityValue {
  Combination combination;
};

struct Identifiability {
  std::size_t parameters = 0;
  std::size_t rank = 0;
  double condition = 1.0;  // of the scaled columns within the rank
  std::vector<UndeterminedDirection> unidentifiable;
  std::vector<DeterminedCombination> determined;
};

enum class NoiseScaling {
  declared,
  estimated,
  refuted  // estimated: the declared uncertainty is too small
};
template <>
inline constexpr std::array<std::string_view, 3> kTexts<NoiseScaling>{
    "declared", "estimated", "estimated: the declared uncertainty is too small"};

/// The noise of one profile as the fit has it.
struct NoiseSummary {
  std::string profile;
  NoiseScaling scaling = NoiseScaling::estimated;
  bool correlated = false;
  std::optional<double> unlike_sisters;  // its size over that of the profiles it shares memory with
  std::optional<double> standard_deviation_um, standard_deviation_urad;  // of one low-band value
  double correlation_mm = 0.0;          // integral correlation length, at most that of the trace
  double effective_observations = 0.0;  // at least 1
  double ljung_box_p = 1.0;             // of the whitened residual
};

/// Two parameters and the correlation of their estimates.
using ParameterCorrelation = std::tuple<std::string, std::string, double>;

/// One effect's share of the low band at the fitted values.
struct Contribution {
  std::string effect, profile;
  std::optional<double> rms_um, rms_urad;  // of what levelling leaves
  double share = 0.0;  // of the sum of mean squares of all effects on that profile
};

/// Residual of one profile in the low band.
struct ResidualSummary {
  std::string profile;
  Role role = Role::fit;
  std::optional<double> rms_um, pv_um, rms_urad, pv_urad;
};

enum class ReferenceLineKind { end_point, least_squares, minimum_zone };
template <>
inline constexpr std::array<std::string_view, 3> kTexts<ReferenceLineKind>{
    "end-point", "least squares", "minimum zone"};

/// Straightness error from one reference line, ISO 230-1: largest deviation minus smallest, with
/// its uncertainty; µm.
struct StraightnessError : QuantityValue {
  ReferenceLineKind line = ReferenceLineKind::end_point;
  double highest_um = 0.0, highest_at_mm = 0.0, lowest_um = 0.0, lowest_at_mm = 0.0;
};

/// The slide's form over the travel that the fitted profiles measured, each bridge from foot to
/// foot. Deviations are from the line through the end points.
struct StraightnessCurve {
  std::vector<double> position_mm;  // slide coordinate x
  std::vector<double> deviation_um;
  std::vector<double> expanded_uncertainty_um;  // of the deviation
  /// Of a face: what the form does to the tool tip, with the pitch that follows from it on its
  /// lever; from the line through its own end points, whose slope is tip_slope_rad (none: the data
  /// do not determine it).
  std::vector<double> tip_um, tip_expanded_uncertainty_um;
  std::optional<double> tip_slope_rad;
};

/// Height of the slide where it was read: a position of a reading, or of a foot of a bridge.
struct StraightnessStation {
  double position_mm = 0.0;
  double deviation_um = 0.0;  // from the line through the end points
  std::optional<double> expanded_uncertainty_um;
};

/// The process a curve is described by: curve_prior.hpp.
struct CurveForm {
  double length_mm = 0.0;     // ℓ of its Matérn covariance
  double amplitude_um = 0.0;  // a
  double roughness = 0.0;     // ν
};

/// E_ZX of one of several forms.
struct StraightnessOfPart {
  std::vector<std::string> profiles;  // whose form it is
  std::optional<double> end_point_um, expanded_uncertainty_um;
};

/// Straightness of the slide the fit has found, E_ZX, with its uncertainty. Where profiles have
/// forms of their own, that of the worst: one that is not determined, else the largest with its U.
struct Straightness {
  std::optional<double> end_point_um, least_squares_um, minimum_zone_um;  // by reference line
  std::optional<double> expanded_uncertainty_um;                          // of end_point_um
  std::vector<StraightnessError> errors;                                  // one for each line
  std::vector<StraightnessStation> stations;                              // of slides, 50 at most
  StraightnessCurve curve;
  std::optional<CurveForm> form;         // of form = "curve"
  std::vector<std::string> parts;        // effects besides the straightness whose forms are in it
  std::vector<std::string> if_no;        // as of a parameter
  std::string reason;                    // why there is none; then all else is empty
  std::vector<std::string> profiles;     // of several forms: whose this one is
  std::vector<StraightnessOfPart> each;  // of several forms: all of them
};

enum class EvaluationType { type_a, type_b };  // GUM 3.3.4: by statistics, or otherwise
template <>
inline constexpr std::array<std::string_view, 2> kTexts<EvaluationType>{"A", "B"};

/// What one source contributes to the uncertainty of a parameter; the squares of all lines of a
/// parameter add up to that of its standard uncertainty (GUM 5.1.2).
struct BudgetLine {
  std::string source;  // "noise of feed2, estimated from the residual"
  EvaluationType type = EvaluationType::type_a;
  double standard_uncertainty = 0.0;
};

struct Budget {
  std::string parameter, unit;
  std::vector<BudgetLine> lines;
};

/// A model and what the data say of it.
struct ModelResult {
  std::vector<std::string> effects;
  bool converged = false;
  std::string message;                     // the solver's, where it did not converge
  std::optional<double> rms_um, rms_urad;  // residual of the fitted profiles
  std::size_t observations = 0;
  double effective_observations = 0.0;
  double chi_square = 0.0;  // of the whitened residual
  double degrees_of_freedom = 0.0;
  std::vector<FittedParameter> parameters;
  std::vector<FittedParameter> nuisances;          // "feed2.offset", "feed2.tilt"
  std::optional<Straightness> straightness;        // none: the model has none
  std::vector<ParameterCorrelation> correlations;  // |ρ| >= 0.1
  Identifiability identifiability;
  std::vector<NoiseSummary> noise;
  std::vector<Contribution> contributions;
  std::vector<ResidualSummary> residuals;  // fitted and held-out profiles
  std::vector<Budget> budget;              // where asked for: one for each identifiable parameter
  std::optional<double>
      neglected_um;                // largest |exact - first order| of Eq. (5) at the fitted values
  std::string implausible;         // why no slide makes the fitted straightness; "": one might
  std::vector<std::string> notes;  // how uncertainties were scaled, plausibility, what was done

  [[nodiscard]] const FittedParameter* find(const std::string& name) const;
  /// The squareness, or null where it is not in the model. Of several the worst: one that is not
  /// determined, else the largest with its U.
  [[nodiscard]] const FittedParameter* squareness() const;
};

}  // namespace slideway
