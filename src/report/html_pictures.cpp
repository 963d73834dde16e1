#include <algorithm>
#include <cmath>

#include "html_parts.hpp"
#include "html_plot.hpp"
#include "slideway/report/number.hpp"

namespace slideway {
namespace {

using Column = HtmlTable::Column;

// --- straightness ---------------------------------------------------------------------------

std::string straightness_errors(const std::vector<Node>& errors) {
  HtmlTable table(
      "Straightness error: largest positive minus largest negative deviation from the "
      "stated line",
      {{"reference line", Column::text},
       {"error ± U, µm", Column::number},
       {"k", Column::number},
       {"highest, µm", Column::number},
       {"at x, mm", Column::number},
       {"lowest, µm", Column::number},
       {"at x, mm", Column::number}});
  for (const Node& e : errors)
    table.add({html_text(e["line"]),
               html_pair(e["error_um"].number(), e["expanded_uncertainty_um"].number()),
               html_cell(e["coverage_factor"], 3), html_cell(e["highest_um"], 3),
               html_cell(e["highest_at_mm"], 4), html_cell(e["lowest_um"], 3),
               html_cell(e["lowest_at_mm"], 4)});
  return table.html();
}

std::string straightness(const Node& report) {
  if (!report.has("final") || !report["final"].has("straightness")) return "";
  const std::vector<Node> errors = report["final"]["straightness"]["errors"].entries();
  if (errors.empty())
    return html_section(
        "straightness", "Straightness of the slide, ISO 230-1",
        "<p>None is given: " + html_text(report["final"]["straightness"]["reason"]) + ".</p>\n");
  const Node curve = report["final"]["straightness"]["curve"];
  const std::vector<double> x = curve["position_mm"].numbers();
  const std::vector<double> deviation = curve["deviation_um"].numbers();
  const std::vector<double> U = curve["expanded_uncertainty_um"].numbers();
  if (x.size() != deviation.size() || x.size() != U.size() || x.size() < 2)
    curve.fail("three curves of one length");
  std::vector<double> low = deviation, high = deviation;
  for (std::size_t i = 0; i < U.size(); ++i) {
    low[i] -= U[i];
    high[i] += U[i];
  }
  Plot plot({"straightness-curve", "Identified straightness of the X slide",
             "Deviation from the least-squares line over the travel, with its expanded "
             "uncertainty, and the end-point line.",
             "slide coordinate x, mm", "deviation, µm"});
  plot.band("± U", "band", x, low, high)
      .line("deviation from the least-squares line", "after", x, deviation)
      .line("end-point line", "before", {x.front(), x.back()},
            {deviation.front(), deviation.back()})
      .level("least-squares line", "limit", 0.0);
  const double step = (x.back() - x.front()) / static_cast<double>(x.size() - 1);
  return html_section(
      "straightness", "Straightness of the slide, ISO 230-1",
      html_figure(
          plot.svg(),
          "Straightness error motion <i>E</i><sub>ZX</sub> of the X slide over the travel the "
          "profiles cover, positive along +Z; band: expanded uncertainty. <b>Good:</b> the "
          "band is narrow beside the curve (the form is known) and the error is within the "
          "machine's tolerance. The three reference lines give three different numbers, all "
          "of them valid: a tolerance must state its line.") +
          straightness_errors(errors) +
          "<p class=\"hint\">Evaluated from the fitted polynomial at " + std::to_string(x.size()) +
          " points over x = " + html_number(x.front(), 5) + " to " + html_number(x.back(), 5) +
          " mm, a step of " + html_number(step, 3) + " mm: a limited representation of the slide." +
          (report.has("trace") && report["trace"].has("unnamed")
               ? " U includes what the structure without a name adds to it."
               : "") +
          "</p>\n");
}

// --- correlations -----------------------------------------------------------------------------

/// The low band has its coefficients at the same shares of the trace, however many they are.
std::vector<double> shares(double whole, std::size_t count) {
  std::vector<double> out;
  for (std::size_t i = 1; i <= count; ++i)
    out.push_back(whole * static_cast<double>(i) / static_cast<double>(count));
  return out;
}

std::string running(const Node& report, const std::string& profile, const std::string& id) {
  Plot plot({id + "-running", "Profile " + profile + ": running correlation",
             "Correlation coefficient of each effect with the profile over the first n samples, "
             "raw and in the low band.",
             "samples n", "coefficient"});
  std::size_t style = 0;
  for (const Node& entry : report["ranking"].entries()) {
    if (entry["profile"].verbatim() != profile || !entry.has("running")) continue;
    const Node series = entry["running"];
    const std::string own = numbered("e", style++ % kStyles);
    const std::string& effect = entry["effect"].verbatim();
    const std::vector<double> samples = series["samples"].numbers();
    const std::vector<double> low_band = series["low_band"].numbers();
    if (samples.empty()) continue;
    plot.line(effect + ", low band", own, shares(samples.back(), low_band.size()), low_band);
    plot.line(effect + ", raw", own + " thin", samples, series["raw"].numbers());
  }
  if (plot.empty()) return "";
  return html_figure(
      plot.svg(), html_bold(profile) +
                      ": correlation of each effect with the first n samples, Eqs. (6), (19), (20) "
                      "(Figs. 8 and 9 of the paper); thick: low band, thin: raw. <b>Good:</b> the "
                      "dominant effect's low-band curve settles early, near ±1, and clear of the "
                      "others. The low band raises every coefficient: compare effects, not bands.");
}

/// Blue for +1, orange for -1, the number in every cell.
std::string heat_cell(double r) {
  const double strength = std::min(std::abs(r), 1.0);
  return "<td class=\"n\" style=\"background:rgba(" +
         std::string(r < 0.0 ? "230,159,0," : "86,180,233,") + fixed_point(0.75 * strength, 2) +
         ")\">" + html_number(std::round(r * 1000.0) / 1000.0, 3) + "</td>";
}

std::string matrix(const Node& curves) {
  const std::vector<std::string> effects = html_texts(curves["effects"]);
  const std::vector<Node> rows = curves["correlation"].entries();
  if (effects.size() < 2) return "";
  const auto require = [&](std::size_t size) {
    if (size != effects.size()) curves["correlation"].fail("a row and a column for each effect");
  };
  require(rows.size());
  std::string out = "<table class=\"heat\"><caption>Effects among themselves on " +
                    html_text(curves["profile"]) + ", low band</caption><thead><tr><td></td>";
  for (const std::string& effect : effects) out += "<th scope=\"col\">" + effect + "</th>";
  out += "</tr></thead><tbody>\n";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::vector<double> row = rows[i].numbers();
    require(row.size());
    out += "<tr><th scope=\"row\">" + effects[i] + "</th>";
    for (const double r : row) out += heat_cell(r);
    out += "</tr>\n";
  }
  return html_scroll(out + "</tbody></table>") + "\n";
}

std::string correlations(const Node& report) {
  std::string runs, matrices;
  std::size_t index = 0;
  for (const Node& in : report["inputs"].entries())
    runs += running(report, in["name"].verbatim(), numbered("r", index++));
  if (report.has("curves"))
    for (const Node& curves : report["curves"]["profiles"].entries()) matrices += matrix(curves);
  if (!matrices.empty())
    matrices +=
        "<p class=\"caption\">Correlation of the effects of the final model with one "
        "another, blue positive, orange negative. <b>Good:</b> small numbers off the "
        "diagonal. Near ±1 two effects look alike in this profile, and a high correlation "
        "with the profile selects neither.</p>\n";
  return html_section("correlation", "Correlation", runs + matrices);
}

// --- residual ---------------------------------------------------------------------------------

std::vector<double> multiples(double step, std::size_t count) {
  std::vector<double> out;
  for (std::size_t i = 0; i < count; ++i) out.push_back(step * static_cast<double>(i));
  return out;
}

std::string residual(const Node& curves, const std::string& id) {
  const std::string& profile = curves["profile"].verbatim();
  const std::vector<double> before = curves["autocorrelation_before"].numbers();
  const std::vector<double> after = curves["autocorrelation_after"].numbers();
  const double step = curves["lag_mm"].number(), limit = curves["white_limit"].number();
  const std::string first = after.empty() ? "residual" : "before";
  const std::string style = after.empty() ? "after" : "before";
  Plot lags({id + "-autocorrelation", "Profile " + profile + ": autocorrelation of the residual",
             "Autocorrelation coefficient of the residual over the lag, with the 95 % limits of "
             "white noise.",
             "lag, mm", "autocorrelation"});
  lags.size(720, 220)
      .line(first, style, multiples(step, before.size()), before)
      .line("after", "after", multiples(step, after.size()), after)
      .level("95 % of white noise", "limit", limit)
      .level("", "limit", -limit);
  Plot spectrum({id + "-spectrum", "Profile " + profile + ": spectrum of the residual",
                 "Amplitude of the residual at each spatial frequency, both axes logarithmic.",
                 "frequency, cycles/mm", "amplitude, " + html_unit(curves)});
  spectrum.size(720, 240).log_x().log_y();
  const auto add = [&](const std::string& name, const std::string& own, const char* key) {
    const Node series = curves[key];
    spectrum.line(name, own, series["cycles_per_mm"].numbers(), series["amplitude"].numbers());
  };
  add(first, style, "spectrum_before");
  add("after", "after", "spectrum_after");
  std::string out;
  if (!lags.empty())
    out += html_figure(
        lags.svg(),
        html_bold(profile) +
            ": autocorrelation of the residual. <b>Good:</b> it falls at once and stays "
            "between the dotted lines. A slow fall or waves mean that neighbouring "
            "values are not independent; the uncertainties here count that in.");
  if (!spectrum.empty())
    out += html_figure(
        spectrum.svg(),
        html_bold(profile) +
            ": spectrum of the residual. <b>Good:</b> a level floor. A peak is something "
            "periodic (rail, spindle, drive), a rise to the left is form the model lacks.");
  return out;
}

// --- wavelet bands ----------------------------------------------------------------------------

std::string band_panel(const Node& curves, const Node& band, const std::string& id,
                       const std::string& name) {
  const std::vector<double> low = band["low"].numbers(), high = band["high"].numbers();
  const double first = curves["first_mm"].number(), last = curves["last_mm"].number();
  std::vector<double> x;
  for (std::size_t i = 0; i < low.size(); ++i)
    x.push_back(first +
                (last - first) * (static_cast<double>(i) + 0.5) / static_cast<double>(low.size()));
  Plot plot({id, "Band " + name + " of profile " + curves["profile"].verbatim(),
             "Lowest and highest value of the band along the trace.", "mm", html_unit(curves)});
  plot.size(360, 120).band(name, "envelope", x, low, high);
  return plot.empty() ? "" : plot.svg();
}

std::string bands(const Node& curves, const std::string& id) {
  const std::vector<Node> approximations = curves["approximations"].entries();
  const std::vector<Node> details = curves["details"].entries();
  if (approximations.size() != details.size())
    curves["details"].fail("as many bands as 'approximations' has");
  std::string panels;
  for (std::size_t i = 0; i < details.size(); ++i) {
    const std::string level = std::to_string(i + 1);
    panels += band_panel(curves, approximations[i], id + "-a" + level, numbered("a", i + 1));
    panels += band_panel(curves, details[i], id + "-d" + level, numbered("d", i + 1));
  }
  if (panels.empty()) return "";
  return "<figure><div class=\"panels\">" + panels + "</div><figcaption>" +
         html_bold(curves["profile"].verbatim()) +
         ": wavelet bands over the trace (Fig. 7 of the paper), from the lowest to the highest "
         "value of each stretch; left the approximations, right "
         "the details. <b>Good:</b> the last approximation has kept the whole form, and the "
         "details look like noise, without form and without large values at the ends.</figcaption>"
         "</figure>\n";
}

}  // namespace

std::string html_pictures(const Node& report) {
  return html_profile_pictures(report) + straightness(report) + correlations(report) +
         html_section("residual", "Is the residual noise?",
                      html_each_profile(report, "n", residual)) +
         html_section("bands", "Wavelet bands", html_each_profile(report, "w", bands));
}

}  // namespace slideway
