#include "slideway/report/plan_report.hpp"

#include <algorithm>

#include "json_writer.hpp"
#include "slideway/base/text.hpp"
#include "slideway/report/layout.hpp"
#include "slideway/report/number.hpp"
#include "slideway/trace/plan_fields.hpp"
#include "summary.hpp"

namespace slideway {
namespace {

constexpr std::size_t kExplained = 3;  // cuts; the page and the JSON explain all

const std::string& what_of(const Plan& plan, const std::string& cut) {
  return std::ranges::find(plan.cuts, cut, &PlannedCutSummary::name)->what;
}

std::string reason_in_words(const PlannedDesign& design) { return with_titles(design.reason); }

std::string minutes(const std::optional<double>& time) { return time ? to_digits(*time, 3) : ""; }

std::string table(const Plan& plan) {
  constexpr auto kText = TextColumn::name, kNumber = TextColumn::number;
  const bool has_cost = std::ranges::any_of(
      plan.alone, [](const PlannedDesign& design) { return design.cost.has_value(); });
  TextTable out({"", "cut", "what", "score", "D", "A", "min", has_cost ? "cost" : ""},
                {kNumber, kText, kText, kNumber, kNumber, kNumber, kNumber, kNumber});
  for (std::size_t i = 0; i < plan.alone.size(); ++i) {
    const PlannedDesign& design = plan.alone[i];
    out.add({std::to_string(i + 1), design.cuts.front(), what_of(plan, design.cuts.front()),
             fixed_point(design.score, 2), fixed_point(design.d_gain, 2),
             to_digits(design.a_share, 2), minutes(design.time_min),
             design.cost ? to_digits(*design.cost, 4) : ""});
  }
  return out.text();
}

std::string reasons(const Plan& plan) {
  std::string text;
  for (std::size_t i = 0; i < std::min(kExplained, plan.alone.size()); ++i)
    text += paragraph("  " + std::to_string(i + 1) + "  ",
                      plan.alone[i].cuts.front() + ": " + reason_in_words(plan.alone[i]));
  return text;
}

std::string sets(const Plan& plan) {
  std::string text;
  for (const PlannedDesign& design : plan.sets)
    text += paragraph("  ", joined(design.cuts, " + ") + " (" + joined(design.criteria, "- and ") +
                                "-optimal; score " + fixed_point(design.score, 2) + ", D " +
                                fixed_point(design.d_gain, 2) + ", A " +
                                to_digits(design.a_share, 2) + ")") +
            paragraph("    ", reason_in_words(design));
  return text;
}

}  // namespace

std::string plan_text(const Plan& plan) {
  std::string text = "slideway " + plan.version + ": " +
                     (plan.title.empty() ? "what to measure next" : plan.title) + "\n\n";
  text += paragraph("Next: ", what_of(plan, plan.alone.front().cuts.front()) + " (" +
                                  plan.alone.front().cuts.front() + ")") +
          "\nAlone, best first\n" + table(plan) + "\nWhat the first ones are good for\n" +
          reasons(plan);
  if (!plan.sets.empty()) text += "\nIn sets, by greedy exchange\n" + sets(plan);
  text += "\n" + paragraph("  ",
                           "D: mean logarithm of what U falls by. A: mean of (u planned / u "
                           "now)². Score: D, the same of detection limits and of the sizes "
                           "from which effects are told apart, added up.");
  for (const std::string& note : plan.notes) text += paragraph("  - ", note);
  return text;
}

std::string plan_json(const Plan& plan) {
  JsonWriter writer(JsonWriter::Layout::indented);
  writer.write(plan);
  return writer.take() + "\n";
}

}  // namespace slideway
