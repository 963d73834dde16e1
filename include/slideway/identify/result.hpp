#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "slideway/base/record.hpp"
#include "slideway/identify/assumption.hpp"
#include "slideway/machine/machine.hpp"
#include "slideway/profile/profile.hpp"
#include "slideway/signal/dwt.hpp"

/// What an identification finds, as plain values: the raw material of every report. The unit of a
/// length stands in its name; of a pair such as rms_um and rms_urad the first is set for heights,
/// the second for slopes. A number that could not be determined is std::nullopt.
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

/// A sample that its neighbours contradict.
struct OutlierSummary {
  std::size_t row = 0;  // of the data, from 1
  double value = 0.0, expected = 0.0;
  MicroUnit unit = MicroUnit::um;
  OutlierKind kind = OutlierKind::spike;
};

struct InputSummary {
  std::string name, file, format, sha256;
  Kind kind = Kind::face;
  Quantity quantity = Quantity::height;
  Role role = Role::fit;
  std::size_t samples = 0;
  std::size_t missing = 0;
  std::size_t left_out = 0;
  std::size_t outlier_count = 0;
  std::vector<OutlierSummary> outliers;  // the 20 largest at most, by row
  double position_min_mm = 0.0, position_max_mm = 0.0;
  std::optional<double> rms_um, pv_um;  // about the mean
  std::optional<double> rms_urad, pv_urad;
  std::vector<std::string> notes;
};

enum class ClosureVerdict { closes, does_not_close, not_judged };
template <>
inline constexpr std::array<std::string_view, 3> kTexts<ClosureVerdict>{"closes", "does not close",
                                                                        "not judged"};
enum class RepeatVerdict { agree, do_not_agree };
template <>
inline constexpr std::array<std::string_view, 2> kTexts<RepeatVerdict>{"agree", "do not agree"};

/// What one line reads where it meets others, against what they say (close_lines()).
struct MisclosureSummary {
  std::string profile;
  double x_mm = 0.0, y_mm = 0.0;
  std::optional<double> difference_um;  // as the data stand; none where a slope takes part
  std::optional<double> closure_um;     // none: nothing checks it
  std::optional<double> standard_uncertainty_um;
};

/// Two profiles of one line, at the station at which they differ most.
struct RepeatSummary {
  std::string a, b;
  std::size_t stations = 0;
  double x_mm = 0.0, y_mm = 0.0;
  double difference_um = 0.0, standard_uncertainty_um = 0.0;
  double limit = 0.0;  // of their ratio
  RepeatVerdict verdict = RepeatVerdict::agree;
};

struct ClosureSummary {
  std::size_t lines = 0, places = 0, redundancy = 0;
  ClosureVerdict verdict = ClosureVerdict::not_judged;
  double false_alarm = 0.0;
  std::optional<double> limit;  // of a closure, in standard uncertainties
  bool tied = false;            // heights that a reduction has made agree
  std::vector<MisclosureSummary> readings;
  std::vector<RepeatSummary> repeats;
  std::vector<std::string> suspects;  // lines without any one of which the rest closes
  std::vector<std::string> notes;     // what that means, in words
};

/// The low band of one profile.
struct LowBandSummary {
  std::string profile, wavelet;
  int level = 0;  // 0: the profile as it is
  Boundary boundary = Boundary::symmetric;
  std::size_t values = 0;
};

/// Coefficients over a growing part of the trace, Figs. 8 and 9.
struct RunningSeries {
  std::vector<std::size_t> samples;  // the first so many
  std::vector<double> position_mm;   // of the last of them
  std::vector<double> raw;
  std::vector<double> low_band_position_mm;
  std::vector<double> low_band;
};

/// Pearson's coefficient of one effect and one profile, Eqs. (6), (19), (20).
struct Ranking {
  std::string effect, profile;
  double raw = 0.0, low_band = 0.0;
  double lag_mm = 0.0;  // lag at which the low-band coefficient is largest
  double lag_coefficient = 0.0;
  double effective_observations = 0.0;
  double p_value = 1.0;   // of the low-band coefficient, on effective observations
  RunningSeries running;  // Figs. 8 and 9
};

/// Correlation of two effects' signals on one profile: how little a high coefficient selects.
struct CandidateCorrelation {
  std::string a, b, profile;
  double coefficient = 0.0;
};

struct RankingResult {
  std::vector<Ranking> entries;
  std::vector<CandidateCorrelation> among_candidates;
  std::vector<std::string> notes;
};

/// None where there is one candidate only or none correlates significantly.
struct Dominant {
  std::optional<std::string> by_correlation, by_fit;
  std::optional<bool> agree;  // true only if both name one effect, without a doubt
  std::string doubt;          // why none can be named, in words; "" if there is no doubt
};

