#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/report/layout.hpp"
#include "slideway/report/number.hpp"
#include "slideway/report/report.hpp"
#include "slideway/trace/analysis_fields.hpp"
#include "text_parts.hpp"

namespace slideway {

std::string heading(const std::string& text) { return "\n" + paragraph("", text); }
std::string item(const std::string& text) { return paragraph("  ", text); }
std::string note(const std::string& text) { return paragraph("  - ", text); }

std::string number(double value, int digits) {
  return std::isfinite(value) ? to_digits(value, digits) : "-";
}

std::string unit_text(const std::string& unit) {
  return unit == "um" ? "µm" : unit == "urad" ? "µrad" : unit;
}

std::string probability(double p) { return p < 1e-4 ? "< 1e-4" : number(p, 2); }

namespace {

using Column = TextTable::Column;
constexpr std::size_t kLargest = 3;  // correlations listed
constexpr double kBetter = 0.05;     // a coefficient at a lag worth telling

std::string coefficient(double value) {
  if (!std::isfinite(value)) return "-";
  return (value < 0.0 ? "-" : "+") + fixed_point(std::abs(value), 4);
}

std::string size_in(const std::optional<double>& um, const std::optional<double>& urad) {
  if (um) return number(*um, 3) + " µm";
  if (urad) return number(*urad, 3) + " µrad";
  return "-";
}

/// With a capital and a full stop; REQUIRES a first letter of ASCII.
std::string sentence(std::string text) {
  if (text.front() >= 'a' && text.front() <= 'z') text.front() += 'A' - 'a';
  return text.back() == '.' ? text : text + ".";
}

std::string title(const Result& result) {
  const std::string line = paragraph(
      "", "slideway " + result.version + (result.title.empty() ? "" : ": " + result.title));
  const std::size_t width = std::min(code_points(line) - 1, kLineWidth);
  return line + std::string(width, '=') + "\n";
}

std::string inputs(const Result& result) {
  TextTable table({"profile", "kind", "role", "samples", "range, mm", "rms", "p-v"},
                  {Column::name, Column::text, Column::text, Column::number, Column::number,
                   Column::number, Column::number});
  std::string notes;
  for (const InputSummary& in : result.inputs) {
    table.add({in.name, std::string(text_of(in.kind)) + " " + std::string(text_of(in.quantity)),
               std::string(text_of(in.role)), std::to_string(in.samples),
               number(in.position_min_mm, 5) + " to " + number(in.position_max_mm, 5),
               size_in(in.rms_um, in.rms_urad), size_in(in.pv_um, in.pv_urad)});
    notes += note(in.name + ": " + in.file + ", sha256 " + in.sha256.substr(0, 16) +
                  (in.missing > 0 ? ", " + counted(in.missing, "missing value") : "") +
                  (in.left_out > 0 ? ", " + std::to_string(in.left_out) + " left out" : ""));
    for (const std::string& text : in.notes) notes += note(in.name + ": " + text);
  }
  return heading("Inputs") + table.text() + notes;
}

std::string closure(const ClosureSummary& closure) {
  std::string text = heading("Closure between lines: " + std::string(text_of(closure.verdict)));
  for (const std::string& line : closure.notes) text += note(line);
  return text;
}

std::string low_band(const Result& result) {
  std::string text;
  for (const LowBandSummary& band : result.low_band) {
    const std::string what = band.level == 0
                                 ? "none (level 0), the profile as it is"
                                 : band.wavelet + ", level " + std::to_string(band.level) +
                                       ", ends " + std::string(text_of(band.boundary));
    text += note(band.profile + ": " + what + ", " + counted(band.values, "value"));
  }
  return text.empty() ? "" : heading("Low band") + text;
}

std::string candidate_correlations(std::vector<CandidateCorrelation> pairs) {
  const auto larger = [](const auto& a, const auto& b) {
    return std::abs(a.coefficient) > std::abs(b.coefficient);
  };
  std::stable_sort(pairs.begin(), pairs.end(), larger);
  if (pairs.empty()) return "";
  std::string text = item("Largest correlations of the candidates among themselves:");
  TextTable table({"effect", "effect", "profile", "r"},
                  {Column::effect, Column::effect, Column::name, Column::number});
  for (std::size_t i = 0; i < std::min(kLargest, pairs.size()); ++i)
    table.add({pairs[i].a, pairs[i].b, pairs[i].profile, coefficient(pairs[i].coefficient)});
  return text + table.text();
}

std::string better_when_shifted(const std::vector<Ranking>& entries) {
  std::string text;
  for (const Ranking& entry : entries)
    if (std::abs(entry.lag_coefficient) > std::abs(entry.low_band) + kBetter)
      text += " " + entry.effect + " on " + entry.profile + " " +
              coefficient(entry.lag_coefficient) + " by " + number(entry.lag_mm, 3) + " mm,";
  if (text.empty()) return text;
  text.back() = '.';
  return item("Correlation is larger when shifted:" + text);
}

std::string ranking(const RankingResult& ranking) {
  if (ranking.entries.empty()) return "";
  TextTable table({"effect", "profile", "raw", "low band", "N_eff", "p"},
                  {Column::effect, Column::name, Column::number, Column::number, Column::number,
                   Column::number});
  for (const Ranking& entry : ranking.entries)
    table.add({entry.effect, entry.profile, coefficient(entry.raw), coefficient(entry.low_band),
               number(entry.effective_observations, 3), probability(entry.p_value)});
  std::string text = heading("Ranking by correlation, Eqs. (6), (19), (20)") + table.text() +
                     better_when_shifted(ranking.entries) +
                     candidate_correlations(ranking.among_candidates);
  for (const std::string& line : ranking.notes) text += note(line);
  return text;
}

std::string dominant(const Dominant& dominant) {
  if (!dominant.by_correlation && !dominant.by_fit) return "";
  if (!dominant.doubt.empty()) return heading("Dominant effect: " + dominant.doubt + ".");
  std::string text;
  if (dominant.by_correlation) text += " by correlation " + *dominant.by_correlation + ",";
  if (dominant.by_fit) text += " by fit " + *dominant.by_fit + ",";
  text.back() = dominant.agree ? ':' : '.';
  if (dominant.agree) text += *dominant.agree ? " the two agree." : " the two do not agree.";
  return heading("Dominant effect:" + text);
}

std::string value_of(const FittedParameter& p) {
  if (!p.identifiable || !p.value) return "not determined";
  if (!p.expanded_uncertainty) return number(*p.value, 6) + " (no uncertainty)";
  return with_uncertainty(*p.value, *p.expanded_uncertainty);
}

void add_parameter(TextTable& table, const FittedParameter& p) {
  const bool known = p.identifiable && p.value;
  table.add({p.symbol, p.name, value_of(p), unit_text(p.unit),
             known && p.coverage_factor ? fixed_point(*p.coverage_factor, 2) : "",
             p.at_bound ? "at its bound" : ""});
  const bool is_squareness = motion_error_of(p.name) == MotionError::squareness;
  if (!known || !p.expanded_uncertainty || !is_squareness) return;
  table.add({"", "  in µm/m", with_uncertainty(*p.value * 1e6, *p.expanded_uncertainty * 1e6),
             "µm/m", "", ""});
  table.add({"", "  in arcsec",
             with_uncertainty(*p.value / kArcsecond, *p.expanded_uncertainty / kArcsecond),
             "arcsec", "", ""});
}

std::string parameters(const std::vector<FittedParameter>& all, const std::string& name) {
  if (all.empty()) return "";
  TextTable table(
      {"", name, "value ± U", "unit", "k", ""},
      {Column::text, Column::name, Column::text, Column::text, Column::number, Column::text});
  for (const FittedParameter& p : all) add_parameter(table, p);
  return table.text();
}

std::string standard_terms(const ModelResult& fit) {
  std::string text;
  std::set<std::pair<std::string, std::string>> seen;
  for (const FittedParameter& p : fit.parameters) {
    const std::string effect = p.name.substr(0, p.name.rfind('.'));
    if (p.standard_name.empty() || !seen.emplace(effect, p.standard_name).second) continue;
    text += note(effect + ": " + p.standard_name);
  }
  return text;
}

std::string parameter_correlations(const ModelResult& fit) {
  auto pairs = fit.correlations;
  std::stable_sort(pairs.begin(), pairs.end(), [](const auto& a, const auto& b) {
    return std::abs(std::get<2>(a)) > std::abs(std::get<2>(b));
  });
  if (pairs.empty()) return "";
  std::string text = "Largest correlations of the estimates:";
  for (std::size_t i = 0; i < std::min(kLargest, pairs.size()); ++i)
    text += " " + std::get<0>(pairs[i]) + " and " + std::get<1>(pairs[i]) + " " +
            coefficient(std::get<2>(pairs[i])) + ",";
  text.back() = '.';
  return item(text);
}

std::string fit_table(const ModelResult& fit) {
  std::string head = fit.converged ? "Fit: converged" : "Fit: NOT CONVERGED";
  if (!fit.converged && !fit.message.empty()) head += " (" + fit.message + ")";
  head += ", " + counted(fit.observations, "value") + " (" + number(fit.effective_observations, 4) +
          " effective)";
  if (fit.rms_um) head += ", residual rms " + number(*fit.rms_um, 4) + " µm";
  const bool declared = std::all_of(fit.noise.begin(), fit.noise.end(), [](const auto& n) {
    return n.scaling == NoiseScaling::declared;
  });
  if (declared)  // where noise is estimated, the two are equal by construction
    head += ", chi-square " + number(fit.chi_square, 4) + " at " +
            number(fit.degrees_of_freedom, 4) + " degrees of freedom";
  std::string text = heading(head) + parameters(fit.parameters, "parameter") +
                     parameters(fit.nuisances, "levelling of the traces") + standard_terms(fit) +
                     parameter_correlations(fit);
  if (fit.neglected_um)
    text += item("Largest term of second order left out at these values: " +
                 number(*fit.neglected_um, 2) + " µm.");
  return text;
}

std::string noise(const ModelResult& fit) {
  if (fit.noise.empty()) return "";
  TextTable table(
      {"profile", "uncertainty", "AR", "std. dev.", "corr., mm", "N_eff", "Ljung-Box p"},
      {Column::name, Column::text, Column::number, Column::number, Column::number, Column::number,
       Column::number});
  std::string notes;
  for (const NoiseSummary& n : fit.noise) {
    const std::string scaling(text_of(n.scaling));
    const std::size_t colon = scaling.find(": ");
    table.add({n.profile, scaling.substr(0, colon), std::to_string(n.order),
               size_in(n.standard_deviation_um, n.standard_deviation_urad),
               number(n.correlation_mm, 3), number(n.effective_observations, 3),
               probability(n.ljung_box_p)});
    if (colon != std::string::npos) notes += note(n.profile + ": " + scaling.substr(colon + 2));
  }
  return heading(
             "How the uncertainties were scaled: standard deviation of one low-band value, "
             "AR(p) correlation of the residual") +
         table.text() + notes;
}

/// Names without their effect where that leaves no two alike.
std::map<std::string, std::string> short_names(const ModelResult& fit) {
  const auto last = [](const std::string& name) { return name.substr(name.rfind('.') + 1); };
  std::map<std::string, int> count;
  for (const FittedParameter& p : fit.parameters) ++count[last(p.name)];
  std::map<std::string, std::string> names;
  for (const FittedParameter& p : fit.parameters)
    if (count[last(p.name)] == 1) names[p.name] = last(p.name);
  return names;
}

std::string in_words(const Combination& terms, const std::map<std::string, std::string>& names) {
  std::string text;
  for (const auto& [name, factor] : terms) {
    if (text.empty())
      text = factor < 0.0 ? "-" : "";
    else
      text += factor < 0.0 ? " - " : " + ";
    const std::string size = number(std::abs(factor), 2);
    if (size != "1") text += size + " ";
    const auto found = names.find(name);
    text += found == names.end() ? name : found->second;
  }
  return text;
}

std::string identifiability(const ModelResult& fit) {
  const Identifiability& what = fit.identifiability;
  const std::string rank = "rank " + std::to_string(what.rank) + " of " +
                           counted(what.parameters, "parameter") + ", condition " +
                           number(what.condition, 3);
  if (what.unidentifiable.empty()) return heading("All parameters are determined (" + rank + ")");
  const auto names = short_names(fit);
  std::string text = heading("What these data cannot determine (" + rank + ")");
  for (const UndeterminedDirection& direction : what.unidentifiable) {
    text += item(in_words(direction.combination, names));
    if (!direction.advice.empty()) text += paragraph("    ", direction.advice);
  }
  if (!what.determined.empty()) text += heading("What they determine instead");
  for (const DeterminedCombination& sum : what.determined)
    text += item(in_words(sum.combination, names) + " = " +
                 (sum.value && sum.expanded_uncertainty
                      ? with_uncertainty(*sum.value, *sum.expanded_uncertainty)
                      : std::string("unknown")) +
                 " " + sum.unit);
  return text;
}

std::string residuals(const ModelResult& fit) {
  std::string text;
  if (!fit.contributions.empty()) {
    TextTable shares({"effect", "profile", "rms", "share"},
                     {Column::effect, Column::name, Column::number, Column::number});
    for (const Contribution& c : fit.contributions)
      shares.add(
          {c.effect, c.profile, size_in(c.rms_um, c.rms_urad), number(100.0 * c.share, 3) + " %"});
    text += heading("Share of each effect in the low band at the fitted values") + shares.text();
  }
  if (!fit.residuals.empty()) {
    TextTable table({"profile", "role", "rms", "p-v"},
                    {Column::name, Column::text, Column::number, Column::number});
    for (const ResidualSummary& r : fit.residuals) {
      table.add({r.profile, r.role == Role::holdout ? "held out" : "fit",
                 size_in(r.rms_um, r.rms_urad), size_in(r.pv_um, r.pv_urad)});
    }
    text += heading("Residual in the low band") + table.text();
  }
  return text;
}

std::string squareness_of(const std::optional<double>& rad, const std::optional<double>& U_rad) {
  if (!rad) return "none";
  const std::string unit = " µm/m";
  return (U_rad ? with_uncertainty(*rad * 1e6, *U_rad * 1e6) : number(*rad * 1e6, 4)) + unit;
}

std::string crosscheck(const SquarenessCheck& check) {
  if (!check.fit_rad && !check.indirect_rad) return "";
  std::string text =
      "Squareness by the fit: " + squareness_of(check.fit_rad, check.fit_U_rad) +
      "; by the run-out, Eq. (21): " + squareness_of(check.indirect_rad, check.indirect_U_rad) +
      ". ";
  if (check.En) text += "E_n = " + number(*check.En, 2) + ": ";
  if (check.verdict == Consistency::consistent)
    text += "consistent (E_n is not above 1). ";
  else if (check.verdict == Consistency::inconsistent)
    text += "INCONSISTENT (E_n is above 1). ";
  else
    text += "No cross-check. ";
  if (!check.reason.empty()) text += sentence(check.reason) + " ";
  const auto amplitude = [](const std::optional<double>& um) {
    return um ? number(*um, 4) + " µm" : std::string("unknown");
  };
  const bool told = check.verdict == Consistency::inconsistent;  // in the reason
  if (!told && check.travel_mm && (check.fit_amplitude_um || check.indirect_amplitude_um))
    text += "Over the travel of " + number(*check.travel_mm, 5) + " mm that is " +
            amplitude(check.fit_amplitude_um) + " by the fit and " +
            amplitude(check.indirect_amplitude_um) + " by the run-out.";
  return heading("Cross-check") + item(text);
}

std::string notes(const ModelResult& fit) {
  std::string text = fit.notes.empty() ? "" : heading("Notes");
  for (const std::string& line : fit.notes) text += note(line);
  return text;
}

}  // namespace

std::string data_text(const Result& result) {
  return title(result) + inputs(result) + (result.closure ? closure(*result.closure) : "");
}

std::string text_report(const Analysis& analysis) {
  const Result& result = analysis.result;
  std::string text =
      data_text(result) + low_band(result) + ranking(result.ranking) + dominant(result.dominant);
  if (result.final)
    text += fit_table(*result.final) + noise(*result.final) + identifiability(*result.final) +
            residuals(*result.final);
  if (result.crosscheck.squareness) text += crosscheck(*result.crosscheck.squareness);
  if (analysis.trace) text += trace_text(analysis);
  if (analysis.details.curves) text += residual_pictures(*analysis.details.curves);
  if (result.final) text += notes(*result.final);
  for (const std::string& line : result.notes) text += note(line);
  return text;
}

}  // namespace slideway
