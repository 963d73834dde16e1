#include "html_parts.hpp"
#include "html_plot.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"

/// The long profiles: as SVG, and the numbers for the page's script to draw them with zoom.
namespace slideway {
namespace {

/// Numbers for the script; nothing in it can end the element it stands in.
std::string data_block(const Json& data) {
  std::string text = data.dump();
  for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;)
    text.replace(at, 1, "\\u003c");
  return "<script type=\"application/json\">" + text + "</script>";
}

Json series(const std::string& name, const std::string& style, const Json& values) {
  return {{"name", name}, {"style", style}, {"values", values}};
}

struct Drawing {
  Plot::Text text;
  std::string caption;
  std::vector<Json> series;
};

std::string drawn(const Json& curves, const Drawing& drawing, const std::string& unit) {
  Plot plot(drawing.text);
  Json data = {{"title", drawing.text.title},
               {"x", drawing.text.x},
               {"y", drawing.text.y},
               {"unit", unit},
               {"position", curves.at("position_mm")},
               {"series", Json::array()}};
  for (const Json& each : drawing.series) {
    if (each.at("values").empty()) continue;
    plot.line(each.at("name"), each.at("style"), numbers_of(curves, "position_mm"),
              numbers_of(each, "values"));
    data["series"].push_back(each);
  }
  return plot.empty() ? ""
                      : html_figure(plot.svg() + data_block(data), drawing.caption,
                                    " class=\"long\" id=\"" + drawing.text.id + "\"");
}

std::string noise_of(const Json& report, const std::string& profile) {
  if (!has(report, "fit")) return "";
  for (const Json& noise : list_of(report.at("fit"), "noise"))
    if (noise.at("profile") == profile)
      return ", as wide as the noise (standard deviation " +
             html_size(noise, "standard_deviation", 2) + ")";
  return "";
}

std::string of_profile(const Json& report, const Json& curves, const std::string& id) {
  const std::string profile = curves.at("profile").get<std::string>();
  const std::string raw_unit = curves.at("unit").get<std::string>();
  const std::string unit = raw_unit == "urad" ? "µrad" : "µm";
  const std::string y = raw_unit == "urad" ? "slope, µrad" : "height, µm";
  const bool added = !curves.at("residual_after").empty();
  const std::string first = added ? "before" : "after";  // a style
  const std::string before = added ? "model, declared effects" : "model";
  const std::string name = "<b>" + escaped(profile) + "</b>";
  Drawing form{
      {id + "-form", "Profile " + profile + ": raw, low band and model",
       "The measured profile, its low band and the model over the trace position.",
       "trace position, mm", y},
      name +
          ": the profile, its low band (what is fitted) and the model with the "
          "levelling of the trace. <b>Good:</b> the model lies on the low band over the "
          "whole trace, the raw profile scatters evenly about both.",
      {series("raw", "raw", curves.at("raw")), series("low band", "low", curves.at("low_band")),
       series(before, first, curves.at("model_before")),
       series("model with what was missing", "after", curves.at("model_after"))}};
  Drawing rest{{id + "-residual", "Profile " + profile + ": residual",
                "Low band minus model over the trace position, before and after the missing "
                "effects were added, on one scale.",
                "trace position, mm", "residual, " + unit},
               name + ": residual of the low band" +
                   (added ? ", before and after the missing effects entered the model, on one "
                            "scale. "
                          : ". ") +
                   "<b>Good:</b> a level band about zero without trend, waves or steps" +
                   (added ? "" : noise_of(report, profile)) + ".",
               {series(added ? "before" : "residual", first, curves.at("residual_before")),
                series("after", "after", curves.at("residual_after"))}};
  return drawn(curves, form, unit) + drawn(curves, rest, unit);
}

std::string contributions(const Json& curves, const std::string& id) {
  const std::string profile = curves.at("profile").get<std::string>();
  const Json& effects = list_of(curves, "effects");
  const Json& values = list_of(curves, "contributions");
  if (effects.size() != values.size())
    throw DataError("'contributions' has not as many entries as 'effects'");
  const std::string unit = curves.at("unit") == "urad" ? "µrad" : "µm";
  Plot plot({id + "-effects", "Profile " + profile + ": what each effect contributes",
             "Each effect of the final model on its own over the trace position.",
             "trace position, mm", "contribution, " + unit});
  for (std::size_t i = 0; i < effects.size(); ++i)
    plot.line(effects[i].get<std::string>(), numbered("e", i % kStyles),
              numbers_of(curves, "contribution_position_mm"), values[i].get<std::vector<double>>());
  if (plot.empty()) return "";
  return html_figure(
      plot.svg(),
      "<b>" + escaped(profile) +
          "</b>: what each effect of the final model puts into the profile, its mean "
          "included. <b>Good:</b> each is well below the whole. Large curves that cancel "
          "one another mean that these data hardly tell those effects apart; where a "
          "parameter is not determined, the share of its effect is a convention.");
}

}  // namespace

std::string html_profile_pictures(const Json& report) {
  if (!has(report, "curves")) return "";
  const Json& profiles = list_of(report.at("curves"), "profiles");
  std::string out;
  for (std::size_t i = 0; i < profiles.size(); ++i) {
    const std::string id = numbered("p", i);
    out += of_profile(report, profiles[i], id) + contributions(profiles[i], id);
  }
  if (out.empty()) return "";
  return html_section("profiles", "Profiles, model and residual",
                      "<p class=\"hint\">Drag to zoom along the trace, double-click or the button "
                      "for the whole; the pointer shows the numbers. Of long profiles every "
                      "extreme is drawn.</p>\n" +
                          out);
}

}  // namespace slideway
