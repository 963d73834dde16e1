#include "html_parts.hpp"
#include "slideway/base/text.hpp"
#include "slideway/report/plan_report.hpp"

namespace slideway {
namespace {

Html fall(const std::optional<double>& now, const std::optional<double>& planned) {
  return html_number(now, 2) + " → " + html_number(planned, 2);
}

Html designs(const std::vector<PlannedDesign>& all, const char* caption) {
  HtmlTable table(caption, {{"cuts", HtmlColumn::text},
                            {"score", HtmlColumn::number},
                            {"D", HtmlColumn::number},
                            {"A", HtmlColumn::number},
                            {"min", HtmlColumn::number},
                            {"cost", HtmlColumn::number},
                            {"what it is good for", HtmlColumn::text}});
  for (const PlannedDesign& design : all) {
    std::string cuts = joined(design.cuts, " + ");
    if (!design.criteria.empty()) cuts += " (" + joined(design.criteria, "- and ") + "-optimal)";
    table.add({cuts, html_number(design.score, 3), html_number(design.d_gain, 3),
               html_number(design.a_share, 2), html_number(design.time_min, 3),
               html_number(design.cost, 3), with_titles(design.reason)});
  }
  return table.html();
}

/// U of each wanted quantity, as a part of what it is now.
Html picture(const Plan& plan) {
  Plot plot({"plan-u", "What is left of U",
             "For each cut, in the order of the plan, the planned U of every quantity that is "
             "determined now, divided by its U of today.",
             "cut, in the order of the plan", "planned U / U now"});
  const std::vector<PlannedQuantity>& quantities = plan.alone.front().quantities;
  for (std::size_t q = 0; q < quantities.size(); ++q) {
    if (!quantities[q].U_now) continue;
    std::vector<double> place, share;
    for (std::size_t i = 0; i < plan.alone.size(); ++i) {
      const PlannedQuantity& each = plan.alone[i].quantities[q];
      if (!each.U_planned) continue;
      place.push_back(static_cast<double>(i + 1));
      share.push_back(*each.U_planned / *each.U_now);
    }
    plot.line(quantities[q].symbol, numbered("e", q % kStyles), std::move(place), std::move(share));
  }
  return html_figure(plot, "Planned U of each quantity, divided by its U of today.");
}

Html quantities(const PlannedDesign& best) {
  HtmlTable table(
      "U now → planned",
      {{"quantity", HtmlColumn::text}, {"U", HtmlColumn::number}, {"unit", HtmlColumn::text}});
  for (const PlannedQuantity& each : best.quantities)
    table.add({html_symbol(each.symbol), fall(each.U_now, each.U_planned), html_unit(each.unit)});
  return table.html();
}

Html limits(const PlannedDesign& best) {
  HtmlTable table("Detection limits now → planned", {{"effect", HtmlColumn::text},
                                                     {"limit", HtmlColumn::number},
                                                     {"unit", HtmlColumn::text},
                                                     {"at", HtmlColumn::text},
                                                     {"hidden now by", HtmlColumn::text}});
  for (const PlannedLimit& each : best.limits)
    table.add({effect_title(each.effect), fall(each.now, each.planned), html_unit(each.unit),
               each.at, each.same_as});
  return table.html();
}

Html pairs(const PlannedDesign& best) {
  HtmlTable table("Told apart from so many detection limits of today on, now → planned",
                  {{"effect", HtmlColumn::text},
                   {"rival", HtmlColumn::text},
                   {"size", HtmlColumn::number},
                   {"told apart", HtmlColumn::text}});
  for (const PlannedPair& each : best.pairs)
    table.add({effect_title(each.effect), effect_title(each.rival), fall(each.now, each.planned),
               each.told_apart ? "yes" : "no"});
  return table.html();
}

}  // namespace

std::string plan_page(const Plan& plan) {
  const PlannedDesign& best = plan.alone.front();
  HtmlTable cuts(
      "Cuts and traces that were tried",
      {{"name", HtmlColumn::text}, {"what", HtmlColumn::text}, {"like", HtmlColumn::text}});
  for (const PlannedCutSummary& each : plan.cuts) cuts.add({each.name, each.what, each.like});
  return page_of(
      plan.title.empty() ? "What to measure next" : plan.title,
      "What to measure next · slideway " + plan.version, {},
      {{"verdict", "The order",
        element("p", bold("Next: " + best.cuts.front()) + ": " + with_titles(best.reason)) +
            designs(plan.alone, "Alone, best first") +
            designs(plan.sets, "In sets, by greedy exchange") + picture(plan) +
            html_list(plan.notes)},
       {"best", "What the first one brings", quantities(best) + limits(best) + pairs(best)},
       {"cuts", "The cuts", cuts.html()}});
}

}  // namespace slideway
