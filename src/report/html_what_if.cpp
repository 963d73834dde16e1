#include <algorithm>
#include <map>

#include "html_curves.hpp"
#include "html_parts.hpp"
#include "slideway/report/layout.hpp"
#include "slideway/report/number.hpp"

namespace slideway {
namespace {

constexpr double kBarWidth = 720.0, kNames = 230.0, kSizes = 90.0, kRow = 22.0, kBar = 14.0;
constexpr std::size_t kName = 34;  // characters beside a bar

std::string corrected(const std::string& effect) {
  if (effect.empty()) return "nothing (as measured)";
  return effect == "all" ? "all sources of the final model" : effect_title(effect);
}

double size_of(const PredictedFlatness& each) {
  return (each.pv_um ? each.pv_um : each.pv_urad).value_or(0.0);
}

std::string size_name(const PredictedFlatness& each) {
  return to_digits(size_of(each), 3) + (each.pv_um ? " µm" : " µrad");
}

std::string shortened(std::string name) {
  if (code_points(name) <= kName) return name;
  while (code_points(name) >= kName) name.pop_back();
  return name + "…";
}

/// A bar for each correction of one profile, as long as its peak to valley.
Html bars(const std::string& profile, const std::vector<PredictedFlatness>& all,
          const std::string& id) {
  std::vector<PredictedFlatness> own;
  std::ranges::copy_if(all, std::back_inserter(own),
                       [&](const PredictedFlatness& each) { return each.profile == profile; });
  double most = 0.0;
  for (const PredictedFlatness& each : own) most = std::max(most, size_of(each));
  if (!(most > 0.0)) return {};
  Html content;
  double top = 4.0;
  for (const PredictedFlatness& each : own) {
    const double length =
        (kBarWidth - kNames - kSizes) * std::clamp(size_of(each) / most, 0.0, 1.0);
    const std::string middle = fixed_point(top + kBar - 3.0, 1);
    const char* const style = each.corrected.empty()    ? "measured"
                              : each.corrected == "all" ? "all"
                                                        : "one";
    content += element("text",
                       {{"x", fixed_point(kNames - 8.0, 1)}, {"y", middle}, {"text-anchor", "end"}},
                       shortened(corrected(each.corrected))) +
               element("rect", {{"class", style},
                                {"x", fixed_point(kNames, 1)},
                                {"y", fixed_point(top, 1)},
                                {"width", fixed_point(length, 1)},
                                {"height", fixed_point(kBar, 1)}}) +
               element("text", {{"x", fixed_point(kNames + length + 6.0, 1)}, {"y", middle}},
                       size_name(each));
    top += kRow;
  }
  const Html picture =
      svg_element({id, "Profile " + profile + ": peak to valley if one source were corrected",
                   "One bar for each source; the table below has the same.",
                   fixed_point(kBarWidth, 1), fixed_point(top, 1)},
                  content);
  return html_figure(picture, bold(profile) +
                                  ": peak to valley of the form with one source, and "
                                  "with all of them, corrected.");
}

/// The form as measured, with each source taken out, and with all.
Html overlay(const ModelResult& model, const ProfileCurves& curves, const std::string& id) {
  const std::vector<double>& x = curves.contribution_position_mm;
  if (x.size() < 2 || curves.position_mm.size() < 2 ||
      curves.contributions.size() != curves.effects.size())
    return {};
  const CurveSet form = form_curves(curves);
  const std::vector<double>& low = form.curves.front().values;
  if (form.position_mm.size() < 2 || low.size() != form.position_mm.size()) return {};
  const std::vector<double> measured = interpolated(form.position_mm, low, x);
  std::vector<double> all = measured;
  Plot plot({id, "Profile " + curves.profile + ": the form if a source were corrected",
             "The form as measured, with each source taken out, and with all of them.",
             "trace position, mm", unit_name(curves.unit)});
  plot.line("as measured", "low", x, levelled(model, curves.profile, x, measured));
  for (std::size_t e = 0; e < curves.effects.size(); ++e) {
    if (curves.contributions[e].size() != x.size()) return {};
    std::vector<double> left = measured;
    for (std::size_t i = 0; i < x.size(); ++i) {
      left[i] -= curves.contributions[e][i];
      all[i] -= curves.contributions[e][i];
    }
    plot.line("without " + effect_title(curves.effects[e]), numbered("e", (e + 1) % kStyles), x,
              levelled(model, curves.profile, x, left));
  }
  plot.line("all corrected", "after", x, levelled(model, curves.profile, x, all));
  return html_figure(plot, bold(curves.profile) +
                               ": the form as measured and as it would be, each levelled as the "
                               "problem file allows. " +
                               bold("Good:") + " one curve alone is nearly flat.");
}

}  // namespace

HtmlSection html_what_if(const Analysis& analysis) {
  const std::vector<PredictedFlatness>& all = analysis.details.what_if;
  HtmlTable table("Flatness predicted if one source alone were corrected",
                  {{"profile", HtmlColumn::text},
                   {"corrected", HtmlColumn::text},
                   {"peak to valley", HtmlColumn::number},
                   {"rms", HtmlColumn::number},
                   {"peak to valley, of the measured", HtmlColumn::number}});
  std::map<std::string, double> measured;
  for (const PredictedFlatness& each : all) {
    if (each.corrected.empty()) measured[each.profile] = size_of(each);
    const double whole = measured[each.profile];
    table.add({each.profile, corrected(each.corrected), html_size(each.pv_um, each.pv_urad),
               html_size(each.rms_um, each.rms_urad),
               whole > 0.0 ? html_number(100.0 * size_of(each) / whole, 3) + " %" : "–"});
  }
  if (table.empty() || !analysis.result.final) return {};
  const auto pictures = [&](const ProfileCurves& curves, const std::string& id) {
    return bars(curves.profile, all, id + "-bars") +
           overlay(*analysis.result.final, curves, id + "-overlay");
  };
  const Html hint = element(
      "p", {{"class", "hint"}},
      "In the low band, each trace levelled anew as the problem file allows. A source whose "
      "correction makes the form larger hides another one: correct both or neither. Where a "
      "parameter is not determined, the share of its effect is a convention.");
  return {"what-if", "What correcting each source would bring",
          html_each_profile(analysis, "c", pictures) + table.html() + hint};
}

}  // namespace slideway