/// A parameter of the model; without a value where the data do not determine it.
struct FittedParameter : QuantityValue {
  std::string name, symbol, standard_name;
  bool identifiable = true;
  bool at_bound = false;
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
  int order = 0;                                                         // p of AR(p)
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
  std::optional<double> rms_um, rms_urad;  // about its mean
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

/// Straightness of the slide the fit has found, E_ZX, with its uncertainty.
struct Straightness {
  std::optional<double> end_point_um, least_squares_um, minimum_zone_um;  // by reference line
  std::optional<double> expanded_uncertainty_um;                          // of end_point_um
  std::vector<StraightnessError> errors;                                  // one for each line
  std::vector<StraightnessStation> stations;                              // of slides, 50 at most
  StraightnessCurve curve;
  std::string reason;  // why there is none; then all else is empty
};

enum class EvaluationType { A, B };  // GUM 3.3.4: by statistics, or otherwise
template <>
inline constexpr std::array<std::string_view, 2> kTexts<EvaluationType>{"A", "B"};

/// What one source contributes to the uncertainty of a parameter; the squares of all lines of a
/// parameter add up to that of its standard uncertainty (GUM 5.1.2).
struct BudgetLine {
  std::string source;  // "noise of feed2, estimated from the residual"
  EvaluationType type = EvaluationType::A;
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
};

enum class Consistency { consistent, inconsistent, not_available };
template <>
inline constexpr std::array<std::string_view, 3> kTexts<Consistency>{"consistent", "inconsistent",
                                                                     "not_available"};

struct SquarenessCheck {
  std::optional<double> fit_rad, fit_U_rad, indirect_rad, indirect_U_rad, En;
  Consistency verdict = Consistency::not_available;
  std::string reason;
  std::optional<double> travel_mm;  // over which the squareness acts in these data
  std::optional<double> fit_amplitude_um, indirect_amplitude_um;  // squareness times travel
};

/// One quantity from each of several profiles or surfaces that should agree.
struct ProfileCheck {
  std::vector<std::string> profiles;
  std::string what;
  std::optional<double> En;
  Consistency verdict = Consistency::not_available;
};

enum class HeldOutVerdict { fits, does_not_fit };
template <>
inline constexpr std::array<std::string_view, 2> kTexts<HeldOutVerdict>{"fits", "does not fit"};

/// Whether a held-out profile lies where the model predicts it, within the uncertainty.
struct HeldOutCheck {
  std::string profile;
  double chi2 = 0.0, p_value = 1.0;
  std::optional<double> largest_um, largest_urad;
  double at_mm = 0.0;
  HeldOutVerdict verdict = HeldOutVerdict::fits;
};

struct Crosscheck {
  std::optional<SquarenessCheck> squareness;  // none: nothing was fitted
  std::vector<ProfileCheck> profiles;
  std::vector<HeldOutCheck> held_out;
};

enum class ConformityVerdict { conforms, does_not_conform, undecided };
template <>
inline constexpr std::array<std::string_view, 3> kTexts<ConformityVerdict>{
    "conforms", "does not conform", "can not be decided"};

/// ISO 14253-1: a value held against its limit, with U as guard band.
struct Conformity {
  std::string what;  // "flatness"
  std::optional<double> value_um, U_um, limit_um;
  std::optional<double> value_um_per_m, U_um_per_m, limit_um_per_m;
  ConformityVerdict verdict = ConformityVerdict::undecided;
};

/// Where the slide went while the fitted profiles were made, and what its errors acted on.
struct TravelSummary {
  Lever lever = Lever::paper;
  double slide_min_mm = 0.0, slide_max_mm = 0.0;
  std::optional<double> spindle_position_mm;  // none without a face
  std::optional<double> overhang_mm;          // none without a face, or where faces differ
};

struct Result {
  std::string version, title;
  std::map<std::string, std::string> about;
  std::vector<Assumption> assumed;
  std::vector<InputSummary> inputs;
  std::optional<ClosureSummary> closure;  // none where no two profiles say where they lie
  std::optional<TravelSummary> travel;
  std::vector<LowBandSummary> low_band;  // one for each profile
  RankingResult ranking;                 // empty: `fit` makes none
  Dominant dominant;
  std::optional<ModelResult> declared;  // the problem as given; `rank` has none
  std::optional<ModelResult> final;     // with the effects that were missing; the same without loop
  Crosscheck crosscheck;                // of the final model
  std::vector<Conformity> conformity;
  std::vector<std::string> notes;
};

/// True if the verdict is negative for `--strict`: inconsistent, not converged, or a parameter
/// undetermined that no convention fixes.
bool is_negative(const Result& result);

}  // namespace slideway
