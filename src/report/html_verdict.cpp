#include <algorithm>
#include <cmath>

#include "html_curves.hpp"
#include "html_parts.hpp"
#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/identify/result_fields.hpp"
#include "slideway/report/number.hpp"
#include "summary.hpp"
#include "text_parts.hpp"

namespace slideway {
namespace {

constexpr double kWorthTelling = 0.01;  // of U, a shift

Html cards(const std::vector<std::pair<Html, Html>>& facts) {
  Html out;
  for (const auto& [name, value] : facts)
    out += element("div", element("dt", name) + element("dd", value));
  return facts.empty() ? out : element("dl", {{"class", "facts"}}, out);
}

Html coverage_factor_of(const QuantityValue& result) {
  return "k = " + html_number(result.coverage_factor, 3);
}

Html squareness_card(const FittedParameter& p) {
  if (!is_known(p)) return "not determined by these data";
  const auto in = [&](double unit, const char* name) {
    return html_value(p, unit) + " " + name + element("br");
  };
  return in(1.0, "rad") + in(kMicroradian, "µm/m") + in(kArcsecond, "″ (arcsec)") +
         small("± U, " + coverage_factor_of(p) + Html(condition(p.if_no)) +
               "; positive: the face falls from centre to rim");
}

Html unseen_paragraph(const std::string& moved) {
  if (moved.empty()) return {};
  return element("br") + small("what these data do not show may move it " + Html(moved));
}

Html same_paragraph(const Summary& summary) {
  if (summary.same.empty()) return {};
  return element("br") + small("holds whatever has its columns: " + Html(summary.same));
}

Html beside_paragraph(const Result& result) {
  const std::string parts = parts_beside(result);
  return parts.empty() ? Html() : element("br") + small(parts.substr(std::string(", ").size()));
}

Html straightness_card(const Straightness& form) {
  if (form.errors.empty()) return form.reason;
  std::vector<Html> lines;
  for (const StraightnessError& error : form.errors)
    lines.push_back(html_value(error) + " µm " +
                    small(Html(text_of(error.line)) + ", " + coverage_factor_of(error)));
  return joined(lines, element("br"));
}

Html dominant_card(const Dominant& dominant) {
  if (!dominant.doubt.empty()) return with_titles(dominant.doubt);
  const auto name = [](const std::optional<std::string>& effect) {
    return effect ? bold(effect_title(*effect)) : Html();
  };
  const Html correlation = name(dominant.by_correlation), fit = name(dominant.by_fit);
  if (dominant.agree.value_or(false)) return fit + " (correlation and fit agree)";
  std::vector<Html> parts;
  if (!correlation.empty()) parts.push_back("by correlation " + correlation);
  if (!fit.empty()) parts.push_back("by fit " + fit);
  return joined(parts, ", ");
}

Html residual_card(const Analysis& analysis) {
  const ModelResult& now = *analysis.result.final;
  if (!was_extended(analysis)) return html_size(now.rms_um, now.rms_urad);
  const ModelResult& before = *analysis.result.declared;
  return html_size(before.rms_um, before.rms_urad) + " → " + html_size(now.rms_um, now.rms_urad);
}

Html all_cards(const Analysis& analysis, const Summary& summary) {
  const Result& result = analysis.result;
  std::vector<std::pair<Html, Html>> facts;
  if (result.final) {
    for (const FittedParameter& p : result.final->parameters)
      if (is_squareness(p))
        facts.emplace_back("Squareness " + html_symbol(p.symbol),
                           squareness_card(p) + unseen_paragraph(summary.unseen));
    if (result.final->straightness)
      facts.emplace_back("Straightness error " + html_symbol("E_ZX"),
                         straightness_card(*result.final->straightness) + beside_paragraph(result) +
                             same_paragraph(summary) + unseen_paragraph(summary.bent_unseen));
  }
  if (!summary.conformity.empty()) facts.emplace_back("Tolerance", in_sentence(summary.conformity));
  if (const Html name = dominant_card(result.dominant); !name.empty())
    facts.emplace_back("Dominates", name);
  if (summary.has_crosscheck) facts.emplace_back("Cross-check", summary.crosscheck);
  if (summary.has_missing) facts.emplace_back("Was missing", summary.missing);
  if (result.final) facts.emplace_back("Residual rms", residual_card(analysis));
  return cards(facts);
}

/// "thermal drift A", the name in the report in small.
Html named(const FittedParameter& p) {
  const std::string effect = p.name.substr(0, p.name.rfind('.'));
  return effect_title(effect) + " " + html_symbol(p.symbol) + " " + small(p.name);
}

/// The final parameters; where the loop has changed them, those of the declared model beside them.
Html parameters(const Analysis& analysis) {
  const Result& result = analysis.result;
  if (!result.final) return {};
  const bool differs = std::ranges::any_of(result.final->parameters, [&](const FittedParameter& p) {
    return !declared_value(result, p).empty();
  });
  std::vector<std::pair<Html, HtmlColumn>> columns{{"parameter", HtmlColumn::text},
                                                   {"value ± U", HtmlColumn::number},
                                                   {"unit", HtmlColumn::text},
                                                   {"k", HtmlColumn::number},
                                                   {"u", HtmlColumn::number}};
  if (differs) {
    columns.emplace_back("declared model", HtmlColumn::number);
    columns.emplace_back("shift / U", HtmlColumn::number);
  }
  HtmlTable table("Parameters of the final model, expanded uncertainty U = k u (95.45 % coverage)",
                  columns);
  for (const FittedParameter& p : result.final->parameters) {
    std::vector<Html> cells{
        named(p), html_value(p) + (p.at_bound ? ", at the end of its range" : ""),
        html_unit(p.unit), is_known(p) ? html_number(p.coverage_factor, 3) : Html(),
        is_known(p) ? html_number(p.standard_uncertainty, 2) : Html()};
    if (differs) {
      const FittedParameter* const before = result.declared->find(p.name);
      cells.push_back(before != nullptr ? html_value(*before) : Html());
      Html shift;
      if (before != nullptr && before->value && is_known(p) && *p.expanded_uncertainty > 0.0) {
        const double shifted = (*before->value - *p.value) / *p.expanded_uncertainty;
        if (std::abs(shifted) >= kWorthTelling) shift = html_number(shifted, 2);
      }
      cells.push_back(shift);
    }
    table.add(cells);
  }
  return table.html();
}

std::vector<Html> warnings(const Analysis& analysis) {
  const Result& result = analysis.result;
  std::vector<Html> out;
  const auto& angle = result.crosscheck.squareness;
  if (angle && angle->verdict == Consistency::inconsistent)
    out.push_back("The squareness of the fit and that of the run-out disagree, " +
                  html_symbol("E_n") + " = " + html_en(angle->En) + " > 1: " + angle->reason + ".");
  for (const ProfileCheck& check : result.crosscheck.profiles)
    if (check.verdict == Consistency::inconsistent)
      out.push_back(effect_title(check.what) + " of " + who_of(check) + " disagree, " +
                    html_symbol("E_n") + " = " + html_en(check.En) + ".");
  for (const HeldOutCheck& check : result.crosscheck.held_out)
    if (check.verdict == HeldOutVerdict::does_not_fit)
      out.push_back(check.profile + ", held out, does not fit: off by " +
                    html_size(check.largest_um, check.largest_urad) + " at " +
                    html_number(check.at_mm) + " mm.");
  if (result.final)
    for (const UndeterminedDirection* direction : open_directions(*result.final)) {
      std::vector<std::string> names;
      for (const auto& [name, factor] : direction->combination) names.push_back(name);
      out.emplace_back("These data do not determine " + joined(names) + " one by one.");
    }
  for (const InputSummary& in : result.inputs) {
    std::vector<std::string> parts;
    if (in.missing > 0) parts.push_back(counted(in.missing, "missing value"));
    if (in.outlier_count > 0) parts.push_back(counted(in.outlier_count, "outlier"));
    if (in.left_out > 0) parts.push_back(counted(in.left_out, "row") + " left out");
    if (!parts.empty())
      out.push_back(in.name + ": " + joined(parts) + ", see " +
                    element("a", {{"href", "#data"}}, "Data") + ".");
  }
  return out;
}

std::vector<Html> next_steps(const Analysis& analysis) {
  std::vector<Html> out;
  if (analysis.result.final)
    for (const UndeterminedDirection* direction : open_directions(*analysis.result.final))
      if (!direction->advice.empty()) out.emplace_back(with_titles(direction->advice));
  if (!analysis.trace) return out;
  for (const std::string& advice : analysis.trace->advice) out.emplace_back(with_titles(advice));
  if (analysis.trace->next_cut) out.emplace_back(cut_to_make(*analysis.trace->next_cut));
  return out;
}

Html listed(const char* title, const std::vector<Html>& items) {
  return items.empty() ? Html() : element("h3", title) + html_list(items);
}

/// The profile in which most was missing, the model, and what is left before and after.
Html picture(const Analysis& analysis) {
  const std::optional<Curves>& curves = analysis.details.curves;
  if (!curves || curves->profiles.empty()) return {};
  const ProfileCurves& shown = profile_to_show(*curves);
  constexpr double kWidth = 480.0, kHeight = 220.0;  // legible on a telephone too
  Plot form = form_panel(shown), rest = residual_panel(shown);
  form.size(kWidth, kHeight);
  rest.size(kWidth, kHeight);
  if (form.empty() || rest.empty()) return {};
  const Html caption = "Profile " + bold(shown.profile) +
                       " with the final model, and what is left of it" +
                       (shown.residual_after.empty() ? "." : " before and after the loop.");
  return element("figure", {{"class", "first"}},
                 element("div", {{"class", "panels"}}, form.svg() + rest.svg()) +
                     element("figcaption", caption));
}

}  // namespace

Html html_conformity(const Result& result) {
  HtmlTable table("Conformity with the tolerances, ISO 14253-1 (U as guard band)",
                  {{"what", HtmlColumn::text},
                   {"value ± U", HtmlColumn::number},
                   {"limit", HtmlColumn::number},
                   {"unit", HtmlColumn::text},
                   {"verdict", HtmlColumn::text}});
  for (const Conformity& each : result.conformity) {
    const bool angle = each.limit_um_per_m.has_value();
    QuantityValue value;
    value.value = angle ? each.value_um_per_m : each.value_um;
    value.expanded_uncertainty = angle ? each.U_um_per_m : each.U_um;
    table.add({toleranced(each.what), html_value(value),
               html_number(angle ? each.limit_um_per_m : each.limit_um), angle ? "µm/m" : "µm",
               bold(verdict_text(each.verdict)) + condition(result, each)});
  }
  return table.html();
}

HtmlSection html_verdict(const Analysis& analysis) {
  constexpr const char* kKinds[] = {"good", "plain", "warn", "bad"};  // as in Alarm
  const Summary summary = summary_of(analysis);
  const Html badge =
      element("strong",
              {{"class", std::string("badge ") + kKinds[static_cast<std::size_t>(summary.alarm)]}},
              summary.badge);
  return {"verdict", "Verdict",
          element("p", {{"class", "verdict"}}, badge + " " + in_sentence(summary.verdict)) +
              all_cards(analysis, summary) + picture(analysis) + parameters(analysis) +
              html_conformity(analysis.result) + listed("Warnings", warnings(analysis)) +
              listed("Next steps", next_steps(analysis))};
}

}  // namespace slideway
