#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "slideway/identify/fit.hpp"
#include "slideway/identify/result.hpp"
#include "slideway/signal/spectrum.hpp"
#include "slideway/signal/thin.hpp"

/// What a report shows beside the verdict: curves, predictions, the conditions of the measurement.
/// Made only for a report that is written.
namespace slideway {

/// Flatness of a profile in the low band, about the levelling it came with.
struct PredictedFlatness {
  std::string profile;
  std::string corrected;  // effect; "" as measured; "all"
  std::optional<double> pv_um, rms_um, pv_urad, rms_urad;
};

/// What is drawn of one profile, in `unit`. Long series are thinned so that their extremes survive.
struct ProfileCurves {
  std::string profile;
  Role role = Role::fit;
  MicroUnit unit = MicroUnit::um;
  double first_mm = 0.0, last_mm = 0.0;
  std::vector<double> position_mm, raw, low_band;
  // The model comes with the levelling; *_after is empty where the loop has added nothing.
  std::vector<double> model_before, residual_before, model_after, residual_after;
  std::vector<double> contribution_position_mm;
  std::vector<std::string> effects;                // of the final model
  std::vector<std::vector<double>> contributions;  // of each effect, at full length
  std::vector<std::vector<double>> correlation;    // of the effects among themselves, low band
  double lag_mm = 0.0;                             // between two values of the low band
  double white_limit = 0.0;  // 95 % of the coefficients of white noise lie within
  std::vector<double> autocorrelation_before, autocorrelation_after;  // of the residual, lag 0 ...
  Spectrum spectrum_before, spectrum_after;                           // cycles per mm
  std::vector<Envelope> approximations, details;                      // a_1 ..., d_1 ...
};

/// An effect of the final model, as the catalogue has it.
struct EffectInModel {
  std::string name, standard_name, formula, source, cause, clock, confounded_with, separated_by;
  bool added = false;  // by the closed loop
};

/// How one profile was cut and measured.
struct ProfileSetup {
  std::string profile;
  Setup setup;
};

/// A prior of the problem file.
struct PriorSummary {
  std::string parameter;
  double value = 0.0, standard_uncertainty = 0.0;
};

/// What the problem file asked for.
struct OptionsSummary {
  Lever lever = Lever::paper;
  std::vector<Body> bodies;
  std::vector<PriorSummary> priors;
  std::optional<Runout> runout;
  std::vector<std::string> candidates;
  int max_effects = 0;
  double significance = 0.0;
};

struct Curves {
  std::vector<ProfileCurves> profiles;
};

struct Details {
  std::vector<EffectInModel> effects;
  std::vector<ProfileSetup> setups;
  std::optional<OptionsSummary> options;
  std::vector<PredictedFlatness> what_if;
  std::optional<Curves> curves;
};

/// @param before  the declared model
/// @param after   with the effects the loop has added; null: none
Details make_details(const Problem& problem, const FittedModel& before, const FittedModel* after,
                     bool with_curves);

}  // namespace slideway
