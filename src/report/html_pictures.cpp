#include <cmath>

#include "html_parts.hpp"
#include "slideway/identify/result_fields.hpp"
#include "slideway/report/number.hpp"

namespace slideway {
namespace {

// --- straightness ---------------------------------------------------------------------------

Html straightness_errors(const Straightness& form) {
  HtmlTable table(
      "Straightness error: largest positive minus largest negative deviation from the stated line",
      {{"reference line", HtmlColumn::text},
       {"error ± U, µm", HtmlColumn::number},
       {"k", HtmlColumn::number},
       {"highest, µm", HtmlColumn::number},
       {"at x, mm", HtmlColumn::number},
       {"lowest, µm", HtmlColumn::number},
       {"at x, mm", HtmlColumn::number}});
  for (const StraightnessError& e : form.errors)
    table.add({text_of(e.line), html_value(e), html_number(e.coverage_factor, 3),
               html_number(e.highest_um, 3), html_number(e.highest_at_mm),
               html_number(e.lowest_um, 3), html_number(e.lowest_at_mm)});
  return table.html();
}

Html station_table(const Straightness& form) {
  HtmlTable table("Station heights: deviation from the line through the end points",
                  {{"x, mm", HtmlColumn::number}, {"deviation ± U, µm", HtmlColumn::number}});
  for (const StraightnessStation& at : form.stations) {
    QuantityValue height;
    height.value = at.deviation_um;
    height.expanded_uncertainty = at.expanded_uncertainty_um;
    table.add({html_number(at.position_mm, 6), html_value(height)});
  }
  return table.html();
}

Html straightness_curve(const StraightnessCurve& curve) {
  const std::vector<double>&x = curve.position_mm, &deviation = curve.deviation_um,
        &U = curve.expanded_uncertainty_um;
  if (x.size() < 2 || x.size() != deviation.size() || x.size() != U.size()) return {};
  std::vector<double> low = deviation, high = deviation;
  for (std::size_t i = 0; i < U.size(); ++i) {
    low[i] -= U[i];
    high[i] += U[i];
  }
  Plot plot({"straightness-curve", "Identified straightness of the X slide",
             "Deviation from the line through the end points over the travel, with its expanded "
             "uncertainty.",
             "slide coordinate x, mm", "deviation, µm"});
  plot.band("± U", "band", x, low, high)
      .line("deviation from the end-point line", "after", x, deviation)
      .level("end-point line", "limit", 0.0);
  return html_figure(
      plot, "Straightness error motion " + html_symbol("E_ZX") +
                " of the X slide over the travel that was measured, " + html_number(x.front(), 5) +
                " to " + html_number(x.back(), 5) +
                " mm, positive along +Z; band: expanded uncertainty. " + bold("Good:") +
                " the band is narrow beside the curve (the form is known) and the error is within "
                "the machine's tolerance. The three reference lines give three different numbers, "
                "all of them valid: a tolerance must state its line.");
}

// --- correlations -----------------------------------------------------------------------------

Html running(const Analysis& analysis, const std::string& profile, const std::string& id) {
  Plot plot({id + "-running", "Profile " + profile + ": running correlation",
             "Correlation coefficient of each effect with the profile from its start up to a "
             "position, raw and in the low band.",
             "trace position, mm", "coefficient"});
  std::size_t style = 0;
  for (const Ranking& entry : analysis.result.ranking.entries) {
    if (entry.profile != profile || entry.running.raw.empty()) continue;
    const std::string own = numbered("e", style++ % kStyles), effect = effect_title(entry.effect);
    plot.line(effect + ", low band", own, entry.running.low_band_position_mm,
              entry.running.low_band);
    plot.line(effect + ", raw", own + " thin", entry.running.position_mm, entry.running.raw);
  }
  return html_figure(
      plot, bold(profile) +
                ": correlation of each effect with the profile up to a position, Eqs. (6), (19), "
                "(20) (Figs. 8 and 9 of the paper); thick: low band, thin: raw. " +
                bold("Good:") +
                " the dominant effect's low-band curve settles early, near ±1, and clear of the "
                "others. The low band raises every coefficient: compare effects, not bands.");
}

/// Blue for +1, orange for -1, the number in every cell.
Html heat_cell(double r) {
  const double strength = std::isfinite(r) ? std::min(std::abs(r), 1.0) : 0.0;
  return element(
      "td",
      {{"class", "n"},
       {"style", std::string("background:rgba(") + (r < 0.0 ? "230,159,0," : "86,180,233,") +
                     fixed_point(0.5 * strength, 2) + ")"}},
      html_number(std::round(r * 1000.0) / 1000.0, 3));
}

Html matrix(const ProfileCurves& curves) {
  if (curves.effects.size() < 2 || curves.correlation.size() != curves.effects.size()) return {};
  Html headings = element("td"), rows;
  for (std::size_t i = 0; i < curves.effects.size(); ++i) {
    const std::string title = effect_title(curves.effects[i]);
    headings += element("th", {{"scope", "col"}}, title);
    Html row = element("th", {{"scope", "row"}}, title);
    for (const double r : curves.correlation[i]) row += heat_cell(r);
    rows += element("tr", row);
  }
  return html_scroll(element(
      "table", {{"class", "heat"}},
      element("caption", "Effects among themselves on " + Html(curves.profile) + ", low band") +
          element("thead", element("tr", headings)) + element("tbody", rows)));
}

// --- residual ---------------------------------------------------------------------------------

std::vector<double> multiples(double step, std::size_t count) {
  std::vector<double> out;
  for (std::size_t i = 0; i < count; ++i) out.push_back(step * static_cast<double>(i));
  return out;
}

Html autocorrelation_picture(const ProfileCurves& curves, const std::string& id) {
  const std::vector<double>&before = curves.autocorrelation_before,
        &after = curves.autocorrelation_after;
  Plot lags({id + "-autocorrelation",
             "Profile " + curves.profile + ": autocorrelation of the residual",
             "Autocorrelation coefficient of the residual over the lag, with the 95 % limits of "
             "white noise.",
             "lag, mm", "autocorrelation"});
  lags.size(720, 220)
      .line(after.empty() ? "residual" : "declared model", after.empty() ? "after" : "before",
            multiples(curves.lag_mm, before.size()), before)
      .line("final model", "after", multiples(curves.lag_mm, after.size()), after)
      .level("95 % of white noise", "limit", curves.white_limit)
      .level("", "limit", -curves.white_limit);
  return html_figure(
      lags, bold(curves.profile) + ": autocorrelation of the residual. " + bold("Good:") +
                " it falls at once and stays between the dotted lines. A slow fall or waves mean "
                "that neighbouring values are not independent; the uncertainties here count that "
                "in.");
}

Html spectrum_picture(const ProfileCurves& curves, const std::string& id) {
  const Spectrum &before = curves.spectrum_before, &after = curves.spectrum_after;
  const bool added = !after.amplitude.empty();
  Plot plot({id + "-spectrum", "Profile " + curves.profile + ": spectrum of the residual",
             "Amplitude of the residual at each spatial frequency, both axes logarithmic.",
             "frequency, cycles/mm", "amplitude, " + unit_name(curves.unit)});
  plot.size(720, 240)
      .log_x()
      .log_y()
      .line(added ? "declared model" : "residual", added ? "before" : "after",
            before.cycles_per_sample, before.amplitude)
      .line("final model", "after", after.cycles_per_sample, after.amplitude);
  return html_figure(
      plot, bold(curves.profile) + ": spectrum of the residual. " + bold("Good:") +
                " a level floor. A peak is something periodic (rail, spindle, drive), a rise to "
                "the left is form the model lacks.");
}

}  // namespace

Html html_each_profile(
    const Analysis& analysis, const std::string& prefix,
    const std::function<Html(const ProfileCurves& curves, const std::string& id)>& picture) {
  Html out;
  std::size_t index = 0;
  if (analysis.details.curves)
    for (const ProfileCurves& curves : analysis.details.curves->profiles)
      out += picture(curves, numbered(prefix, index++));
  return out;
}

HtmlSection html_straightness(const Analysis& analysis) {
  const auto& model = analysis.result.final;
  if (!model || !model->straightness) return {};
  const Straightness& form = *model->straightness;
  Html body = form.errors.empty() ? element("p", "None is given: " + Html(form.reason) + ".")
                                  : straightness_curve(form.curve) + straightness_errors(form) +
                                        station_table(form);
  if (!form.errors.empty() && analysis.trace && analysis.trace->unnamed)
    body += element("p", {{"class", "hint"}},
                    "U includes what the structure without a name adds to it.");
  return {"straightness", "Straightness of the slide, ISO 230-1", body};
}

HtmlSection html_correlation(const Analysis& analysis) {
  Html body, matrices;
  std::size_t index = 0;
  for (const InputSummary& in : analysis.result.inputs)
    body += running(analysis, in.name, numbered("r", index++));
  if (analysis.details.curves)
    for (const ProfileCurves& curves : analysis.details.curves->profiles)
      matrices += matrix(curves);
  if (!matrices.empty())
    matrices += element("p", {{"class", "caption"}},
                        "Correlation of the effects of the final model with one another, blue "
                        "positive, orange negative. " +
                            bold("Good:") +
                            " small numbers off the diagonal. Near ±1 two effects look alike in "
                            "this profile, and a high correlation with the profile selects "
                            "neither.");
  return {"correlation", "Correlation", body + matrices};
}

HtmlSection html_residual(const Analysis& analysis) {
  const auto both = [](const ProfileCurves& curves, const std::string& id) {
    return autocorrelation_picture(curves, id) + spectrum_picture(curves, id);
  };
  return {"residual", "Is the residual noise?", html_each_profile(analysis, "n", both)};
}

}  // namespace slideway
