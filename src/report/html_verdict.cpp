#include <algorithm>
#include <cmath>

#include "html_parts.hpp"
#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/report/number.hpp"

namespace slideway {
namespace {

using Column = HtmlTable::Column;
constexpr double kWorthTelling = 0.01;  // of U, a shift

std::string bold_names(const Node& names) {
  std::vector<std::string> out;
  for (const Node& name : names.entries()) out.push_back(html_bold(name.verbatim()));
  return joined(out);
}

/// True if the loop has added effects to the declared model.
bool was_extended(const Node& report) {
  return report.has("trace") && !report["trace"]["rounds"].entries().empty();
}

std::string overall_change(const Node& report) {
  if (!was_extended(report) || !report.has("declared") || !report.has("final")) return "";
  return html_change(report["declared"], "rms", report["final"], "rms");
}

struct Verdict {
  std::string badge, kind, sentence;  // kind: a class of the page
};

std::string found(const Node& trace) {
  std::vector<std::string> out;
  for (const Node& round : trace["rounds"].entries()) {
    const std::string rivals = bold_names(round["ambiguous_with"]);
    out.push_back(html_bold(round["accepted"].verbatim()) +
                  (rivals.empty() ? "" : " (or " + rivals + ")"));
  }
  return joined(out, " and ");
}

Verdict verdict_of(const Node& report) {
  if (!report.has("final"))
    return {"Ranking only", "plain", "The effects were ranked by correlation; nothing was fitted."};
  if (!report["final"]["converged"].truth())
    return {"Not converged", "bad",
            "The fit did not converge: no number of this report can be relied on."};
  if (!report.has("trace"))
    return {"FittedModel", "plain",
            "The declared model was fitted; whether an effect is missing was not asked."};
  const Node trace = report["trace"];
  const std::string& verdict = trace["verdict"].verbatim();
  const std::string fall = overall_change(report);
  const std::string falls = fall.empty() ? "" : " The residual goes from " + fall + " rms.";
  if (verdict == "nothing_missing")
    return {"Nothing missing", "good",
            "The declared effects explain the measured profiles down to noise (lack of fit " +
                html_p_value(trace["lack_of_fit_p"].number()) + ")."};
  if (verdict == "explained")
    return {"Explained", "good",
            "The declared model lacked " + found(trace) + ", and now has it." + falls};
  if (verdict == "ambiguous")
    return {"Ambiguous", "warn",
            "The declared model lacks an effect: " + found(trace) +
                ". These data cannot tell which." + falls};
  const std::string beside = found(trace);
  if (verdict == "not_identifiable")
    return {"Not identifiable", "bad",
            (beside.empty() ? "" : "The declared model lacked " + beside + "." + falls + " ") +
                "A form is there of which these data cannot tell what makes it."};
  if (verdict != "unnamed") trace["verdict"].fail("one of this program's verdicts");
  const std::string size = trace.has("unnamed") ? html_size(trace["unnamed"], "rms") + " rms" : "";
  return {"Unnamed", "bad",
          "Structure is left that no effect of the catalogue explains: " + size +
              (beside.empty() ? "" : ", beside " + beside) + "."};
}

std::string cross_check(const Node& report, std::vector<std::string>& warnings) {
  if (!report.has("crosscheck") || !report["crosscheck"].has("squareness")) return "";
  const Node check = report["crosscheck"]["squareness"];
  const auto en = check["En"].number_or_null();
  if (!en) return "";
  const std::string number = "<i>E</i><sub>n</sub> = " + html_number(*en, 2);
  if (check["verdict"].verbatim() == "inconsistent") {
    warnings.push_back("The squareness of the fit and that of the run-out disagree, " + number +
                       " &gt; 1: " + html_text(check["reason"]) + ".");
    return number + ": inconsistent";
  }
  return number + ": consistent (not above 1)";
}

std::string dominant(const Node& report) {
  const Node dominant = report["dominant"];
  if (dominant.has("doubt") && !dominant["doubt"].verbatim().empty())
    return html_text(dominant["doubt"]);
  const auto name = [&](const char* key) {
    return dominant.has(key) ? html_bold(dominant[key].verbatim()) : std::string();
  };
  const std::string correlation = name("by_correlation"), fit = name("by_fit");
  if (correlation.empty() && fit.empty()) return "";
  if (dominant.has("agree") && dominant["agree"].truth())
    return fit + " (correlation and fit agree)";
  return (correlation.empty() ? "" : "by correlation " + correlation) +
         (correlation.empty() || fit.empty() ? "" : ", by fit ") +
         (correlation.empty() ? "by fit " : "") + fit;
}

std::vector<Node> final_parameters(const Node& report) {
  return report.has("final") ? report["final"]["parameters"].entries() : std::vector<Node>{};
}

struct Known {
  double value, U, k;
};

std::optional<Known> known(const Node& parameter) {
  const auto value = parameter["value"].number_or_null(),
             U = parameter["expanded_uncertainty"].number_or_null();
  if (!value || !U) return std::nullopt;
  return Known{*value, *U, parameter["coverage_factor"].number_or_null().value_or(2.0)};
}

std::string with_k(const Known& of, double unit, const std::string& name) {
  return html_pair(of.value / unit, of.U / unit) + " " + name;
}

using Fact = std::pair<std::string, std::string>;

void add_squareness(const Node& report, std::vector<Fact>& facts) {
  for (const Node& parameter : final_parameters(report)) {
    if (motion_error_of(parameter["name"].verbatim()) != MotionError::squareness) continue;
    const std::string head = "Squareness " + html_symbol(parameter["symbol"].verbatim());
    const auto found = known(parameter);
    if (!found) {
      facts.emplace_back(head, "not determined by these data");
      continue;
    }
    facts.emplace_back(head, with_k(*found, 1.0, "rad") + "<br>" + with_k(*found, 1e-6, "µm/m") +
                                 "<br>" + with_k(*found, kArcsecond, "″ (arcsec)") +
                                 "<br><small>± U, k = " + html_number(found->k, 3) +
                                 "; positive: the face falls from centre to rim</small>");
  }
}

void add_straightness(const Node& report, std::vector<Fact>& facts) {
  if (!report.has("final") || !report["final"].has("straightness")) return;
  const Node straightness = report["final"]["straightness"];
  const std::vector<Node> errors = straightness["errors"].entries();
  if (errors.empty()) {
    facts.emplace_back("Straightness of the slide", html_text(straightness["reason"]));
    return;
  }
  std::string text;
  for (const Node& error : errors)
    text += html_pair(error["error_um"].number(), error["expanded_uncertainty_um"].number()) +
            " µm <small>" + html_text(error["line"]) +
            ", k = " + html_number(error["coverage_factor"].number(), 3) + "</small><br>";
  facts.emplace_back("Straightness error <i>E</i><sub>ZX</sub>", text);
}

/// Declared parameters before and after the loop; the largest shift goes into the facts.
std::string result_table(const Node& report, std::vector<Fact>& facts) {
  const bool bent = report.has("declared") && was_extended(report);
  std::vector<std::pair<std::string, Column>> columns{{"parameter", Column::text},
                                                      {"value ± U", Column::number},
                                                      {"unit", Column::text},
                                                      {"k", Column::number},
                                                      {"u", Column::number}};
  if (bent) {
    columns.emplace_back("declared model", Column::number);
    columns.emplace_back("shift / U", Column::number);
  }
  HtmlTable table("Parameters, expanded uncertainty U = k u (95.45 % coverage)" +
                      std::string(bent ? ", with the missing effects in the model" : ""),
                  columns);
  double most = 0.0;
  std::string which;
  for (const Node& p : final_parameters(report)) {
    const auto now = known(p);
    std::vector<std::string> cells{
        html_symbol(p["symbol"].verbatim()) + " <small>" + html_text(p["name"]) + "</small>",
        now              ? html_pair(now->value, now->U)
        : p.has("value") ? html_number(p["value"].number(), 4) + " (no uncertainty)"
                         : "not determined",
        html_unit(p), now ? html_number(now->k, 3) : "",
        p.has("standard_uncertainty") ? html_number(p["standard_uncertainty"].number(), 2) : ""};
    if (bent) {
      std::string was, shift;
      for (const Node& before : report["declared"]["parameters"].entries()) {
        if (before["name"].verbatim() != p["name"].verbatim() || !before.has("value")) continue;
        const double value = before["value"].number();
        was = html_number(value, 4);
        if (!now || !(now->U > 0.0)) continue;
        const double shifted = (value - now->value) / now->U;
        shift = html_number(std::round(1000.0 * shifted) / 1000.0 + 0.0,
                            2);  // no -0
        if (std::abs(shifted) > std::abs(most)) most = shifted, which = html_text(p["name"]);
      }
      cells.push_back(was);
      cells.push_back(shift);
    }
    table.add(cells);
  }
  if (std::abs(most) >= kWorthTelling)
    facts.emplace_back("What the missing effect had bent most",
                       "<b>" + which + "</b> by " + html_number(most, 2) + " U");
  return table.html();
}

void add_fit_warnings(const Node& fit, std::vector<std::string>& warnings,
                      std::vector<std::string>& next) {
  for (const Node& direction : fit["identifiability"]["unidentifiable"].entries()) {
    bool convention = true;
    std::vector<std::string> names;
    for (const auto& [name, factor] : direction["combination"].named_numbers()) {
      convention = convention && fixed_by_convention(name);
      names.push_back(escaped(name));
    }
    if (convention) continue;
    warnings.push_back("These data do not determine " + joined(names) + " one by one.");
    if (direction.has("advice")) next.push_back(html_text(direction["advice"]));
  }
  for (const Node& parameter : fit["parameters"].entries())
    if (parameter["at_bound"].truth())
      warnings.push_back(html_text(parameter["name"]) + " stands at the end of its range.");
}

void add_input_warnings(const Node& report, std::vector<std::string>& warnings) {
  for (const Node& in : report["inputs"].entries()) {
    std::vector<std::string> parts;
    const auto count = [&](const char* key) { return in.has(key) ? in[key].count() : 0; };
    if (const auto n = count("missing")) parts.push_back(counted(n, "missing value"));
    if (const auto n = count("outlier_count")) parts.push_back(counted(n, "outlier"));
    if (const auto n = count("left_out")) parts.push_back(counted(n, "row") + " left out");
    if (!parts.empty())
      warnings.push_back(html_text(in["name"]) + ": " + joined(parts) +
                         ", see <a href=\"#data\">Data</a>.");
  }
}

std::string facts_html(const std::vector<Fact>& facts) {
  if (facts.empty()) return "";
  std::string out = "<dl class=\"facts\">\n";
  for (const auto& [name, value] : facts)
    out += "<div><dt>" + name + "</dt><dd>" + value + "</dd></div>\n";
  return out + "</dl>\n";
}

}  // namespace

std::string html_verdict(const Node& report) {
  const Verdict verdict = verdict_of(report);
  std::vector<std::string> warnings, next;
  std::vector<Fact> facts;
  const std::string agreement = cross_check(report, warnings);
  add_squareness(report, facts);
  add_straightness(report, facts);
  if (const std::string name = dominant(report); !name.empty())
    facts.emplace_back("Dominates", name);
  if (!agreement.empty()) facts.emplace_back("Fit against run-out, Eq. (21)", agreement);
  if (was_extended(report)) facts.emplace_back("Was missing", found(report["trace"]));
  if (const std::string fall = overall_change(report); !fall.empty())
    facts.emplace_back("Residual rms, before → after", fall);
  else if (report.has("final"))
    facts.emplace_back("Residual rms", html_size(report["final"], "rms"));
  const std::string table = result_table(report, facts);
  if (report.has("final")) add_fit_warnings(report["final"], warnings, next);
  add_input_warnings(report, warnings);
  if (report.has("trace"))
    for (std::string& advice : html_texts(report["trace"]["advice"]))
      next.push_back(std::move(advice));

  std::string out = "<p class=\"verdict\"><strong class=\"badge " + verdict.kind + "\">" +
                    verdict.badge + "</strong> " + verdict.sentence + "</p>\n" + facts_html(facts) +
                    table;
  if (!warnings.empty()) out += "<h3>Warnings</h3>\n" + html_list(warnings);
  if (!next.empty()) out += "<h3>Next steps</h3>\n" + html_list(next);
  return html_section("verdict", "Verdict", out);
}

}  // namespace slideway
