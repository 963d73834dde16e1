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
  double delta_bic = 0.0;  // of adding it; below 0 it would pay
  double p_value = 1.0;    // chance that the search finds as much in noise, over all candidates
  std::optional<double> rms_um;  // residual of the height profiles with it
  std::vector<FittedParameter> parameters;
  std::string refused;  // why it was not accepted; empty: it was, or is a rival of the accepted
};

/// One effect that entered the model.
struct TraceRound {
  std::string accepted;
  std::vector<std::string> ambiguous_with;  // rivals within 10 of its BIC, in the final model
  std::optional<double> before_rms_um, after_rms_um;      // residual of the height profiles
  std::optional<double> before_rms_urad, after_rms_urad;  // and of the slope profiles
  /// Predicted profiles: role = "holdout" where there are any, else each fitted profile in turn,
  /// left out; none where what is left could not tell the effect.
  std::optional<double> before_holdout_rms_um, after_holdout_rms_um;
  double delta_bic = 0.0;
  double p_value = 1.0;
  std::vector<FittedParameter> parameters;  // of the effect, in the final fit
  std::vector<TriedEffect> candidates;      // what else was tried in that round, best first
};

/// What is left and has no name.
struct Unnamed {
  double rms = 0.0, pv = 0.0;         // of the smooth part, in the profile where it stands out most
  std::string unit;                   // "um" or, of a slope profile, "urad"
  double p_value = 1.0;               // lack of fit against the noise
  std::string profile;                // where it is largest
  double from_mm = 0.0, to_mm = 0.0;  // trace positions between which it is above half its peak
  std::string clock;                  // "r" "t" "s" "X", or "per profile": where it is most alike
  std::vector<std::pair<std::string, double>> log_evidence;  // of each clock, best = 0
  double correlation_length = 0.0;                           // on that clock
  std::string correlation_unit;
  std::optional<double> dominant_period_mm;
  std::optional<double> odd_share;  // of its square on a diameter, 0: even, 1: odd
};

/// The size an effect must have to be found with 80 % probability.
struct DetectionLimit {
  std::string effect, parameter, unit;
  double value = 0.0;
  std::string at;  // shape it holds for: "time_constant_s = 120"; empty: the effect has none
  std::vector<std::pair<double, double>> by_shape;  // shape and size, from end to end of the search
};

struct TraceResult {
  /// "nothing_missing" | "explained" | "ambiguous" | "unnamed" | "not_identifiable"
  std::string verdict;
  std::vector<TraceRound> rounds;
  std::optional<Unnamed> unnamed;
  std::vector<std::string> advice;
  std::vector<std::pair<std::string, std::string>> not_testable;   // effect, what it needs
  std::vector<std::pair<std::string, std::string>> not_separable;  // effect, what it is one with
  std::vector<TriedEffect> refused;                                // of the last search, best first
  std::vector<DetectionLimit> detection_limits;
  double lack_of_fit_p = 1.0;  // of the final residual
  std::optional<double> before_rms_um, after_rms_um, before_rms_urad, after_rms_urad;
  std::vector<FittedParameter> before, after;
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
