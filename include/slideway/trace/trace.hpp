#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "slideway/identify/problem.hpp"
#include "slideway/identify/result.hpp"

/// The closed loop: finds what the declared model leaves over, traces it to an effect the model
/// lacks, adds the effect and fits again, until the residual is noise or has no name.
namespace slideway {

/// A candidate as a round saw it, best shape.
struct TriedEffect {
  std::string effect;
  std::vector<std::string> profiles;  // those it acts in; empty: all
  double delta_bic = 0.0;             // of adding it; below 0 it would pay
  double p_value = 1.0;  // chance that the search finds as much in noise, over all candidates
  std::optional<double> rms_um;  // residual of the height profiles with it
  std::vector<FittedParameter> parameters;
  std::optional<std::string> refused;  // why it was not accepted; none: it was, or is a rival
};

/// Among the rivals of an effect: something without a name explains as much.
inline constexpr const char* kUnnamedRival = "unnamed";
inline constexpr const char* kInstrument = "instrument";  // accepted: its error, not the slide's

/// One effect that entered the model.
struct TraceRound {
  std::string accepted;
  std::vector<std::string> profiles;        // those it acts in; empty: all
  std::vector<std::string> ambiguous_with;  // rivals within 10 of its BIC, in the final model
  std::optional<double> before_rms_um, after_rms_um;      // residual of the height profiles
  std::optional<double> before_rms_urad, after_rms_urad;  // and of the slope profiles
  /// Predicted profiles: role = "holdout" where there are any, else each fitted profile in turn,
  /// left out; none where what is left could not tell the effect.
  std::optional<double> before_holdout_rms_um, after_holdout_rms_um;
  double delta_bic = 0.0;
  double p_value = 1.0;
  double stability = 1.0;                   // share of the resamples that choose the same effect
  std::vector<FittedParameter> parameters;  // of the effect, in the final fit
  std::vector<TriedEffect> candidates;      // what else was tried in that round, best first
};

/// A single profile predicted over gaps of one length, without and with the accepted effects.
struct BlockPrediction {
  double block_mm = 0.0;
  std::optional<double> before_rms_um, after_rms_um, before_rms_urad, after_rms_urad;
};

/// What the accepted effects bring: at every length of gap, or over short gaps only.
enum class Gain { prediction, interpolation };
template <>
inline constexpr std::array<std::string_view, 2> kTexts<Gain>{"prediction", "interpolation"};

/// A slip of the hand that would make one profile agree with the others.
enum class BlunderKind {
  sign,
  inch,
  per_inch,
  metre,
  per_metre,
  arcsecond,
  per_arcsecond,
  position_inch,
  position_per_inch,
  position_metre,
  position_per_metre,
  cut_direction,
  clock
};
template <>
inline constexpr std::array<std::string_view, 13> kTexts<BlunderKind>{
    "wrong sign",
    "values 25.4 times too small",
    "values 25.4 times too large",
    "values 1000 times too small",
    "values 1000 times too large",
    "values 4.85 times too small",
    "values 4.85 times too large",
    "positions 25.4 times too small",
    "positions 25.4 times too large",
    "positions 1000 times too small",
    "positions 1000 times too large",
    "wrong cut_direction",
    "wrong start_s"};

struct Blunder {
  std::string profile;
  BlunderKind what = BlunderKind::sign;
  double delta_bic = 0.0;  // against the profile as it is
  double left = 0.0;       // share of the square of the disagreement that it leaves
};

/// What traces of different surfaces, read by one instrument, have in common.
struct SharedResidual {
  std::vector<std::string> profiles;       // two, of different surfaces
  double correlation = 0.0;                // of their residuals
  std::optional<double> rms_um, rms_urad;  // of what they share
  double p_value = 1.0;                    // of as much by chance
  bool significant = false;                // then it is the instrument's error
  std::vector<std::string> lacked_by;      // profiles of further surfaces: then it need not be
};

/// A short formula that describes what is left without a name. It is no cause.
struct UnnamedForm {
  std::string form;                   // "bump + bump"
  std::string formula;                // in µm (of slopes: µrad)
  std::vector<std::string> profiles;  // those it describes; empty: all
  std::string instead_of;             // the accepted effect it takes the place of; "": none
  std::vector<FittedParameter> parameters;
  double delta_bic = 0.0;                                 // against the effects as accepted
  std::optional<double> before_rms_um, after_rms_um;      // residual of the height profiles
  std::optional<double> before_rms_urad, after_rms_urad;  // and of the slope profiles
  /// Predicted profiles, as those of a round, without the form and what it takes the place of, and
  /// with the form.
  std::optional<double> before_holdout_rms_um, after_holdout_rms_um;
  std::string candidate;  // [[trace.candidate]] of a problem file
};

/// What is left without a name, as a curve over its variable.
struct UnnamedCurve {
  std::string variable, unit;  // "t", "s"
  MicroUnit value_unit = MicroUnit::um;
  std::vector<double> at, residual, expanded_uncertainty;
};

/// What is left and has no name.
struct Unnamed {
  /// Of the smooth part, and of the wave if one is left, in the profile where it stands out most.
  std::optional<double> rms_um, pv_um, rms_urad, pv_urad;
  bool has_folded_wave = false;       // of which the low band does not tell the rate
  double p_value = 1.0;               // lack of fit against the noise
  std::string profile;                // where it is largest
  double from_mm = 0.0, to_mm = 0.0;  // trace positions between which it is above half its peak
  std::string clock;                  // "r" "t" "s" "X", or "per profile": where it is most alike
  std::vector<std::pair<std::string, double>> log_evidence;  // of each clock, best = 0
  double correlation_length = 0.0;                           // on that clock
  std::string correlation_unit;
  std::optional<double> dominant_period_mm;
  std::optional<double> odd_share;  // of its square on a diameter, 0: even, 1: odd
  std::vector<UnnamedForm> forms;   // that describe it, best first
  std::string to_confirm;           // what to measure before a form is taken for a cause
  UnnamedCurve curve;
};

/// An effect the data cannot be asked for.
struct NotTestable {
  std::string effect, needs;
};

/// An effect whose columns, or one of them, are those of another here.
struct NotSeparable {
  std::string effect, same_as;
};

/// An effect that was accepted and has left the model again.
struct LeftEffect {
  std::string effect, reason;
};

/// A size found with 80 % probability, at one shape.
struct LimitAtShape {
  double shape = 0.0;
  std::optional<double> value;
};

/// The size an effect must have to be found with 80 % probability.
struct DetectionLimit {
  std::string effect, parameter, unit;
  std::optional<double> value;  // none: it would not be found at any size a workpiece has
  std::string at;               // shape it holds for: "time_constant_s = 120"; "": it has none
  std::vector<LimitAtShape> by_shape;  // from end to end of the search
  // Most that it moves Δβxz, and E_ZX, while it is just not seen.
  std::optional<double> squareness_rad, straightness_um;
};

enum class TraceVerdict {
  nothing_missing,   // the residual is no more than noise
  explained,         // one or more named effects, each without a rival
  ambiguous,         // an effect is missing that the data cannot tell from a rival
  unnamed,           // structure is left that no effect of the catalogue explains
  not_identifiable,  // a form is there of which the data cannot tell what makes it
};
template <>
inline constexpr std::array<std::string_view, 5> kTexts<TraceVerdict>{
    "nothing_missing", "explained", "ambiguous", "unnamed", "not_identifiable"};

/// The smallest change of one gate within its range that would have changed the verdict.
struct Fragile {
  std::string gate;
  double value = 0.0;
  TraceVerdict verdict = TraceVerdict::nothing_missing;  // there
};

/// The cut or trace to make next: next_cut().
struct NextCut {
  std::string name, what;  // "feed2-feed0.5", "a cut at 0.5 mm/min"
  std::string reason;      // in words
};

struct TraceResult {
  TraceVerdict verdict = TraceVerdict::nothing_missing;
  bool unfinished = false;                 // the time limit ended the search: no effect is named
  std::vector<std::string> not_looked_at;  // what else the time limit left out
  std::vector<std::pair<std::string, double>> gates;  // the values that were used
  std::optional<Fragile> fragile;                     // none: no such change does
  std::vector<TraceRound> rounds;
  std::optional<Unnamed> unnamed;
  std::vector<BlockPrediction> cross_validation;  // of a single profile, shortest gaps first
  std::optional<Gain> gain;                       // of the accepted effects, by those
  std::vector<SharedResidual> instrument;         // pairs of one instrument and two surfaces
  std::vector<Blunder> blunders;  // rivals, most likely first; effects are then not looked for
  std::vector<std::string> advice;
  std::optional<NextCut> next_cut;  // where numbers are open, or effects may move them unseen
  std::vector<NotTestable> not_testable;
  std::vector<NotSeparable> not_separable;
  std::vector<TriedEffect> refused;  // of the last search, best first
  std::vector<LeftEffect> left;
  std::vector<DetectionLimit> detection_limits;
  double lack_of_fit_p = 1.0;  // of the final residual
  std::size_t searches = 0;    // sets of effects whose residual was searched, each once
  std::vector<std::string> notes;
};

/// Told what the loop is at, for who waits, and which part of that is done, 0 to 1: "searching
/// round 2", 0. In the thread that closes the loop.
using Progress = std::function<void(const std::string& stage, double done)>;

/// Closes the loop on a problem whose declared model has been identified.
/// @throws UsageError, DataError  as identify()
TraceResult close_loop(const Problem& problem, const std::vector<Profile>& profiles,
                       const Progress& progress = {});

/// True if the verdict is negative for `--strict`: structure without a name, not identifiable.
bool is_negative(const TraceResult& trace);

}  // namespace slideway
