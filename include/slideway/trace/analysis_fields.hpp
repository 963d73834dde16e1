#pragma once

#include "slideway/identify/result_fields.hpp"
#include "slideway/trace/analysis.hpp"

/// Members of what the closed loop adds to a result, and of the whole report.
namespace slideway {

template <>
inline constexpr auto kRecord<TriedEffect> =
    record("Tried", "A candidate of the loop.", field("effect", &TriedEffect::effect),
           field("profiles", &TriedEffect::profiles, "those it acts in; empty: all"),
           field("delta_bic", &TriedEffect::delta_bic), field("p_value", &TriedEffect::p_value),
           field("rms_um", &TriedEffect::rms_um), field("parameters", &TriedEffect::parameters),
           field("refused", &TriedEffect::refused, "why it was not accepted; none: a rival"));

template <>
inline constexpr auto kRecord<TraceRound> = record(
    "Round", "One effect that entered the model.", field("accepted", &TraceRound::accepted),
    field("profiles", &TraceRound::profiles, "those it acts in; empty: all"),
    field("ambiguous_with", &TraceRound::ambiguous_with),
    field("before_rms_um", &TraceRound::before_rms_um),
    field("after_rms_um", &TraceRound::after_rms_um),
    field("before_rms_urad", &TraceRound::before_rms_urad),
    field("after_rms_urad", &TraceRound::after_rms_urad),
    field("before_holdout_rms_um", &TraceRound::before_holdout_rms_um),
    field("after_holdout_rms_um", &TraceRound::after_holdout_rms_um),
    field("delta_bic", &TraceRound::delta_bic), field("p_value", &TraceRound::p_value),
    field("stability", &TraceRound::stability, "share of resamples that choose the effect"),
    field("parameters", &TraceRound::parameters), field("candidates", &TraceRound::candidates));

template <>
inline constexpr auto kRecord<UnnamedForm> =
    record("UnnamedForm", "A short formula that describes what is left: no cause.",
           field("form", &UnnamedForm::form),
           field("formula", &UnnamedForm::formula, "in um of a height, urad of a slope"),
           field("profiles", &UnnamedForm::profiles, "those it describes; empty: all"),
           field("instead_of", &UnnamedForm::instead_of,
                 "the accepted effect it takes the place of; empty: none"),
           field("parameters", &UnnamedForm::parameters),
           field("delta_bic", &UnnamedForm::delta_bic, "against the effects as accepted"),
           field("before_rms_um", &UnnamedForm::before_rms_um),
           field("after_rms_um", &UnnamedForm::after_rms_um),
           field("before_rms_urad", &UnnamedForm::before_rms_urad),
           field("after_rms_urad", &UnnamedForm::after_rms_urad),
           field("before_holdout_rms_um", &UnnamedForm::before_holdout_rms_um),
           field("after_holdout_rms_um", &UnnamedForm::after_holdout_rms_um),
           field("candidate", &UnnamedForm::candidate, "[[trace.candidate]] of a problem file"));

template <>
inline constexpr auto kRecord<UnnamedCurve> =
    record("UnnamedCurve", "What is left without a name, as a curve over its variable.",
           field("variable", &UnnamedCurve::variable), field("unit", &UnnamedCurve::unit),
           field("value_unit", &UnnamedCurve::value_unit), drawn("at", &UnnamedCurve::at, "", 7),
           drawn("residual", &UnnamedCurve::residual),
           drawn("expanded_uncertainty", &UnnamedCurve::expanded_uncertainty));

template <>
inline constexpr auto kRecord<Unnamed> = record(
    "Unnamed", "What is left and has no name: how much, where, on which clock.",
    field("rms_um", &Unnamed::rms_um), field("pv_um", &Unnamed::pv_um),
    field("rms_urad", &Unnamed::rms_urad), field("pv_urad", &Unnamed::pv_urad),
    field("has_folded_wave", &Unnamed::has_folded_wave,
          "a wave is left that the low band may have folded"),
    field("p_value", &Unnamed::p_value), field("profile", &Unnamed::profile),
    field("from_mm", &Unnamed::from_mm), field("to_mm", &Unnamed::to_mm),
    field("clock", &Unnamed::clock), field("log_evidence", &Unnamed::log_evidence),
    field("correlation_length", &Unnamed::correlation_length),
    field("correlation_unit", &Unnamed::correlation_unit),
    field("dominant_period_mm", &Unnamed::dominant_period_mm),
    field("odd_share", &Unnamed::odd_share),
    field("forms", &Unnamed::forms, "formulas that describe it, best first"),
    field("to_confirm", &Unnamed::to_confirm, "what to measure before a form is taken for a cause"),
    field("curve", &Unnamed::curve));

template <>
inline constexpr auto kRecord<BlockPrediction> =
    record("BlockPrediction", "A single profile predicted over gaps of one length.",
           field("block_mm", &BlockPrediction::block_mm),
           field("before_rms_um", &BlockPrediction::before_rms_um, "declared model"),
           field("after_rms_um", &BlockPrediction::after_rms_um, "final model"),
           field("before_rms_urad", &BlockPrediction::before_rms_urad),
           field("after_rms_urad", &BlockPrediction::after_rms_urad));

template <>
inline constexpr auto kRecord<Blunder> =
    record("Blunder", "A slip of the hand that would make one profile agree with the others.",
           field("profile", &Blunder::profile), field("what", &Blunder::what),
           field("delta_bic", &Blunder::delta_bic, "against the profile as it is"));

template <>
inline constexpr auto kRecord<NotTestable> = record("NotTestable",
                                                    "An effect the data cannot be asked for.",
                                                    field("effect", &NotTestable::effect),
                                                    field("needs", &NotTestable::needs));

template <>
inline constexpr auto kRecord<NotSeparable> =
    record("NotSeparable", "An effect whose columns are those of another here.",
           field("effect", &NotSeparable::effect), field("same_as", &NotSeparable::same_as));

template <>
inline constexpr auto kRecord<LeftEffect> =
    record("Left", "An effect that was accepted and has left the model again.",
           field("effect", &LeftEffect::effect), field("reason", &LeftEffect::reason));

template <>
inline constexpr auto kRecord<LimitAtShape> = record("LimitAtShape",
                                                     "A detection limit at one shape.",
                                                     field("shape", &LimitAtShape::shape),
                                                     field("value", &LimitAtShape::value));

template <>
inline constexpr auto kRecord<DetectionLimit> =
    record("DetectionLimit", "The size an effect must have to be found with 80 % probability.",
           field("effect", &DetectionLimit::effect), field("parameter", &DetectionLimit::parameter),
           field("unit", &DetectionLimit::unit),
           field("value", &DetectionLimit::value, "none: found at no size a workpiece has"),
           field("at", &DetectionLimit::at), field("by_shape", &DetectionLimit::by_shape),
           field("squareness_rad", &DetectionLimit::squareness_rad,
                 "the most that it moves Δβxz at any shape while its gain is just not seen"),
           field("straightness_um", &DetectionLimit::straightness_um,
                 "the most that it moves E_ZX of the end-point line so"));

template <>
inline constexpr auto kRecord<Fragile> =
    record("Fragile", "The smallest change of one gate that would have changed the verdict.",
           field("gate", &Fragile::gate), field("value", &Fragile::value),
           field("verdict", &Fragile::verdict));

template <>
inline constexpr auto kRecord<SharedResidual> =
    record("SharedResidual", "What traces of different surfaces by one instrument have in common.",
           field("profiles", &SharedResidual::profiles),
           field("correlation", &SharedResidual::correlation, "of their residuals"),
           field("rms_um", &SharedResidual::rms_um, "of what they share"),
           field("rms_urad", &SharedResidual::rms_urad),
           field("p_value", &SharedResidual::p_value, "of as much by chance"),
           field("significant", &SharedResidual::significant, "then it is the instrument's error"),
           field("lacked_by", &SharedResidual::lacked_by,
                 "profiles of further surfaces: then it need not be"));

template <>
inline constexpr auto kRecord<NextCut> =
    record("NextCut", "The cut or trace to make next: the first of slideway plan.",
           field("name", &NextCut::name), field("what", &NextCut::what),
           field("reason", &NextCut::reason));

template <>
inline constexpr auto kRecord<TraceResult> = record(
    "Trace", "The closed loop.", field("verdict", &TraceResult::verdict),
    field("unfinished", &TraceResult::unfinished,
          "the time limit ended the search: no effect is named"),
    field("not_looked_at", &TraceResult::not_looked_at, "what the time limit left out"),
    field("gates", &TraceResult::gates, "the limits that were used"),
    field("fragile", &TraceResult::fragile, "none: no change of one gate within its range does"),
    field("rounds", &TraceResult::rounds), field("unnamed", &TraceResult::unnamed),
    field("cross_validation", &TraceResult::cross_validation, "of a single profile"),
    field("gain", &TraceResult::gain, "of the accepted effects, by cross_validation"),
    field("instrument", &TraceResult::instrument, "pairs of one instrument and two surfaces"),
    field("blunders", &TraceResult::blunders, "rivals, most likely first; then no effect is named"),
    field("advice", &TraceResult::advice),
    field("next_cut", &TraceResult::next_cut,
          "none: nothing is open and nothing unseen moves the squareness by more than its U"),
    field("not_testable", &TraceResult::not_testable),
    field("not_separable", &TraceResult::not_separable),
    field("refused", &TraceResult::refused, "of the last search, best first"),
    field("left", &TraceResult::left), field("detection_limits", &TraceResult::detection_limits),
    field("lack_of_fit_p", &TraceResult::lack_of_fit_p, "of the final residual"),
    field("searches", &TraceResult::searches, "sets of effects whose residual was searched"),
    field("notes", &TraceResult::notes));

template <>
inline constexpr auto kRecord<EffectInModel> = record(
    "EffectInModel", "An effect of the final model, as the catalogue has it.",
    field("name", &EffectInModel::name), field("standard_name", &EffectInModel::standard_name),
    field("formula", &EffectInModel::formula), field("source", &EffectInModel::source),
    field("cause", &EffectInModel::cause), field("clock", &EffectInModel::clock),
    field("confounded_with", &EffectInModel::confounded_with),
    field("separated_by", &EffectInModel::separated_by),
    field("added", &EffectInModel::added, "by the closed loop"));

/// A member of the setup inside a ProfileSetup.
template <auto member>
inline constexpr auto kOfSetup = [](auto& each) -> auto& {
  return each.setup.*member;
};

template <>
inline constexpr auto kRecord<ProfileSetup> = record(
    "Setup", "How one profile was cut and measured.", field("profile", &ProfileSetup::profile),
    field("center_mm", kOfSetup<&Setup::center_mm>),
    field("spindle_position_mm", kOfSetup<&Setup::spindle_position_mm>),
    field("z_mm", kOfSetup<&Setup::z_mm>), field("overhang_mm", kOfSetup<&Setup::overhang_mm>),
    field("base_mm", kOfSetup<&Setup::base_mm>),
    field("feed_mm_per_min", kOfSetup<&Setup::feed_mm_per_min>),
    field("spindle_rpm", kOfSetup<&Setup::spindle_rpm>),
    field("cut_direction", kOfSetup<&Setup::cut_direction>),
    field("cut_radius_mm", kOfSetup<&Setup::cut_radius_mm>),
    field("start_s", kOfSetup<&Setup::start_s>),
    field("traverse_mm_per_s", kOfSetup<&Setup::traverse_mm_per_s>));

template <>
inline constexpr auto kRecord<Body> = record("Body", "One body of the lower-body array, Eq. (1).",
                                             field("name", &Body::name),
                                             field("lower", &Body::lower),
                                             field("axis", &Body::axis));

template <>
inline constexpr auto kRecord<PriorSummary> = record("Prior", "A prior of the problem file.",
                                                     field("parameter", &PriorSummary::parameter),
                                                     field("value", &PriorSummary::value),
                                                     field("standard_uncertainty",
                                                           &PriorSummary::standard_uncertainty));

template <>
inline constexpr auto kRecord<Runout> =
    record("Runout", "The run-out measurement of Eq. (21).", field("r_um", &Runout::r_um),
           field("p_um", &Runout::p_um), field("diameter_mm", &Runout::diameter_mm),
           field("standard_uncertainty_um", &Runout::standard_uncertainty_um));

template <>
inline constexpr auto kRecord<OptionsSummary> = record(
    "Options", "What the problem file asked for.", field("lever", &OptionsSummary::lever),
    field("bodies", &OptionsSummary::bodies), field("priors", &OptionsSummary::priors),
    field("runout", &OptionsSummary::runout), field("candidates", &OptionsSummary::candidates),
    field("max_effects", &OptionsSummary::max_effects),
    field("significance", &OptionsSummary::significance));

template <>
inline constexpr auto kRecord<PredictedFlatness> = record(
    "WhatIf", "Flatness of a profile, measured or with effects taken out.",
    field("profile", &PredictedFlatness::profile),
    field("corrected", &PredictedFlatness::corrected, "an effect; all; empty: as measured"),
    field("pv_um", &PredictedFlatness::pv_um), field("rms_um", &PredictedFlatness::rms_um),
    field("pv_urad", &PredictedFlatness::pv_urad), field("rms_urad", &PredictedFlatness::rms_urad));

template <>
inline constexpr auto kRecord<Spectrum> = record("Spectrum", "Amplitude of each frequency.",
                                                 drawn("cycles_per_mm",
                                                       &Spectrum::cycles_per_sample),
                                                 drawn("amplitude", &Spectrum::amplitude));

template <>
inline constexpr auto kRecord<Envelope> =
    record("Envelope", "Lowest and highest value of each of equal stretches of the trace.",
           drawn("low", &Envelope::low), drawn("high", &Envelope::high));

template <>
inline constexpr auto kRecord<ProfileCurves> = record(
    "ProfileCurves", "What is drawn of one profile, in `unit`.",
    field("profile", &ProfileCurves::profile), field("role", &ProfileCurves::role),
    field("unit", &ProfileCurves::unit), field("first_mm", &ProfileCurves::first_mm),
    field("last_mm", &ProfileCurves::last_mm),
    drawn("position_mm", &ProfileCurves::position_mm, "", 7), drawn("raw", &ProfileCurves::raw),
    drawn("low_band", &ProfileCurves::low_band),
    drawn("model_before", &ProfileCurves::model_before, "declared model, with the levelling"),
    drawn("residual_before", &ProfileCurves::residual_before),
    drawn("model_after", &ProfileCurves::model_after,
          "final model; empty where the loop has added nothing"),
    drawn("residual_after", &ProfileCurves::residual_after),
    drawn("contribution_position_mm", &ProfileCurves::contribution_position_mm, "", 7),
    field("effects", &ProfileCurves::effects, "of the final model"),
    drawn("contributions", &ProfileCurves::contributions, "of each effect"),
    drawn("correlation", &ProfileCurves::correlation, "of the effects among themselves"),
    field("lag_mm", &ProfileCurves::lag_mm), field("white_limit", &ProfileCurves::white_limit),
    drawn("autocorrelation_before", &ProfileCurves::autocorrelation_before),
    drawn("autocorrelation_after", &ProfileCurves::autocorrelation_after),
    field("spectrum_before", &ProfileCurves::spectrum_before),
    field("spectrum_after", &ProfileCurves::spectrum_after),
    field("approximations", &ProfileCurves::approximations, "a_1 ..."),
    field("details", &ProfileCurves::details, "d_1 ..."));

template <>
inline constexpr auto kRecord<Curves> = record("Curves", "What is drawn.",
                                               field("profiles", &Curves::profiles));

template <auto member>
inline constexpr auto kOfResult = [](auto& analysis) -> auto& {
  return analysis.result.*member;
};
template <auto member>
inline constexpr auto kOfRanking = [](auto& analysis) -> auto& {
  return analysis.result.ranking.*member;
};
template <auto member>
inline constexpr auto kOfDetails = [](auto& analysis) -> auto& {
  return analysis.details.*member;
};

template <>
inline constexpr auto kRecord<Analysis> = record(
    "Report", "All that is found in one problem.", field("schema", &Analysis::schema),
    field("version", kOfResult<&Result::version>), field("title", kOfResult<&Result::title>),
    field("about", kOfResult<&Result::about>, "[about] of the problem file"),
    field("assumed", kOfResult<&Result::assumed>, "what the problem file leaves to defaults"),
    field("inputs", kOfResult<&Result::inputs>), field("closure", kOfResult<&Result::closure>),
    field("travel", kOfResult<&Result::travel>), field("low_band", kOfResult<&Result::low_band>),
    field("ranking", kOfRanking<&RankingResult::entries>),
    field("candidate_correlations", kOfRanking<&RankingResult::among_candidates>),
    field("ranking_notes", kOfRanking<&RankingResult::notes>),
    field("dominant", kOfResult<&Result::dominant>),
    field("declared", kOfResult<&Result::declared>, "the problem as given"),
    field("final", kOfResult<&Result::final>,
          "the declared effects and those accepted: what the program stands behind"),
    field("crosscheck", kOfResult<&Result::crosscheck>),
    field("conformity", kOfResult<&Result::conformity>),
    field("trace", &Analysis::trace, "the closed loop; none: it was not run"),
    field("notes", kOfResult<&Result::notes>), field("model", kOfDetails<&Details::effects>),
    field("setups", kOfDetails<&Details::setups>), field("options", kOfDetails<&Details::options>),
    field("what_if", kOfDetails<&Details::what_if>), field("curves", kOfDetails<&Details::curves>));

}  // namespace slideway
