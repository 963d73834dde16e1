#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// What an identification finds: plain values, the report's raw material. Lengths in the unit the
/// name says; a number that could not be determined is std::nullopt, never NaN.
namespace slideway {

/// A sample that its neighbours contradict, by its data row from 1.
struct OutlierSummary {
  std::size_t row = 0;
  double value = 0.0, expected = 0.0;
  std::string unit, kind;  // um or urad; "spike", "lost minus sign"
};

struct InputSummary {
  std::string name, file, format, sha256, kind, quantity, role;
  std::size_t samples = 0;
  std::size_t missing = 0;
  std::size_t left_out = 0;
  std::size_t outlier_count = 0;
  std::vector<OutlierSummary> outliers;  // the 20 largest at most, by row
  double position_min_mm = 0.0, position_max_mm = 0.0;
  std::optional<double> rms_um, pv_um;      // heights: about the mean; none for slopes
  std::optional<double> rms_urad, pv_urad;  // slopes
  std::vector<std::string> notes;
};

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
  double limit = 0.0;   // of their ratio
  std::string verdict;  // "agree", "do not agree"
};

struct ClosureSummary {
  std::size_t lines = 0, places = 0, redundancy = 0;
  std::string verdict;  // "closes", "does not close", "not judged"
  double false_alarm = 0.0;
  std::optional<double> limit;  // of a closure, in standard uncertainties
  bool tied = false;            // heights that a reduction has made agree
  std::vector<MisclosureSummary> readings;
  std::vector<RepeatSummary> repeats;
  std::vector<std::string> suspects;  // lines without any one of which the rest closes
  std::vector<std::string> notes;     // what that means, in words
};

/// Pearson's coefficient over the first part of a trace, which grows (Figs. 8 and 9): over its
/// samples up to position_mm, over its low band up to low_band_position_mm.
struct RunningSeries {
  std::vector<std::size_t> samples;
  std::vector<double> raw, low_band;
  std::vector<double> position_mm, low_band_position_mm;
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

struct FittedParameter {
  std::string name, symbol, unit, standard_name;
  std::optional<double> value, standard_uncertainty, expanded_uncertainty;
  double coverage_factor = 2.0;
  std::optional<double> degrees_of_freedom;  // effective, for coverage_factor; none: infinite
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
struct DeterminedCombination {
  Combination combination;
  double value = 0.0, standard_uncertainty = 0.0, expanded_uncertainty = 0.0;
  std::string unit;
};

struct Identifiability {
  std::size_t parameters = 0;
  std::size_t rank = 0;
  double condition = 1.0;  // of the scaled columns within the rank
  std::vector<UndeterminedDirection> unidentifiable;
  std::vector<DeterminedCombination> determined;
};

/// The noise of one profile as the fit has it.
struct NoiseSummary {
  std::string profile;
  std::string
      scaling;    // "declared" | "estimated" | "estimated: the declared uncertainty is too small"
  int order = 0;  // p of AR(p)
  std::optional<double> standard_deviation_um,
      standard_deviation_urad;          // of one low-band value, as height
  double correlation_mm = 0.0;          // integral correlation length, at most that of the trace
  double effective_observations = 0.0;  // at least 1
  double ljung_box_p = 1.0;             // of the whitened residual
};

/// One effect's share of the low band at the fitted values.
struct Contribution {
  std::string effect, profile;
  double rms_um = 0.0;  // about its mean (slopes: µrad)
  double share = 0.0;   // of the sum of mean squares of all effects on that profile
};

/// Residual of one profile in the low band.
struct ResidualSummary {
  std::string profile, role;
  double rms_um = 0.0;  // µm, slopes: µrad
  double pv_um = 0.0;
  std::string unit;  // "um" or "urad"
};

struct FitResult {
  bool converged = false;
  std::string message;             // the solver's, where it did not converge
  std::optional<double> rms_um;    // residual of the fitted height profiles
  std::optional<double> rms_urad;  // and of the fitted slope profiles
  std::size_t observations = 0;
  double effective_observations = 0.0;
  std::vector<FittedParameter> parameters;
  std::vector<FittedParameter> nuisances;  // "feed2.offset", "feed2.tilt"
  std::vector<std::tuple<std::string, std::string, double>> correlations;  // |ρ| >= 0.1
  Identifiability identifiability;
  std::vector<NoiseSummary> noise;
  std::vector<Contribution> contributions;
  std::vector<ResidualSummary> residuals;  // fitted and held-out profiles
  double chi_square = 0.0;                 // of the whitened residual
  double degrees_of_freedom = 0.0;
  std::optional<double>
      neglected_um;                // largest |exact - first order| of Eq. (5) at the fitted values
  std::string implausible;         // why no slide makes the fitted straightness; "": one might
  std::vector<std::string> notes;  // how uncertainties were scaled, plausibility, what was done

  [[nodiscard]] const FittedParameter* find(const std::string& name) const;
};

/// None where there is one candidate only, or where none leads.
struct Dominant {
  std::optional<std::string> by_correlation, by_fit;
  std::optional<bool> agree;  // none unless both name one
  std::string doubt;          // why the fit names none, in words; "" if it does
};

struct SquarenessCheck {
  std::optional<double> fit_rad, fit_U_rad, indirect_rad, indirect_U_rad, En;
  std::string verdict = "not_available";  // "consistent" | "inconsistent" | "not_available"
  std::string reason;
  std::optional<double> travel_mm;  // over which the squareness acts in these data
  std::optional<double> fit_amplitude_um, indirect_amplitude_um;  // squareness times travel
};

/// Where the slide went while the fitted profiles were made, and what its errors acted on.
struct TravelSummary {
  std::string lever;  // "paper" | "split"
  double slide_min_mm = 0.0, slide_max_mm = 0.0;
  std::optional<double> spindle_position_mm;  // none without a face
  std::optional<double> overhang_mm;          // none without a face, or where faces differ
};

struct Result {
  std::string title;
  std::string version;
  std::vector<InputSummary> inputs;
  std::optional<ClosureSummary> closure;  // none where no two profiles say where they lie
  std::string wavelet, boundary;
  int level = 0;
  std::size_t low_band_values = 0;
  std::optional<RankingResult> ranking;  // `fit` has none
  Dominant dominant;
  std::optional<FitResult> fit;  // `rank` prints none
  std::optional<SquarenessCheck> squareness;
  std::optional<TravelSummary> travel;  // none in a report of an older program
};

/// True if the verdict is negative for `--strict`: inconsistent, not converged, or a parameter
/// undetermined that no convention fixes.
bool is_negative(const Result& result);

}  // namespace slideway
