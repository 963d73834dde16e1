#include <nlohmann/json.hpp>

#include "html_curves.hpp"
#include "html_parts.hpp"

/// The long profiles: as SVG, and the numbers for the page's script to draw them with zoom.
namespace slideway {
namespace {

using Json = nlohmann::ordered_json;

/// Numbers for the script; nothing in it can end the element it stands in.
Html data_block(const Json& data) {
  std::string text = data.dump(-1, ' ', false, Json::error_handler_t::replace);
  for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;)
    text.replace(at, 1, "\\u003c");
  return element("script", {{"type", "application/json"}}, Html::verbatim(text));
}

struct Drawing {
  Plot::Text text;
  Html caption;
  CurveSet shown;
};

Html drawn(const ProfileCurves& curves, const Drawing& drawing) {
  const bool few = drawing.shown.position_mm.size() <= kFewReadings;
  Plot plot(drawing.text);
  if (few) plot.markers();
  Json data = {{"title", drawing.text.title},
               {"x", drawing.text.x},
               {"y", drawing.text.y},
               {"unit", unit_name(curves.unit)},
               {"markers", few},
               {"position", drawing.shown.position_mm},
               {"series", Json::array()}};
  for (const auto& [name, style, values] : drawing.shown.curves) {
    if (values.empty()) continue;
    plot.line(name, style, drawing.shown.position_mm, values);
    data["series"].push_back({{"name", name}, {"style", style}, {"values", values}});
  }
  if (plot.empty()) return {};
  return html_figure(plot.svg() + data_block(data), drawing.caption,
                     {{"class", "long"}, {"id", drawing.text.id}});
}

Html noise_of(const Result& result, const std::string& profile) {
  if (result.final)
    for (const NoiseSummary& noise : result.final->noise)
      if (noise.profile == profile)
        return ", as wide as the noise (standard deviation " +
               html_size(noise.standard_deviation_um, noise.standard_deviation_urad) + ")";
  return {};
}

Html form(const ProfileCurves& curves, const std::string& id) {
  const char* const quantity = curves.unit == MicroUnit::urad ? "slope, " : "height, ";
  const CurveSet shown = form_curves(curves);
  const std::string& measured = shown.curves.front().name;
  return drawn(curves, {{id + "-form", "Profile " + curves.profile + ": form and model",
                         "The form of the measured profile and the model over the trace position.",
                         "trace position, mm", quantity + unit_name(curves.unit)},
                        bold(curves.profile) + ": the form that is fitted (" + measured +
                            ") and the model with the levelling of the trace. " + bold("Good:") +
                            " the model lies on the form over the whole trace.",
                        shown});
}

Html marks(const ProfileCurves& curves, const std::string& id) {
  if (!is_filtered(curves) || curves.raw.size() != curves.low_band.size()) return {};
  std::vector<double> left = curves.raw;
  for (std::size_t i = 0; i < left.size(); ++i) left[i] -= curves.low_band[i];
  return drawn(curves,
               {{id + "-marks", "Profile " + curves.profile + ": what the low band leaves out",
                 "The measured profile minus its low band over the trace position.",
                 "trace position, mm", "raw − low band, " + unit_name(curves.unit)},
                bold(curves.profile) +
                    ": what the low band leaves out, at a scale of its own: feed marks, roughness, "
                    "noise. " +
                    bold("Good:") + " even over the whole trace, without form.",
                {curves.position_mm, {{"raw minus low band", "raw", left}}}});
}

Html residual(const Result& result, const ProfileCurves& curves, const std::string& id) {
  const bool added = !curves.residual_after.empty();
  Html caption = bold(curves.profile) + ": residual of the low band" +
                 (added ? ", of the declared and of the final model, on one scale. " : ". ") +
                 bold("Good:") + " a level band about zero without trend, waves or steps";
  if (!added) caption += noise_of(result, curves.profile);
  return drawn(curves, {{id + "-residual", "Profile " + curves.profile + ": residual",
                         "Low band minus model over the trace position, of the declared and of the "
                         "final model, on one scale.",
                         "trace position, mm", "residual, " + unit_name(curves.unit)},
                        caption + ".",
                        residual_curves(curves)});
}

Html contributions(const ProfileCurves& curves, const std::string& id) {
  Plot plot({id + "-effects", "Profile " + curves.profile + ": what each effect contributes",
             "Each effect of the final model on its own over the trace position.",
             "trace position, mm", "contribution, " + unit_name(curves.unit)});
  for (std::size_t i = 0; i < std::min(curves.effects.size(), curves.contributions.size()); ++i)
    plot.line(effect_title(curves.effects[i]), numbered("e", i % kStyles),
              curves.contribution_position_mm, curves.contributions[i]);
  return html_figure(
      plot, bold(curves.profile) +
                ": what each effect of the final model puts into the profile, its mean included. " +
                bold("Good:") +
                " each is well below the whole. Large curves that cancel one another mean that "
                "these data hardly tell those effects apart; where a parameter is not determined, "
                "the share of its effect is a convention.");
}

// --- wavelet bands ----------------------------------------------------------------------------

Html band_panel(const ProfileCurves& curves, const Envelope& band, const std::string& id,
                const std::string& name) {
  std::vector<double> x;
  const double length = curves.last_mm - curves.first_mm;
  for (std::size_t i = 0; i < band.low.size(); ++i)
    x.push_back(curves.first_mm +
                length * (static_cast<double>(i) + 0.5) / static_cast<double>(band.low.size()));
  Plot plot({id, "Band " + name + " of profile " + curves.profile,
             "Lowest and highest value of the band along the trace.", "mm",
             unit_name(curves.unit)});
  plot.size(360, 120).band(name, "envelope", x, band.low, band.high);
  return plot.empty() ? Html() : plot.svg();
}

Html bands(const ProfileCurves& curves, const std::string& id) {
  Html panels;
  for (std::size_t i = 0; i < std::min(curves.approximations.size(), curves.details.size()); ++i) {
    const std::string level = std::to_string(i + 1);
    panels += band_panel(curves, curves.approximations[i], id + "-a" + level, "a" + level);
    panels += band_panel(curves, curves.details[i], id + "-d" + level, "d" + level);
  }
  if (panels.empty()) return {};
  const Html caption =
      bold(curves.profile) +
      ": wavelet bands over the trace (Fig. 7 of the paper), from the lowest to the highest value "
      "of each stretch; left the approximations, right the details. " +
      bold("Good:") +
      " the last approximation has kept the whole form, and the details look like noise, without "
      "form and without large values at the ends.";
  return element("figure",
                 element("div", {{"class", "panels"}}, panels) + element("figcaption", caption));
}

}  // namespace

HtmlSection html_profiles(const Analysis& analysis) {
  Html body =
      html_each_profile(analysis, "p", [&](const ProfileCurves& curves, const std::string& id) {
        return form(curves, id) + marks(curves, id) + residual(analysis.result, curves, id) +
               contributions(curves, id);
      });
  if (!body.empty())
    body = element("p", {{"class", "hint"}},
                   element("span", {{"class", "zoom"}},
                           "Drag to zoom along the trace, double-click or the button for the "
                           "whole; the pointer shows the numbers. ") +
                       "Of long profiles every extreme is drawn.") +
           body;
  return {"profiles", "Profiles, model and residual", body};
}

HtmlSection html_bands(const Analysis& analysis) {
  return {"bands", "Wavelet bands", html_each_profile(analysis, "w", bands)};
}

}  // namespace slideway
