#include "html_curves.hpp"

#include <algorithm>
#include <numeric>

#include "html_parts.hpp"

namespace slideway {
namespace {

/// Subtracts the line through the origin of least squares: values -= (Σ values b / Σ b²) b.
void take_out(const std::vector<double>& base, std::vector<double>& values) {
  const double square = std::inner_product(base.begin(), base.end(), base.begin(), 0.0);
  if (!(square > 0.0)) return;
  const double factor = std::inner_product(base.begin(), base.end(), values.begin(), 0.0) / square;
  for (std::size_t i = 0; i < values.size(); ++i) values[i] -= factor * base[i];
}

bool is_free(const ModelResult& model, const std::string& nuisance) {
  return std::ranges::any_of(model.nuisances,
                             [&](const FittedParameter& p) { return p.name == nuisance; });
}

Plot panel(const Plot::Text& text, const CurveSet& set) {
  Plot plot(text);
  if (set.position_mm.size() <= kFewReadings) plot.markers();
  for (const auto& [name, style, values] : set.curves)
    if (!values.empty()) plot.line(name, style, set.position_mm, values);
  return plot;
}

}  // namespace

CurveSet through_middles(CurveSet set) {
  const std::size_t count = set.position_mm.size();
  std::vector<std::vector<double>*> curves;
  for (NamedCurve& each : set.curves)
    if (each.values.size() == count && count > 0) curves.push_back(&each.values);
  const auto alike = [&](std::size_t a, std::size_t b) {
    return std::ranges::all_of(curves,
                               [&](const auto* values) { return (*values)[a] == (*values)[b]; });
  };
  std::size_t kept = 0;
  for (std::size_t first = 0, last = 0; first < count; first = last + 1, ++kept) {
    for (last = first; last + 1 < count && alike(first, last + 1);) ++last;
    set.position_mm[kept] = 0.5 * (set.position_mm[first] + set.position_mm[last]);
    for (std::vector<double>* values : curves) (*values)[kept] = (*values)[first];
  }
  set.position_mm.resize(kept);
  for (std::vector<double>* values : curves) values->resize(kept);
  return set;
}

bool is_filtered(const ProfileCurves& curves) { return !curves.approximations.empty(); }

CurveSet form_curves(const ProfileCurves& curves) {
  const bool added = !curves.residual_after.empty();
  return through_middles(
      {curves.position_mm,
       {{is_filtered(curves) ? "low band" : "as measured", "low", curves.low_band},
        {added ? "declared model" : "model", added ? "before" : "after", curves.model_before},
        {"final model", "after", curves.model_after}}});
}

CurveSet residual_curves(const ProfileCurves& curves) {
  const bool added = !curves.residual_after.empty();
  return through_middles(
      {curves.position_mm,
       {{added ? "declared model" : "residual", added ? "before" : "after", curves.residual_before},
        {"final model", "after", curves.residual_after}}});
}

std::vector<double> levelled(const ModelResult& model, const std::string& profile,
                             const std::vector<double>& x, std::vector<double> values) {
  const std::vector<double> one(values.size(), 1.0);
  std::vector<double> slope = x;
  if (is_free(model, profile + ".offset")) {
    take_out(one, slope);
    take_out(one, values);
  }
  if (is_free(model, profile + ".tilt")) take_out(slope, values);
  return values;
}

std::vector<double> interpolated(const std::vector<double>& x, const std::vector<double>& values,
                                 const std::vector<double>& at) {
  std::vector<double> out;
  for (const double place : at) {
    const std::size_t right = std::clamp<std::size_t>(
        static_cast<std::size_t>(std::ranges::lower_bound(x, place) - x.begin()), 1, x.size() - 1);
    const double width = x[right] - x[right - 1];
    const double share = width > 0.0 ? std::clamp((place - x[right - 1]) / width, 0.0, 1.0) : 0.0;
    out.push_back((1.0 - share) * values[right - 1] + share * values[right]);
  }
  return out;
}

Plot form_panel(const ProfileCurves& curves) {
  CurveSet shown = form_curves(curves);
  const bool added = !curves.residual_after.empty();
  shown.curves.erase(shown.curves.begin() + (added ? 1 : 2));  // of two models the final one
  shown.curves.back().name = "model";
  const char* const quantity = curves.unit == MicroUnit::urad ? "slope, " : "height, ";
  return panel(
      {"picture-form", "Profile " + curves.profile, "The measured profile and the final model.",
       "trace position, mm", quantity + unit_name(curves.unit)},
      shown);
}

Plot residual_panel(const ProfileCurves& curves) {
  CurveSet shown = residual_curves(curves);
  const bool added = !curves.residual_after.empty();
  shown.curves.front().name = added ? "declared model: an effect is missing" : "left over";
  shown.curves.back().name = added ? "with the effect that was found" : "left over";
  if (!added) shown.curves.pop_back();
  return panel({"picture-residual", "What the model leaves",
                "The residual of the declared and of the final model on one scale.",
                "trace position, mm", "left over, " + unit_name(curves.unit)},
               shown);
}

}  // namespace slideway
