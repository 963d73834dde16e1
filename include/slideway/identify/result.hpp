#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "slideway/base/record.hpp"
#include "slideway/identify/assumption.hpp"
#include "slideway/identify/model_result.hpp"
#include "slideway/machine/machine.hpp"
#include "slideway/profile/profile.hpp"
#include "slideway/signal/dwt.hpp"

/// What an identification finds, as plain values: the raw material of every report. The unit of a
/// length stands in its name; of a pair such as rms_um and rms_urad the first is set for heights,
/// the second for slopes. A number that could not be determined is std::nullopt.
namespace slideway {

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
  std::optional<Loss> loss;           // none: every residual counts by its square
  std::optional<double> azimuth_deg;  // of a face
  std::optional<std::string> surface, instrument;
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
  std::optional<bool> agree;  // none unless both name one
  std::string doubt;          // why the fit names none, in words; "" if it does
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
  std::optional<double> chi2, p_value;  // of the profiles being one, over all effects
  std::vector<double> value_um, U_um;   // straightness by each profile alone, in their order
};

enum class HeldOutVerdict { fits, does_not_fit };
template <>
inline constexpr std::array<std::string_view, 2> kTexts<HeldOutVerdict>{"fits", "does not fit"};

/// Whether a held-out profile lies where the model predicts it, within the uncertainty.
struct HeldOutCheck {
  std::string profile;
  double chi2 = 0.0, p_value = 1.0;  // χ² per degree of freedom
  std::optional<double> largest_um, largest_urad;
  double at_mm = 0.0;
  HeldOutVerdict verdict = HeldOutVerdict::fits;
};

enum class RepeatFit { fits, lack_of_fit };
template <>
inline constexpr std::array<std::string_view, 2> kTexts<RepeatFit>{"fits", "lack of fit"};

/// What repeats of one trace have in common and the model lacks, against their differences.
struct PureErrorCheck {
  std::vector<std::string> profiles;
  double F = 0.0, p_value = 1.0;
  std::optional<double> common_um, common_urad;  // rms of the slow part in common
  std::optional<double> apart_um, apart_urad;    // the same of a reading less what is in common
  RepeatFit verdict = RepeatFit::fits;
};

struct Crosscheck {
  std::optional<SquarenessCheck> squareness;  // none: nothing was fitted
  std::vector<ProfileCheck> profiles;
  std::vector<HeldOutCheck> held_out;
  std::vector<PureErrorCheck> repeats;
};

enum class ConformityVerdict { conforms, does_not_conform, undecided };
template <>
inline constexpr std::array<std::string_view, 3> kTexts<ConformityVerdict>{
    "conforms", "does not conform", "can not be decided"};

/// What a tolerance is of, where the model has no part in it.
inline constexpr const char* kFlatness = "flatness";

/// ISO 14253-1: a value held against its limit, with U as guard band.
struct Conformity {
  std::string what;  // kFlatness, or an error of the carriages
  std::optional<double> value_um, U_um, limit_um;
  std::optional<double> value_um_per_m, U_um_per_m, limit_um_per_m;
  /// Of flatness, where values that the fit leaves out, as at a nub, make it larger: with them.
  std::optional<double> with_left_out_um;
  ConformityVerdict verdict = ConformityVerdict::undecided;
  std::vector<std::string> if_no;  // as of the value: FittedParameter
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

/// Directions that the data leave open and no convention closes.
std::vector<const UndeterminedDirection*> open_directions(const ModelResult& model);

}  // namespace slideway
