#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "slideway/identify/budget.hpp"
#include "slideway/identify/fit.hpp"
#include "slideway/identify/straightness.hpp"
#include "slideway/signal/spectrum.hpp"
#include "slideway/signal/thin.hpp"

/// What a report shows beside the verdict: curves, budget, predictions, the conditions of the
/// measurement. Made only for a report that is written.
namespace slideway {

/// Flatness of a profile in the low band, about the levelling it came with.
struct PredictedFlatness {
  std::string corrected;  // effect; "" as measured; "all"
  double pv = 0.0, rms = 0.0;
};

/// What is drawn of one profile; heights in µm, slopes in µrad. Long series are thinned so that
/// their extremes survive.
struct ProfileCurves {
  std::string profile, role, unit;  // "um" or "urad"
  Setup setup;
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
  std::vector<PredictedFlatness> flatness;
};

/// An effect of the final model, as the catalogue has it.
struct EffectInModel {
  Description description;
  bool added = false;  // by the closed loop
};

struct Details {
  std::vector<ProfileCurves> profiles;
  std::vector<EffectInModel> effects;
  std::optional<IdentifiedStraightness> straightness;  // of the final model
  std::vector<Budget> budget;                          // of the final model
  Problem problem;                                     // the conditions and options
};

/// @param before  the declared model
/// @param after   with the effects the loop has added; null: none
/// @param more    what the structure without a name adds
Details make_details(const Problem& problem, const FittedModel& before, const FittedModel* after,
                     const MoreVariance& more = {});

}  // namespace slideway
