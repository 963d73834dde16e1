#pragma once

#include "slideway/base/record.hpp"
#include "slideway/identify/result.hpp"

/// Members of what stands in result.hpp, as reports have them, and texts of enumerations of earlier
/// rooms.
namespace slideway {

template <>
inline constexpr std::array<std::string_view, 2> kTexts<Kind>{"face", "slide"};
template <>
inline constexpr std::array<std::string_view, 2> kTexts<Quantity>{"height", "slope"};
template <>
inline constexpr std::array<std::string_view, 2> kTexts<CutDirection>{"inward", "outward"};
template <>
inline constexpr std::array<std::string_view, 2> kTexts<Role>{"fit", "holdout"};
template <>
inline constexpr std::array<std::string_view, 3> kTexts<Loss>{"none", "huber", "cauchy"};
template <>
inline constexpr std::array<std::string_view, 3> kTexts<Axis>{"x", "y", "z"};
template <>
inline constexpr std::array<std::string_view, 2> kTexts<Lever>{"paper", "split"};
template <>
inline constexpr std::array<std::string_view, 2> kTexts<OutlierKind>{"spike", "lost minus sign"};
template <>
inline constexpr std::array<std::string_view, 9> kTexts<Boundary>{
    "zero",          "constant", "symmetric",     "periodic",   "smooth",
    "periodization", "reflect",  "antisymmetric", "antireflect"};

template <>
inline constexpr auto kRecord<Assumption> =
    record("Assumption", "A key that the problem file leaves out, and what it was taken as.",
           field("key", &Assumption::key, "as in the problem file: profile.feed2.free"),
           json_text("value", &Assumption::value, "as the problem file would have it"),
           field("why", &Assumption::why));

template <>
inline constexpr auto kRecord<OutlierSummary> =
    record("Outlier", "A sample that its neighbours contradict.",
           field("row", &OutlierSummary::row, "of the data, from 1"),
           field("value", &OutlierSummary::value, "in `unit`"),
           field("expected", &OutlierSummary::expected, "by its neighbours, in `unit`"),
           field("unit", &OutlierSummary::unit), field("kind", &OutlierSummary::kind));

template <>
inline constexpr auto kRecord<InputSummary> =
    record("Input", "One profile as it was read.", field("name", &InputSummary::name),
           field("file", &InputSummary::file, "arrays: the numbers did not come from a file"),
           field("format", &InputSummary::format), field("sha256", &InputSummary::sha256),
           field("kind", &InputSummary::kind), field("quantity", &InputSummary::quantity),
           field("role", &InputSummary::role, "holdout: never fitted, only predicted"),
           field("loss", &InputSummary::loss, "none: every residual counts by its square"),
           field("azimuth_deg", &InputSummary::azimuth_deg, "of a face"),
           field("surface", &InputSummary::surface, "as the problem names it"),
           field("instrument", &InputSummary::instrument, "as the problem names it"),
           field("samples", &InputSummary::samples),
           field("missing", &InputSummary::missing, "points of the file that have no value"),
           field("left_out", &InputSummary::left_out, "samples left out as the problem asks"),
           field("outlier_count", &InputSummary::outlier_count),
           field("outliers", &InputSummary::outliers, "the 20 largest at most, by row"),
           field("position_min_mm", &InputSummary::position_min_mm),
           field("position_max_mm", &InputSummary::position_max_mm),
           field("rms_um", &InputSummary::rms_um, "about the mean"),
           field("pv_um", &InputSummary::pv_um), field("rms_urad", &InputSummary::rms_urad),
           field("pv_urad", &InputSummary::pv_urad), field("notes", &InputSummary::notes));

template <>
inline constexpr auto kRecord<MisclosureSummary> =
    record("Misclosure", "What one line reads where it meets others, against what they say.",
           field("profile", &MisclosureSummary::profile), field("x_mm", &MisclosureSummary::x_mm),
           field("y_mm", &MisclosureSummary::y_mm),
           field("difference_um", &MisclosureSummary::difference_um, "as the data stand"),
           field("closure_um", &MisclosureSummary::closure_um, "none: nothing checks it"),
           field("standard_uncertainty_um", &MisclosureSummary::standard_uncertainty_um));

template <>
inline constexpr auto kRecord<RepeatSummary> = record(
    "Repeat", "Two profiles of one line, at the station at which they differ most.",
    field("a", &RepeatSummary::a), field("b", &RepeatSummary::b),
    field("stations", &RepeatSummary::stations), field("x_mm", &RepeatSummary::x_mm),
    field("y_mm", &RepeatSummary::y_mm), field("difference_um", &RepeatSummary::difference_um),
    field("standard_uncertainty_um", &RepeatSummary::standard_uncertainty_um),
    field("limit", &RepeatSummary::limit, "of the ratio of the two"),
    field("verdict", &RepeatSummary::verdict));

template <>
inline constexpr auto kRecord<ClosureSummary> = record(
    "Closure", "Whether lines agree where they meet.", field("verdict", &ClosureSummary::verdict),
    field("lines", &ClosureSummary::lines), field("places", &ClosureSummary::places),
    field("redundancy", &ClosureSummary::redundancy),
    field("false_alarm", &ClosureSummary::false_alarm),
    field("limit", &ClosureSummary::limit, "of closure_um / standard_uncertainty_um"),
    field("tied", &ClosureSummary::tied, "heights that a reduction has made agree"),
    field("readings", &ClosureSummary::readings), field("repeats", &ClosureSummary::repeats),
    field("suspects", &ClosureSummary::suspects, "lines without any one of which the rest closes"),
    field("notes", &ClosureSummary::notes));

template <>
inline constexpr auto kRecord<TravelSummary> = record(
    "Travel", "What the fitted profiles cover of the slide, and the lever that acts on it.",
    field("lever", &TravelSummary::lever), field("slide_min_mm", &TravelSummary::slide_min_mm),
    field("slide_max_mm", &TravelSummary::slide_max_mm),
    field("spindle_position_mm", &TravelSummary::spindle_position_mm, "none: no face was fitted"),
    field("overhang_mm", &TravelSummary::overhang_mm,
          "none: no face was fitted, or faces of several overhangs"));

template <>
inline constexpr auto kRecord<LowBandSummary> =
    record("LowBand", "The low band of one profile.", field("profile", &LowBandSummary::profile),
           field("wavelet", &LowBandSummary::wavelet),
           field("level", &LowBandSummary::level, "0: no low band, the profile as it is"),
           field("boundary", &LowBandSummary::boundary), field("values", &LowBandSummary::values));

template <>
inline constexpr auto kRecord<RunningSeries> = record(
    "Running", "Coefficients over a growing part of the trace, Figs. 8 and 9.",
    field("samples", &RunningSeries::samples, "`raw` is the coefficient of the first so many"),
    field("position_mm", &RunningSeries::position_mm, "of the last of them"),
    field("raw", &RunningSeries::raw),
    field("low_band_position_mm", &RunningSeries::low_band_position_mm,
          "to which each value of `low_band` reaches"),
    field("low_band", &RunningSeries::low_band));

template <>
inline constexpr auto kRecord<Ranking> = record(
    "Ranking", "Pearson's coefficient of an effect and a profile, Eqs. (6), (19), (20).",
    field("effect", &Ranking::effect), field("profile", &Ranking::profile),
    field("raw", &Ranking::raw), field("low_band", &Ranking::low_band),
    field("lag_mm", &Ranking::lag_mm, "at which the low-band coefficient is largest"),
    field("lag_coefficient", &Ranking::lag_coefficient),
    field("effective_observations", &Ranking::effective_observations),
    field("p_value", &Ranking::p_value, "of `low_band`"), field("running", &Ranking::running));

template <>
inline constexpr auto kRecord<CandidateCorrelation> =
    record("CandidateCorrelation", "Correlation of two effects' signals on one profile.",
           field("a", &CandidateCorrelation::a), field("b", &CandidateCorrelation::b),
           field("profile", &CandidateCorrelation::profile),
           field("coefficient", &CandidateCorrelation::coefficient));

template <>
inline constexpr auto kRecord<Dominant> =
    record("Dominant", "The effect with the largest part.",
           field("by_correlation", &Dominant::by_correlation), field("by_fit", &Dominant::by_fit),
           field("agree", &Dominant::agree), field("doubt", &Dominant::doubt, "why none is named"));

inline constexpr const char* kIfNo =
    "effects that have the same columns in these data: it holds if none of them acts";

template <>
inline constexpr auto kRecord<FittedParameter> = record(
    "Parameter", "A parameter: value ± expanded_uncertainty, in `unit`.",
    field("name", &FittedParameter::name), field("symbol", &FittedParameter::symbol),
    field("standard_name", &FittedParameter::standard_name),
    field("value", &FittedParameter::value, "none: not determined"),
    field("unit", &FittedParameter::unit),
    field("standard_uncertainty", &FittedParameter::standard_uncertainty),
    field("expanded_uncertainty", &FittedParameter::expanded_uncertainty,
          "coverage_factor * standard_uncertainty, 95.45 % coverage"),
    field("coverage_factor", &FittedParameter::coverage_factor,
          "Student's, for degrees_of_freedom"),
    field("degrees_of_freedom", &FittedParameter::degrees_of_freedom,
          "none beside a coverage_factor: infinitely many"),
    field("identifiable", &FittedParameter::identifiable),
    field("at_bound", &FittedParameter::at_bound), field("if_no", &FittedParameter::if_no, kIfNo));

template <>
inline constexpr auto kRecord<UndeterminedDirection> =
    record("Undetermined", "A direction in parameter space along which no prediction changes.",
           field("combination", &UndeterminedDirection::combination),
           field("advice", &UndeterminedDirection::advice, "what would determine it"));

template <>
inline constexpr auto kRecord<DeterminedCombination> = record(
    "Determined", "What the data say of parameters they cannot tell apart.",
    field("combination", &DeterminedCombination::combination),
    field("value", &DeterminedCombination::value), field("unit", &DeterminedCombination::unit),
    field("standard_uncertainty", &DeterminedCombination::standard_uncertainty),
    field("expanded_uncertainty", &DeterminedCombination::expanded_uncertainty),
    field("coverage_factor", &DeterminedCombination::coverage_factor),
    field("degrees_of_freedom", &DeterminedCombination::degrees_of_freedom));

template <>
inline constexpr auto kRecord<Identifiability> =
    record("Identifiability", "What the data determine, and what they do not.",
           field("parameters", &Identifiability::parameters), field("rank", &Identifiability::rank),
           field("condition", &Identifiability::condition, "of the scaled columns within the rank"),
           field("unidentifiable", &Identifiability::unidentifiable),
           field("determined", &Identifiability::determined));

template <>
inline constexpr auto kRecord<NoiseSummary> = record(
    "Noise", "The noise of one profile as the fit has it.",
    field("profile", &NoiseSummary::profile), field("scaling", &NoiseSummary::scaling),
    field("correlated", &NoiseSummary::correlated, "texture or long memory, not white"),
    field("unlike_sisters", &NoiseSummary::unlike_sisters,
          "size over that of the profiles it shares its memory with, where it differs"),
    field("standard_deviation_um", &NoiseSummary::standard_deviation_um, "of one low-band value"),
    field("standard_deviation_urad", &NoiseSummary::standard_deviation_urad),
    field("correlation_mm", &NoiseSummary::correlation_mm, "integral correlation length"),
    field("effective_observations", &NoiseSummary::effective_observations),
    field("ljung_box_p", &NoiseSummary::ljung_box_p, "of the whitened residual"));

template <>
inline constexpr auto kRecord<Contribution> =
    record("Contribution", "An effect's part of a profile's low band.",
           field("effect", &Contribution::effect), field("profile", &Contribution::profile),
           field("rms_um", &Contribution::rms_um, "of what levelling leaves of it"),
           field("rms_urad", &Contribution::rms_urad),
           field("share", &Contribution::share, "of the sum of mean squares of all effects"));

template <>
inline constexpr auto kRecord<ResidualSummary> = record(
    "Residual", "Residual of one profile in the low band.",
    field("profile", &ResidualSummary::profile), field("role", &ResidualSummary::role),
    field("rms_um", &ResidualSummary::rms_um), field("pv_um", &ResidualSummary::pv_um),
    field("rms_urad", &ResidualSummary::rms_urad), field("pv_urad", &ResidualSummary::pv_urad));

template <>
inline constexpr auto kRecord<StraightnessError> =
    record("StraightnessError",
           "Largest positive minus largest negative deviation from a reference line, ISO 230-1.",
           field("line", &StraightnessError::line), field("error_um", &StraightnessError::value),
           field("standard_uncertainty_um", &StraightnessError::standard_uncertainty),
           field("expanded_uncertainty_um", &StraightnessError::expanded_uncertainty),
           field("coverage_factor", &StraightnessError::coverage_factor),
           field("degrees_of_freedom", &StraightnessError::degrees_of_freedom),
           field("highest_um", &StraightnessError::highest_um),
           field("highest_at_mm", &StraightnessError::highest_at_mm),
           field("lowest_um", &StraightnessError::lowest_um),
           field("lowest_at_mm", &StraightnessError::lowest_at_mm));

template <>
inline constexpr auto kRecord<StraightnessCurve> =
    record("StraightnessCurve",
           "The slide's form over the travel that was measured, from the end-point line.",
           drawn("position_mm", &StraightnessCurve::position_mm, "slide coordinate x", 7),
           drawn("deviation_um", &StraightnessCurve::deviation_um),
           drawn("expanded_uncertainty_um", &StraightnessCurve::expanded_uncertainty_um,
                 "of the deviation"),
           drawn("tip_um", &StraightnessCurve::tip_um,
                 "of faces: at the tool tip, with the pitch on its lever"),
           drawn("tip_expanded_uncertainty_um", &StraightnessCurve::tip_expanded_uncertainty_um),
           field("tip_slope_rad", &StraightnessCurve::tip_slope_rad,
                 "of the line through the ends of the tip's curve"));

template <>
inline constexpr auto kRecord<StraightnessStation> =
    record("StraightnessStation", "Height of the slide where it was read.",
           field("position_mm", &StraightnessStation::position_mm,
                 "of a reading, or of a foot of a bridge"),
           field("deviation_um", &StraightnessStation::deviation_um, "from the end-point line"),
           field("expanded_uncertainty_um", &StraightnessStation::expanded_uncertainty_um));

template <>
inline constexpr auto kRecord<CurveForm> =
    record("CurveForm", "The process a curve is described by: a Matérn covariance.",
           field("length_mm", &CurveForm::length_mm),
           field("amplitude_um", &CurveForm::amplitude_um, "its standard deviation"),
           field("roughness", &CurveForm::roughness, "its exponent: 1.5 or 2.5"));

template <>
inline constexpr auto kRecord<StraightnessOfPart> =
    record("StraightnessOfPart", "E_ZX of one of several forms.",
           field("profiles", &StraightnessOfPart::profiles, "whose form it is"),
           field("end_point_um", &StraightnessOfPart::end_point_um),
           field("expanded_uncertainty_um", &StraightnessOfPart::expanded_uncertainty_um));

template <>
inline constexpr auto kRecord<Straightness> = record(
    "Straightness", "Straightness error of the slide, E_ZX, ISO 230-1.",
    field("end_point_um", &Straightness::end_point_um),
    field("least_squares_um", &Straightness::least_squares_um),
    field("minimum_zone_um", &Straightness::minimum_zone_um),
    field("expanded_uncertainty_um", &Straightness::expanded_uncertainty_um, "of end_point_um"),
    field("stations", &Straightness::stations, "of slides"),
    field("errors", &Straightness::errors, "one for each reference line"),
    field("curve", &Straightness::curve), field("form", &Straightness::form, "of a curve"),
    field("parts", &Straightness::parts, "effects besides the straightness whose forms are in it"),
    field("if_no", &Straightness::if_no, kIfNo),
    field("reason", &Straightness::reason, "why there is none"),
    field("profiles", &Straightness::profiles, "of several forms: whose this one is, the worst"),
    field("each", &Straightness::each, "of several forms: all of them"));

template <>
inline constexpr auto kRecord<BudgetLine> =
    record("BudgetLine", "What one source contributes to an uncertainty.",
           field("source", &BudgetLine::source),
           field("type", &BudgetLine::type, "GUM 3.3.4: A by statistics, B otherwise"),
           field("standard_uncertainty", &BudgetLine::standard_uncertainty));

template <>
inline constexpr auto kRecord<Budget> =
    record("Budget", "Uncertainty budget of one parameter: squares of the lines add up to u².",
           field("parameter", &Budget::parameter), field("unit", &Budget::unit),
           field("lines", &Budget::lines));

template <>
inline constexpr auto kRecord<ModelResult> = record(
    "ModelResult", "A model and what the data say of it.", field("effects", &ModelResult::effects),
    field("converged", &ModelResult::converged),
    field("message", &ModelResult::message, "the solver's, where it did not converge"),
    field("rms_um", &ModelResult::rms_um, "residual of the fitted height profiles in the low band"),
    field("rms_urad", &ModelResult::rms_urad, "and of the slope profiles"),
    field("observations", &ModelResult::observations),
    field("effective_observations", &ModelResult::effective_observations),
    field("chi_square", &ModelResult::chi_square, "of the whitened residual"),
    field("degrees_of_freedom", &ModelResult::degrees_of_freedom),
    field("parameters", &ModelResult::parameters),
    field("nuisances", &ModelResult::nuisances, "levelling of the traces"),
    field("straightness", &ModelResult::straightness, "none: the model has none"),
    field("correlations", &ModelResult::correlations, "of the estimates, from 0.1 on"),
    field("identifiability", &ModelResult::identifiability), field("noise", &ModelResult::noise),
    field("contributions", &ModelResult::contributions),
    field("residuals", &ModelResult::residuals),
    field("uncertainty_budget", &ModelResult::budget, "empty where it was not asked for"),
    field("neglected_um", &ModelResult::neglected_um,
          "largest second-order term at the fitted values"),
    field("implausible", &ModelResult::implausible, "why no slide makes the fitted straightness"),
    field("notes", &ModelResult::notes));

template <>
inline constexpr auto kRecord<SquarenessCheck> = record(
    "SquarenessCheck", "Squareness of the final model against the run-out, Eq. (21).",
    field("fit_rad", &SquarenessCheck::fit_rad), field("fit_U_rad", &SquarenessCheck::fit_U_rad),
    field("indirect_rad", &SquarenessCheck::indirect_rad),
    field("indirect_U_rad", &SquarenessCheck::indirect_U_rad), field("En", &SquarenessCheck::En),
    field("verdict", &SquarenessCheck::verdict), field("reason", &SquarenessCheck::reason),
    field("travel_mm", &SquarenessCheck::travel_mm, "over which the squareness acts"),
    field("fit_amplitude_um", &SquarenessCheck::fit_amplitude_um),
    field("indirect_amplitude_um", &SquarenessCheck::indirect_amplitude_um));

template <>
inline constexpr auto kRecord<ProfileCheck> =
    record("ProfileCheck", "One quantity from each of several profiles that should agree.",
           field("profiles", &ProfileCheck::profiles), field("what", &ProfileCheck::what),
           field("En", &ProfileCheck::En), field("verdict", &ProfileCheck::verdict),
           field("chi2", &ProfileCheck::chi2, "per degree of freedom, over all effects"),
           field("p_value", &ProfileCheck::p_value),
           field("value_um", &ProfileCheck::value_um,
                 "end-point straightness along the common travel by each profile alone; empty for "
                 "other effects"),
           field("U_um", &ProfileCheck::U_um, "its expanded uncertainties"));

template <>
inline constexpr auto kRecord<HeldOutCheck> =
    record("HeldOutCheck", "Whether a held-out profile lies where the model predicts it.",
           field("profile", &HeldOutCheck::profile),
           field("chi2", &HeldOutCheck::chi2, "per degree of freedom"),
           field("p_value", &HeldOutCheck::p_value), field("largest_um", &HeldOutCheck::largest_um),
           field("largest_urad", &HeldOutCheck::largest_urad), field("at_mm", &HeldOutCheck::at_mm),
           field("verdict", &HeldOutCheck::verdict));

template <>
inline constexpr auto kRecord<PureErrorCheck> = record(
    "PureErrorCheck", "What repeats have in common and the model lacks.",
    field("profiles", &PureErrorCheck::profiles), field("F", &PureErrorCheck::F),
    field("p_value", &PureErrorCheck::p_value),
    field("common_um", &PureErrorCheck::common_um, "rms of the slow part in common"),
    field("common_urad", &PureErrorCheck::common_urad),
    field("apart_um", &PureErrorCheck::apart_um, "the same of a reading less what is in common"),
    field("apart_urad", &PureErrorCheck::apart_urad), field("verdict", &PureErrorCheck::verdict));

template <>
inline constexpr auto kRecord<Crosscheck> =
    record("Crosscheck", "The final model against what it was not made of.",
           field("squareness", &Crosscheck::squareness), field("profiles", &Crosscheck::profiles),
           field("held_out", &Crosscheck::held_out), field("repeats", &Crosscheck::repeats));

template <>
inline constexpr auto kRecord<Conformity> =
    record("Conformity", "A value against its limit, with U as guard band (ISO 14253-1).",
           field("what", &Conformity::what), field("value_um", &Conformity::value_um),
           field("U_um", &Conformity::U_um), field("limit_um", &Conformity::limit_um),
           field("value_um_per_m", &Conformity::value_um_per_m),
           field("U_um_per_m", &Conformity::U_um_per_m),
           field("limit_um_per_m", &Conformity::limit_um_per_m),
           field("with_left_out_um", &Conformity::with_left_out_um,
                 "of flatness, with the values that the fit leaves out, if it is larger"),
           field("verdict", &Conformity::verdict), field("if_no", &Conformity::if_no, kIfNo));

}  // namespace slideway
