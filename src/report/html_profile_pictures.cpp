#include "html_parts.hpp"
#include "html_plot.hpp"

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

struct Series {
  std::string name, style;
  std::vector<double> values;
};

struct Drawing {
  Plot::Text text;
  std::string caption;
  std::vector<Series> series;
};

std::string drawn(const Node& curves, const Drawing& drawing, const std::string& unit) {
  Plot plot(drawing.text);
  const std::vector<double> positions = curves["position_mm"].numbers();
  Json data = {{"title", drawing.text.title}, {"x", drawing.text.x},
               {"y", drawing.text.y},         {"unit", unit},
               {"position", positions},       {"series", Json::array()}};
  for (const auto& [name, style, values] : drawing.series) {
    if (values.empty()) continue;
    plot.line(name, style, positions, values);
    data["series"].push_back({{"name", name}, {"style", style}, {"values", values}});
  }
  return plot.empty() ? ""
                      : html_figure(plot.svg() + data_block(data), drawing.caption,
                                    " class=\"long\" id=\"" + drawing.text.id + "\"");
}

std::string noise_of(const Node& report, const std::string& profile) {
  if (!report.has("final")) return "";
  for (const Node& noise : report["final"]["noise"].entries())
    if (noise["profile"].verbatim() == profile)
      return ", as wide as the noise (standard deviation " +
             html_size(noise, "standard_deviation", 2) + ")";
  return "";
}

std::string of_profile(const Node& report, const Node& curves, const std::string& id) {
  const std::string& profile = curves["profile"].verbatim();
  const std::string unit = html_unit(curves);
  const std::string y = (curves["unit"].verbatim() == "urad" ? "slope, " : "height, ") + unit;
  const auto numbers = [&](const char* key) { return curves[key].numbers(); };
  const std::vector<double> residual_after = numbers("residual_after");
  const bool added = !residual_after.empty();
  const std::string first = added ? "before" : "after";  // a style
  const std::string before = added ? "model, declared effects" : "model";
  const std::string name = html_bold(profile);
  Drawing form{{id + "-form", "Profile " + profile + ": raw, low band and model",
                "The measured profile, its low band and the model over the trace position.",
                "trace position, mm", y},
               name +
                   ": the profile, its low band (what is fitted) and the model with the "
                   "levelling of the trace. <b>Good:</b> the model lies on the low band over the "
                   "whole trace, the raw profile scatters evenly about both.",
               {{"raw", "raw", numbers("raw")},
                {"low band", "low", numbers("low_band")},
                {before, first, numbers("model_before")},
                {"model with what was missing", "after", numbers("model_after")}}};
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
               {{added ? "before" : "residual", first, numbers("residual_before")},
                {"after", "after", residual_after}}};
  return drawn(curves, form, unit) + drawn(curves, rest, unit);
}

std::string contributions(const Node& curves, const std::string& id) {
  const std::string& profile = curves["profile"].verbatim();
  const std::vector<Node> effects = curves["effects"].entries();
  const std::vector<Node> values = curves["contributions"].entries();
  if (effects.size() != values.size()) curves["contributions"].fail("one for each of 'effects'");
  Plot plot({id + "-effects", "Profile " + profile + ": what each effect contributes",
             "Each effect of the final model on its own over the trace position.",
             "trace position, mm", "contribution, " + html_unit(curves)});
  for (std::size_t i = 0; i < effects.size(); ++i)
    plot.line(effects[i].verbatim(), numbered("e", i % kStyles),
              curves["contribution_position_mm"].numbers(), values[i].numbers());
  if (plot.empty()) return "";
  return html_figure(
      plot.svg(),
      html_bold(profile) +
          ": what each effect of the final model puts into the profile, its mean included. "
          "<b>Good:</b> each is well below the whole. Large curves that cancel one another mean "
          "that these data hardly tell those effects apart; where a parameter is not determined, "
          "the share of its effect is a convention.");
}

}  // namespace

std::string html_profile_pictures(const Node& report) {
  const std::string out =
      html_each_profile(report, "p", [&](const Node& curves, const std::string& id) {
        return of_profile(report, curves, id) + contributions(curves, id);
      });
  if (out.empty()) return "";
  return html_section("profiles", "Profiles, model and residual",
                      "<p class=\"hint\"><span class=\"zoom\">Drag to zoom along the trace, "
                      "double-click or the button for the whole; the pointer shows the numbers. "
                      "</span>Of long profiles every extreme is drawn.</p>\n" +
                          out);
}

}  // namespace slideway
