#include <algorithm>
#include <cmath>

#include "html_parts.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/units.hpp"
#include "slideway/identify/identifiability.hpp"

namespace slideway {
namespace {

using Column = HtmlTable::Column;
constexpr double kWorthTelling = 0.01;  // of U, a shift

std::string joined_names(const Json& names, const std::string& separator) {
  std::string out;
  for (const Json& name : names)
    out += (out.empty() ? "" : separator) + "<b>" + escaped(name.get<std::string>()) + "</b>";
  return out;
}

std::string change(const Json& round, const char* stem) {
  for (const char* unit : {"um", "urad"}) {
    const auto before = number_of(round, ("before_" + std::string(stem) + unit).c_str());
    const auto after = number_of(round, ("after_" + std::string(stem) + unit).c_str());
    if (before && after)
      return html_number(*before, 3) + " → " + html_number(*after, 3) + " " + html_unit(unit);
  }
  return "";
}

/// True if the loop has added effects to the declared model.
bool was_extended(const Json& report) {
  return has(report, "trace") && !list_of(report.at("trace"), "rounds").empty();
}

std::string overall_change(const Json& report) {
  if (!was_extended(report) || !has(report, "before") || !has(report, "after")) return "";
  Json both = Json::object();
  for (const char* unit : {"rms_um", "rms_urad"})
    for (const char* when : {"before", "after"})
      if (has(report.at(when), unit))
        both[std::string(when) + "_" + unit] = report.at(when).at(unit);
  return change(both, "rms_");
}

struct Verdict {
  std::string badge, kind, sentence;  // kind: a class of the page
};

std::string found(const Json& trace) {
  std::string out;
  for (const Json& round : list_of(trace, "rounds")) {
    const Json& rivals = list_of(round, "ambiguous_with");
    out += (out.empty() ? "" : " and ") + ("<b>" + text_of(round, "accepted") + "</b>") +
           (rivals.empty() ? "" : " (or " + joined_names(rivals, ", ") + ")");
  }
  return out;
}

Verdict verdict_of(const Json& report) {
  if (!has(report, "fit"))
    return {"Ranking only", "plain", "The effects were ranked by correlation; nothing was fitted."};
  if (!report.at("fit").at("converged").get<bool>())
    return {"Not converged", "bad",
            "The fit did not converge: no number of this report can be relied on."};
  if (!has(report, "trace"))
    return {"Fitted", "plain",
            "The declared model was fitted; whether an effect is missing was not asked."};
  const Json& trace = report.at("trace");
  const std::string verdict = trace.at("verdict").get<std::string>();
  const std::string fall = overall_change(report);
  const std::string falls = fall.empty() ? "" : " The residual goes from " + fall + " rms.";
  if (verdict == "nothing_missing")
    return {"Nothing missing", "good",
            "The declared effects explain the measured profiles down to noise (lack of fit " +
                html_p_value(trace.at("lack_of_fit_p").get<double>()) + ")."};
  if (verdict == "explained")
    return {"Explained", "good",
            "The declared model lacked " + found(trace) + ", and now has it." + falls};
  if (verdict == "ambiguous")
    return {"Ambiguous", "warn",
            "The declared model lacks an effect: " + found(trace) +
                ". These data can not tell which." + falls};
  const std::string beside = found(trace);
  if (verdict == "not_identifiable")
    return {"Not identifiable", "bad",
            (beside.empty() ? "" : "The declared model lacked " + beside + "." + falls + " ") +
                "A form is there of which these data can not tell what makes it."};
  if (verdict != "unnamed") throw DataError("'verdict' is none of this program");
  const std::string size =
      has(trace, "unnamed") ? html_size(trace.at("unnamed"), "rms") + " rms" : "";
  return {"Unnamed", "bad",
          "Structure is left that no effect of the catalogue explains: " + size +
              (beside.empty() ? "" : ", beside " + beside) + "."};
}

std::string cross_check(const Json& report, std::vector<std::string>& warnings) {
  if (!has(report, "crosscheck") || !has(report.at("crosscheck"), "squareness")) return "";
  const Json& check = report.at("crosscheck").at("squareness");
  const auto en = number_of(check, "En");
  if (!en) return "";
  const std::string number = "<i>E</i><sub>n</sub> = " + html_number(*en, 2);
  if (check.at("verdict") == "inconsistent") {
    warnings.push_back("The squareness of the fit and that of the run-out disagree, " + number +
                       " &gt; 1: " + text_of(check, "reason") + ".");
    return number + ": inconsistent";
  }
  return number + ": consistent (not above 1)";
}

std::string dominant(const Json& report) {
  const Json& dominant = report.at("dominant");
  if (has(dominant, "doubt") && dominant.at("doubt") != "") return text_of(dominant, "doubt");
  const auto name = [&](const char* key) {
    return has(dominant, key) ? "<b>" + text_of(dominant, key) + "</b>" : std::string();
  };
  const std::string correlation = name("by_correlation"), fit = name("by_fit");
  if (correlation.empty() && fit.empty()) return "";
  if (has(dominant, "agree") && dominant.at("agree").get<bool>())
    return fit + " (correlation and fit agree)";
  return (correlation.empty() ? "" : "by correlation " + correlation) +
         (correlation.empty() || fit.empty() ? "" : ", by fit ") +
         (correlation.empty() ? "by fit " : "") + fit;
}

const Json& final_parameters(const Json& report) {
  if (has(report, "after")) return list_of(report.at("after"), "parameters");
  return has(report, "fit") ? list_of(report.at("fit"), "parameters") : list_of(report, "fit");
}

struct Known {
  double value, U, k;
};

std::optional<Known> known(const Json& parameter) {
  const auto value = number_of(parameter, "value"),
             U = number_of(parameter, "expanded_uncertainty");
  if (!value || !U) return std::nullopt;
  return Known{*value, *U, number_of(parameter, "coverage_factor").value_or(2.0)};
}

std::string with_k(const Known& of, double unit, const std::string& name) {
  return html_pair(of.value / unit, of.U / unit) + " " + name;
}

using Fact = std::pair<std::string, std::string>;

void add_squareness(const Json& report, std::vector<Fact>& facts) {
  for (const Json& parameter : final_parameters(report)) {
    if (!parameter.at("name").get<std::string>().starts_with("squareness")) continue;
    const std::string head = "Squareness " + html_symbol(parameter.at("symbol").get<std::string>());
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

void add_straightness(const Json& report, std::vector<Fact>& facts) {
  if (!has(report, "straightness")) return;
  const Json& straightness = report.at("straightness");
  if (list_of(straightness, "errors").empty()) {
    facts.emplace_back("Straightness of the slide", text_of(straightness, "reason"));
    return;
  }
  std::string text;
  for (const Json& error : straightness.at("errors"))
    text += html_pair(error.at("error_um").get<double>(),
                      error.at("expanded_uncertainty_um").get<double>()) +
            " µm <small>" + text_of(error, "line") +
            ", k = " + html_number(error.at("coverage_factor").get<double>(), 3) + "</small><br>";
  facts.emplace_back("Straightness error <i>E</i><sub>ZX</sub>", text);
}

/// Declared parameters before and after the loop; the largest shift goes into the facts.
std::string result_table(const Json& report, std::vector<Fact>& facts) {
  const bool bent = has(report, "before") && was_extended(report);
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
  for (const Json& p : final_parameters(report)) {
    const auto now = known(p);
    std::vector<std::string> cells{
        html_symbol(p.at("symbol").get<std::string>()) + " <small>" + text_of(p, "name") +
            "</small>",
        now               ? html_pair(now->value, now->U)
        : has(p, "value") ? html_number(p.at("value").get<double>(), 4) + " (no uncertainty)"
                          : "not determined",
        html_unit(p.at("unit").get<std::string>()), now ? html_number(now->k, 3) : "",
        has(p, "standard_uncertainty") ? html_number(p.at("standard_uncertainty").get<double>(), 2)
                                       : ""};
    if (bent) {
      std::string was, shift;
      for (const Json& before : list_of(report.at("before"), "parameters")) {
        if (before.at("name") != p.at("name") || !has(before, "value")) continue;
        const double value = before.at("value").get<double>();
        was = html_number(value, 4);
        if (!now || !(now->U > 0.0)) continue;
        const double shifted = (value - now->value) / now->U;
        shift = html_number(std::round(1000.0 * shifted) / 1000.0 + 0.0, 2);  // no -0
        if (std::abs(shifted) > std::abs(most)) most = shifted, which = text_of(p, "name");
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

void add_fit_warnings(const Json& fit, std::vector<std::string>& warnings,
                      std::vector<std::string>& next) {
  const Json& what = fit.at("identifiability");
  for (const Json& direction : list_of(what, "unidentifiable")) {
    bool convention = true;
    std::string names;
    for (const auto& [name, factor] : direction.at("combination").items()) {
      convention = convention && fixed_by_convention(name);
      names += (names.empty() ? "" : ", ") + escaped(name);
    }
    if (convention) continue;
    warnings.push_back("These data do not determine " + names + " one by one.");
    if (has(direction, "advice")) next.push_back(text_of(direction, "advice"));
  }
  for (const Json& parameter : list_of(fit, "parameters"))
    if (parameter.at("at_bound").get<bool>())
      warnings.push_back(text_of(parameter, "name") + " stands at the end of its range.");
}

void add_input_warnings(const Json& report, std::vector<std::string>& warnings) {
  const auto counted = [](std::size_t n, const std::string& what) {
    return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
  };
  for (const Json& in : report.at("inputs")) {
    std::vector<std::string> parts;
    const auto count = [&](const char* key) {
      return in.contains(key) ? in.at(key).get<std::size_t>() : 0;
    };
    if (const auto n = count("missing")) parts.push_back(counted(n, "missing value"));
    if (const auto n = count("outlier_count")) parts.push_back(counted(n, "outlier"));
    if (const auto n = count("left_out")) parts.push_back(counted(n, "row") + " left out");
    std::string text;
    for (const std::string& part : parts) text += (text.empty() ? "" : ", ") + part;
    if (!text.empty())
      warnings.push_back(text_of(in, "name") + ": " + text + ", see <a href=\"#data\">Data</a>.");
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

std::string html_verdict(const Json& report) {
  const Verdict verdict = verdict_of(report);
  std::vector<std::string> warnings, next;
  std::vector<Fact> facts;
  const std::string agreement = cross_check(report, warnings);
  add_squareness(report, facts);
  add_straightness(report, facts);
  if (const std::string name = dominant(report); !name.empty())
    facts.emplace_back("Dominates", name);
  if (!agreement.empty()) facts.emplace_back("Fit against run-out, Eq. (21)", agreement);
  if (was_extended(report)) facts.emplace_back("Was missing", found(report.at("trace")));
  if (const std::string fall = overall_change(report); !fall.empty())
    facts.emplace_back("Residual rms, before → after", fall);
  else if (has(report, "fit"))
    facts.emplace_back("Residual rms", html_size(report.at("fit"), "rms"));
  const std::string table = result_table(report, facts);
  if (has(report, "fit")) add_fit_warnings(report.at("fit"), warnings, next);
  add_input_warnings(report, warnings);
  if (has(report, "trace"))
    for (const Json& advice : list_of(report.at("trace"), "advice"))
      next.push_back(escaped(advice.get<std::string>()));

  std::string out = "<p class=\"verdict\"><strong class=\"badge " + verdict.kind + "\">" +
                    verdict.badge + "</strong> " + verdict.sentence + "</p>\n" + facts_html(facts) +
                    table;
  if (!warnings.empty()) out += "<h3>Warnings</h3>\n" + html_list(warnings);
  if (!next.empty()) out += "<h3>Next steps</h3>\n" + html_list(next);
  return html_section("verdict", "Verdict", out);
}

}  // namespace slideway
