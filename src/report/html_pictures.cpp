#include <algorithm>
#include <cmath>

#include "html_parts.hpp"
#include "html_plot.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/report/number.hpp"

namespace slideway {
namespace {

using Column = HtmlTable::Column;

std::string bold(const std::string& name) { return "<b>" + escaped(name) + "</b>"; }

// --- straightness ---------------------------------------------------------------------------

std::string straightness(const Json& report) {
  if (!has(report, "straightness") || !has(report, "curves") ||
      !has(report.at("curves"), "straightness"))
    return "";
  const Json& errors = list_of(report.at("straightness"), "errors");
  if (errors.empty())
    return html_section(
        "straightness", "Straightness of the slide, ISO 230-1",
        "<p>None is given: " + text_of(report.at("straightness"), "reason") + ".</p>\n");
  const Json& curve = report.at("curves").at("straightness");
  const std::vector<double> x = numbers_of(curve, "position_mm");
  const std::vector<double> deviation = numbers_of(curve, "deviation_um");
  const std::vector<double> U = numbers_of(curve, "expanded_uncertainty_um");
  if (x.size() != deviation.size() || x.size() != U.size() || x.size() < 2)
    throw DataError("the curves of 'straightness' differ in length");
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
  const auto cell = [](const Json& error, const char* key, int digits) {
    return html_number(error.at(key).get<double>(), digits);
  };
  for (const Json& e : errors)
    table.add(
        {text_of(e, "line"),
         html_pair(e.at("error_um").get<double>(), e.at("expanded_uncertainty_um").get<double>()),
         cell(e, "coverage_factor", 3), cell(e, "highest_um", 3), cell(e, "highest_at_mm", 4),
         cell(e, "lowest_um", 3), cell(e, "lowest_at_mm", 4)});
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
          table.html() + "<p class=\"hint\">Evaluated from the fitted polynomial at " +
          std::to_string(x.size()) + " points over x = " + html_number(x.front(), 5) + " to " +
          html_number(x.back(), 5) + " mm, a step of " + html_number(step, 3) +
          " mm: a limited representation of the slide." +
          (has(report, "trace") && has(report.at("trace"), "unnamed")
               ? " U is here without what the structure without a name adds to it."
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

std::string running(const Json& report, const std::string& profile, const std::string& id) {
  Plot plot({id + "-running", "Profile " + profile + ": running correlation",
             "Correlation coefficient of each effect with the profile over the first n samples, "
             "raw and in the low band.",
             "samples n", "coefficient"});
  std::size_t style = 0;
  for (const Json& entry : list_of(report, "ranking")) {
    if (entry.at("profile") != profile || !has(entry, "running")) continue;
    const Json& series = entry.at("running");
    const std::string own = numbered("e", style++ % kStyles);
    const std::string effect = entry.at("effect").get<std::string>();
    const std::vector<double> samples = numbers_of(series, "samples");
    const std::vector<double> low_band = numbers_of(series, "low_band");
    if (samples.empty()) continue;
    plot.line(effect + ", low band", own, shares(samples.back(), low_band.size()), low_band);
    plot.line(effect + ", raw", own + " thin", samples, numbers_of(series, "raw"));
  }
  if (plot.empty()) return "";
  return html_figure(
      plot.svg(), bold(profile) +
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

std::string matrix(const Json& curves) {
  const Json& effects = list_of(curves, "effects");
  const Json& rows = list_of(curves, "correlation");
  if (effects.size() < 2) return "";
  if (rows.size() != effects.size()) throw DataError("'correlation' is no square");
  std::string out =
      "<div class=\"scroll\" tabindex=\"0\" role=\"group\"><table class=\"heat\">"
      "<caption>Effects among themselves on " +
      text_of(curves, "profile") + ", low band</caption><thead><tr><td></td>";
  for (const Json& effect : effects)
    out += "<th scope=\"col\">" + escaped(effect.get<std::string>()) + "</th>";
  out += "</tr></thead><tbody>\n";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].size() != effects.size()) throw DataError("'correlation' is no square");
    out += "<tr><th scope=\"row\">" + escaped(effects[i].get<std::string>()) + "</th>";
    for (const Json& r : rows[i]) out += heat_cell(r.get<double>());
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

std::string correlations(const Json& report) {
  std::string runs, matrices;
  std::size_t index = 0;
  for (const Json& in : report.at("inputs"))
    runs += running(report, in.at("name").get<std::string>(), numbered("r", index++));
  if (has(report, "curves"))
    for (const Json& curves : list_of(report.at("curves"), "profiles")) matrices += matrix(curves);
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

std::string residual(const Json& curves, const std::string& id) {
  const std::string profile = curves.at("profile").get<std::string>();
  const std::vector<double> before = numbers_of(curves, "autocorrelation_before");
  const std::vector<double> after = numbers_of(curves, "autocorrelation_after");
  const double step = curves.at("lag_mm").get<double>(),
               limit = curves.at("white_limit").get<double>();
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
  const std::string unit = curves.at("unit") == "urad" ? "µrad" : "µm";
  Plot spectrum({id + "-spectrum", "Profile " + profile + ": spectrum of the residual",
                 "Amplitude of the residual at each spatial frequency, both axes logarithmic.",
                 "frequency, cycles/mm", "amplitude, " + unit});
  spectrum.size(720, 240).log_x().log_y();
  const auto add = [&](const std::string& name, const std::string& own, const char* key) {
    const Json& numbers = curves.at(key);
    spectrum.line(name, own, numbers_of(numbers, "cycles_per_mm"),
                  numbers_of(numbers, "amplitude"));
  };
  add(first, style, "spectrum_before");
  add("after", "after", "spectrum_after");
  std::string out;
  if (!lags.empty())
    out += html_figure(
        lags.svg(),
        bold(profile) +
            ": autocorrelation of the residual. <b>Good:</b> it falls at once and stays "
            "between the dotted lines. A slow fall or waves mean that neighbouring "
            "values are not independent; the uncertainties here count that in.");
  if (!spectrum.empty())
    out += html_figure(
        spectrum.svg(),
        bold(profile) +
            ": spectrum of the residual. <b>Good:</b> a level floor. A peak is something "
            "periodic (rail, spindle, drive), a rise to the left is form the model lacks.");
  return out;
}

// --- wavelet bands ----------------------------------------------------------------------------

std::string band_panel(const Json& curves, const Json& band, const std::string& id,
                       const std::string& name) {
  const std::vector<double> low = numbers_of(band, "low"), high = numbers_of(band, "high");
  const double first = curves.at("first_mm").get<double>(),
               last = curves.at("last_mm").get<double>();
  std::vector<double> x;
  for (std::size_t i = 0; i < low.size(); ++i)
    x.push_back(first +
                (last - first) * (static_cast<double>(i) + 0.5) / static_cast<double>(low.size()));
  Plot plot({id, "Band " + name + " of profile " + curves.at("profile").get<std::string>(),
             "Lowest and highest value of the band along the trace.", "", ""});
  plot.size(360, 120).band(name, "envelope", x, low, high);
  return plot.empty() ? "" : plot.svg();
}

std::string bands(const Json& curves, const std::string& id) {
  const Json& approximations = list_of(curves, "approximations");
  const Json& details = list_of(curves, "details");
  if (approximations.size() != details.size())
    throw DataError("'details' has not as many bands as 'approximations'");
  std::string panels;
  for (std::size_t i = 0; i < details.size(); ++i) {
    const std::string level = std::to_string(i + 1);
    panels += band_panel(curves, approximations[i], id + "-a" + level, numbered("a", i + 1));
    panels += band_panel(curves, details[i], id + "-d" + level, numbered("d", i + 1));
  }
  if (panels.empty()) return "";
  const std::string unit = curves.at("unit") == "urad" ? "µrad" : "µm";
  return "<figure><div class=\"panels\">" + panels + "</div><figcaption>" +
         bold(curves.at("profile").get<std::string>()) +
         ": wavelet bands over the trace (Fig. 7 of the paper), " + unit +
         ", from the lowest to the highest value of each stretch; left the approximations, right "
         "the details. <b>Good:</b> the last approximation has kept the whole form, and the "
         "details look like noise, without form and without large values at the ends.</figcaption>"
         "</figure>\n";
}

std::string each_profile(const Json& report,
                         std::string (*picture)(const Json&, const std::string&),
                         const std::string& prefix) {
  if (!has(report, "curves")) return "";
  std::string out;
  std::size_t index = 0;
  for (const Json& curves : list_of(report.at("curves"), "profiles"))
    out += picture(curves, numbered(prefix, index++));
  return out;
}

}  // namespace

std::string html_pictures(const Json& report) {
  return html_profile_pictures(report) + straightness(report) + correlations(report) +
         html_section("residual", "Is the residual noise?", each_profile(report, residual, "n")) +
         html_section("bands", "Wavelet bands", each_profile(report, bands, "w"));
}

}  // namespace slideway
