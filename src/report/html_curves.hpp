#pragma once

#include <string>
#include <vector>

#include "html_plot.hpp"
#include "slideway/identify/model_result.hpp"
#include "slideway/trace/details.hpp"

/// What the pictures of a profile draw.
namespace slideway {

inline constexpr std::size_t kFewReadings = 120;  // that each have a marker

struct NamedCurve {
  std::string name, style;
  std::vector<double> values;  // as many as positions, or none
};

/// Curves on common positions.
struct CurveSet {
  std::vector<double> position_mm;
  std::vector<NamedCurve> curves;
};

/// A low band of db1 is a staircase: a stretch in which all curves are constant becomes one point
/// in its middle.
CurveSet through_middles(CurveSet set);

/// Whether what is fitted is a low band, not the profile as it is.
bool is_filtered(const ProfileCurves& curves);

/// What is fitted, and the models with the levelling of the trace.
CurveSet form_curves(const ProfileCurves& curves);

/// What the declared and the final model leave of it.
CurveSet residual_curves(const ProfileCurves& curves);

/// Values without the offset and the tilt that the model left free in the profile.
std::vector<double> levelled(const ModelResult& model, const std::string& profile,
                             const std::vector<double>& x, std::vector<double> values);

/// A curve at other positions, linear between its points. REQUIRES rising positions.
std::vector<double> interpolated(const std::vector<double>& x, const std::vector<double>& values,
                                 const std::vector<double>& at);

/// The picture of a report: a profile with the model, and what each model leaves of it.
Plot form_panel(const ProfileCurves& curves);
Plot residual_panel(const ProfileCurves& curves);

}  // namespace slideway
