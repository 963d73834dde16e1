#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "slideway/base/text.hpp"
#include "slideway/identify/result_fields.hpp"
#include "slideway/report/layout.hpp"
#include "slideway/report/number.hpp"
#include "slideway/report/report.hpp"
#include "summary.hpp"
#include "text_parts.hpp"

namespace slideway {
namespace {

constexpr std::size_t kCorrelationsListed = 3;  // correlations listed
constexpr double kBetter = 0.05;                // a coefficient at a lag worth telling

std::string text(auto value) { return std::string(text_of(value)); }

std::string coefficient(double value) {
  return (value < 0.0 ? "-" : "+") + fixed_point(std::abs(value), 4);
}

std::string assumed_in_full(const Result& result) {
  std::string out;
  for (const Assumption& each : result.assumed)
    out += note(each.key + (each.value.empty() ? "" : " = " + value_of(each)) + ": " + each.why);
  return out.empty() ? "" : heading("Assumed: the problem file does not say") + out;
}

std::string inputs(const Result& result) {
  TextTable table({"profile", "kind", "role", "samples", "range, mm", "rms", "p-v"},
                  {TextColumn::name, TextColumn::text, TextColumn::text, TextColumn::number,
                   TextColumn::number, TextColumn::number, TextColumn::number});
  std::string notes;
  for (const InputSummary& in : result.inputs) {
    table.add({in.name, text(in.kind) + " " + text(in.quantity), text(in.role),
               std::to_string(in.samples),
               number(in.position_min_mm, 5) + " to " + number(in.position_max_mm, 5),
               size_text(in.rms_um, in.rms_urad), size_text(in.pv_um, in.pv_urad)});
    notes += note(in.name + ": " + in.file + ", sha256 " + in.sha256.substr(0, 16) +
                  (in.missing > 0 ? ", " + counted(in.missing, "missing value") : "") +
                  (in.left_out > 0 ? ", " + std::to_string(in.left_out) + " left out" : "") +
                  (in.loss ? ", loss " + text(*in.loss) : ""));
    for (const std::string& each : in.notes) notes += note(in.name + ": " + each);
  }
  return heading("Inputs") + table.text() + notes;
}

std::string closure(const Result& result) {
  if (!result.closure) return "";
  std::string out = heading("Closure between lines: " + text(result.closure->verdict));
  for (const std::string& line : result.closure->notes) out += note(line);
  return out;
}

std::string low_band(const Result& result) {
  if (result.low_band.empty()) return "";
  TextTable table({"profile", "wavelet", "level", "ends", "values"},
                  {TextColumn::name, TextColumn::text, TextColumn::number, TextColumn::text,
                   TextColumn::number});
  for (const LowBandSummary& low : result.low_band)
    table.add({low.profile, low.level == 0 ? "none, as it is" : low.wavelet,
               std::to_string(low.level), low.level == 0 ? "" : text(low.boundary),
               std::to_string(low.values)});
  return heading("Low band") + table.text();
}

std::string candidate_correlations(std::vector<CandidateCorrelation> pairs) {
  const auto larger = [](const auto& a, const auto& b) {
    return std::abs(a.coefficient) > std::abs(b.coefficient);
  };
  std::ranges::stable_sort(pairs, larger);
  if (pairs.empty()) return "";
  TextTable table({"effect", "effect", "profile", "r"},
                  {TextColumn::text, TextColumn::text, TextColumn::name, TextColumn::number});
  for (std::size_t i = 0; i < std::min(kCorrelationsListed, pairs.size()); ++i)
    table.add({effect_title(pairs[i].a), effect_title(pairs[i].b), pairs[i].profile,
               coefficient(pairs[i].coefficient)});
  return item("Largest correlations of the candidates among themselves:") + table.text();
}

std::string better_when_shifted(const std::vector<Ranking>& entries) {
  std::vector<std::string> out;
  for (const Ranking& entry : entries)
    if (std::abs(entry.lag_coefficient) > std::abs(entry.low_band) + kBetter)
      out.push_back(effect_title(entry.effect) + " on " + entry.profile + " " +
                    coefficient(entry.lag_coefficient) + " by " + number(entry.lag_mm, 3) + " mm");
  return out.empty() ? "" : item("Correlation is larger when shifted: " + joined(out) + ".");
}

std::string ranking(const RankingResult& ranking) {
  if (ranking.entries.empty()) return "";
  TextTable table({"effect", "profile", "raw", "low band", "N_eff", "p"},
                  {TextColumn::text, TextColumn::name, TextColumn::number, TextColumn::number,
                   TextColumn::number, TextColumn::number});
  for (const Ranking& entry : ranking.entries)
    table.add({effect_title(entry.effect), entry.profile, coefficient(entry.raw),
               coefficient(entry.low_band), number(entry.effective_observations, 3),
               probability(entry.p_value)});
  std::string out = heading("Ranking by correlation, Eqs. (6), (19), (20)") + table.text() +
                    better_when_shifted(ranking.entries) +
                    candidate_correlations(ranking.among_candidates);
  for (const std::string& line : ranking.notes) out += note(line);
  return out;
}

std::string dominant(const Dominant& dominant) {
  if (!dominant.doubt.empty())
    return heading("Dominant effect: " + with_titles(dominant.doubt) + ".");
  std::vector<std::string> names;
  if (dominant.by_correlation)
    names.push_back("by correlation " + effect_title(*dominant.by_correlation));
  if (dominant.by_fit) names.push_back("by fit " + effect_title(*dominant.by_fit));
  if (dominant.agree) names.emplace_back(*dominant.agree ? "the two agree" : "they do not agree");
  return names.empty() ? "" : heading("Dominant effect: " + joined(names) + ".");
}

std::string standard_terms(const ModelResult& model) {
  std::string out;
  std::set<std::pair<std::string, std::string>> seen;
  for (const FittedParameter& p : model.parameters) {
    const std::string effect = p.name.substr(0, p.name.rfind('.'));
    if (p.standard_name.empty() || !seen.emplace(effect, p.standard_name).second) continue;
    out += note(effect_title(effect) + ": " + p.standard_name);
  }
  return out;
}

std::string nuisances(const ModelResult& model) {
  if (model.nuisances.empty()) return "";
  TextTable table({"levelling of the traces", "value ± U", "unit"},
                  {TextColumn::text, TextColumn::text, TextColumn::text});
  for (const FittedParameter& p : model.nuisances)
    table.add({p.name, value_text(p), unit_text(p.unit)});
  return table.text();
}

std::string parameter_correlations(const ModelResult& model) {
  auto pairs = model.correlations;
  std::ranges::stable_sort(pairs, [](const auto& a, const auto& b) {
    return std::abs(std::get<2>(a)) > std::abs(std::get<2>(b));
  });
  std::vector<std::string> out;
  for (std::size_t i = 0; i < std::min(kCorrelationsListed, pairs.size()); ++i)
    out.push_back(std::get<0>(pairs[i]) + " and " + std::get<1>(pairs[i]) + " " +
                  coefficient(std::get<2>(pairs[i])));
  return out.empty() ? "" : item("Largest correlations of the estimates: " + joined(out) + ".");
}

std::string fit(const ModelResult& model) {
  std::string head = model.converged ? "Fit: converged" : "Fit: NOT CONVERGED";
  if (!model.converged && !model.message.empty()) head += " (" + model.message + ")";
  head += ", " + counted(model.observations, "value") + " (" +
          number(std::round(model.effective_observations), 15) + " effective), residual rms " +
          size_text(model.rms_um, model.rms_urad, 4);
  const bool declared = std::ranges::all_of(
      model.noise, [](const auto& n) { return n.scaling == NoiseScaling::declared; });
  if (declared)  // where noise is estimated, the two are equal by construction
    head += ", chi-square " + fixed_point(model.chi_square, 0) + " at " +
            fixed_point(model.degrees_of_freedom, 0) + " degrees of freedom";
  std::string out =
      heading(head) + nuisances(model) + standard_terms(model) + parameter_correlations(model);
  if (model.neglected_um)
    out += item("Largest term of second order left out at these values: " +
                number(*model.neglected_um, 2) + " µm.");
  return out;
}

std::string noise(const ModelResult& model) {
  if (model.noise.empty()) return "";
  TextTable table(
      {"profile", "uncertainty", "correlated", "std. dev.", "corr., mm", "N_eff", "Ljung-Box p"},
      {TextColumn::name, TextColumn::text, TextColumn::text, TextColumn::number, TextColumn::number,
       TextColumn::number, TextColumn::number});
  std::string notes;
  for (const NoiseSummary& n : model.noise) {
    const std::string scaling = text(n.scaling);
    const std::size_t colon = scaling.find(": ");
    table.add({n.profile, scaling.substr(0, colon), n.correlated ? "yes" : "no",
               size_text(n.standard_deviation_um, n.standard_deviation_urad),
               number(n.correlation_mm, 3), number(n.effective_observations, 3),
               probability(n.ljung_box_p)});
    if (colon != std::string::npos) notes += note(n.profile + ": " + scaling.substr(colon + 2));
  }
  return heading(
             "How the uncertainties were scaled: standard deviation of one low-band value, "
             "correlation of the residual") +
         table.text() + notes;
}

std::string identifiability(const ModelResult& model) {
  const Identifiability& what = model.identifiability;
  const std::string rank = "rank " + std::to_string(what.rank) + " of " +
                           counted(what.parameters, "parameter") + ", condition " +
                           number(what.condition, 3);
  if (what.unidentifiable.empty()) return heading("All parameters are determined (" + rank + ")");
  std::string out = heading("What these data cannot determine (" + rank + ")");
  for (const UndeterminedDirection& direction : what.unidentifiable) {
    out += item(in_words(direction.combination, model));
    if (!direction.advice.empty()) out += paragraph("    ", with_titles(direction.advice));
  }
  if (!what.determined.empty()) out += heading("What they determine instead");
  for (const DeterminedCombination& sum : what.determined)
    out += item(in_words(sum.combination, model) + " = " + value_text(sum) + " " +
                unit_text(sum.unit));
  return out;
}

std::string residuals(const ModelResult& model) {
  std::string out;
  if (!model.contributions.empty()) {
    TextTable shares({"effect", "profile", "rms", "share"},
                     {TextColumn::text, TextColumn::name, TextColumn::number, TextColumn::number});
    for (const Contribution& c : model.contributions)
      shares.add({effect_title(c.effect), c.profile, size_text(c.rms_um, c.rms_urad),
                  fixed_point(100.0 * c.share, 1) + " %"});
    out += heading("Share of each effect in the levelled low band") + shares.text();
  }
  if (!model.residuals.empty()) {
    TextTable table({"profile", "role", "rms", "p-v"},
                    {TextColumn::name, TextColumn::text, TextColumn::number, TextColumn::number});
    for (const ResidualSummary& r : model.residuals)
      table.add({r.profile, r.role == Role::holdout ? "held out" : "fit",
                 size_text(r.rms_um, r.rms_urad, 4), size_text(r.pv_um, r.pv_urad, 4)});
    out += heading("Residual in the low band") + table.text();
  }
  return out;
}

std::string squareness_check(const SquarenessCheck& check) {
  if (!check.fit_rad && !check.indirect_rad) return "";
  const auto angle = [](const std::optional<double>& rad, const std::optional<double>& U) {
    QuantityValue value;
    value.value = rad;
    value.expanded_uncertainty = U;
    return rad ? value_text(value, kMicroradian) + " µm/m" : std::string("none");
  };
  std::string out =
      "Squareness by the fit: " + angle(check.fit_rad, check.fit_U_rad) +
      "; by the run-out, Eq. (21): " + angle(check.indirect_rad, check.indirect_U_rad) + "; ";
  if (check.En) out += "E_n = " + en_text(*check.En) + ": ";
  if (check.verdict == Consistency::consistent)
    out += "consistent (E_n is not above 1" +
           std::string(shows_little(check) ? ", though U exceeds both" : "") + "); ";
  else if (check.verdict == Consistency::inconsistent)
    out += "INCONSISTENT (E_n is above 1); ";
  else
    out += "no cross-check: ";
  if (!check.reason.empty()) out += check.reason;
  out += ". ";
  const auto amplitude = [](const std::optional<double>& um) {
    return um ? number(*um, 4) + " µm" : std::string("unknown");
  };
  const bool is_explained = check.verdict == Consistency::inconsistent;  // with these numbers
  if (!is_explained && check.travel_mm && (check.fit_amplitude_um || check.indirect_amplitude_um))
    out += "Over the travel of " + number(*check.travel_mm, 5) + " mm that is " +
           amplitude(check.fit_amplitude_um) + " by the fit and " +
           amplitude(check.indirect_amplitude_um) + " by the run-out.";
  return item(out);
}

std::string crosscheck(const Crosscheck& checks) {
  std::string out = checks.squareness ? squareness_check(*checks.squareness) : "";
  for (const ProfileCheck& check : checks.profiles) {
    std::vector<std::string> said{text(check.verdict)};
    if (check.En) said.insert(said.begin(), "E_n = " + en_text(*check.En));
    if (!check.value_um.empty()) said.insert(said.begin(), each_alone(check));
    if (shows_little(check)) said.emplace_back("though U exceeds what is compared");
    out += note(check.what + " of " + who_of(check) + ": " + joined(said));
  }
  if (!checks.profiles.empty())
    out += note(
        "E_n of profiles: the largest difference of their two curves over its U, the U that " +
        (checks.profiles.size() == 1 ? std::string("holds along the whole curve")
                                     : "holds for all " + std::to_string(checks.profiles.size()) +
                                           " comparisons together and along the whole curve") +
        (is_of_all(checks.profiles.back())
             ? "; of effects taken together, the root of chi-square over its quantile"
             : ""));
  for (const HeldOutCheck& check : checks.held_out)
    out += note(check.profile + ", held out: " + text(check.verdict) + " (chi-square per value " +
                number(check.chi2, 3) + "; " + p_text(check.p_value) +
                " by the sharpest of four tests), off by up to " +
                size_text(check.largest_um, check.largest_urad) + " at " + number(check.at_mm, 4) +
                " mm");
  for (const PureErrorCheck& check : checks.repeats)
    out += note("repeats " + joined(check.profiles, " and ") + ": what they have in common " +
                (check.verdict != RepeatFit::fits ? "is LACK OF FIT of the model"
                 : is_texture(check)              ? "is a texture of the surface"
                                                  : "is no more than noise") +
                " (F = " + number(check.F, 3) + ", " + p_text(check.p_value) + ", " +
                size_text(check.common_um, check.common_urad) + " rms; one reading is off it by " +
                size_text(check.apart_um, check.apart_urad) + " rms)");
  return out.empty() ? "" : heading("Cross-check") + out;
}

}  // namespace

std::string in_words(const Combination& terms, const ModelResult& model) {
  const auto last = [](const std::string& name) { return name.substr(name.rfind('.') + 1); };
  std::map<std::string, int> count;
  for (const FittedParameter& p : model.parameters) ++count[last(p.name)];
  std::string out;
  for (const auto& [name, factor] : terms) {
    out += out.empty() ? (factor < 0.0 ? "-" : "") : (factor < 0.0 ? " - " : " + ");
    const std::string size = number(std::abs(factor), 2);
    if (size != "1") out += size + " ";
    out += count[last(name)] == 1 ? last(name) : name;
  }
  return out;
}

std::string data_text(const Result& result) {
  return heading("slideway " + result.version + ": " + result.title).substr(1) + inputs(result) +
         low_band(result) + assumed_in_full(result) + closure(result);
}

std::string ranking_text(const Result& result) {
  return ranking(result.ranking) + dominant(result.dominant);
}

std::string full_text(const Analysis& analysis) {
  const Result& result = analysis.result;
  std::string out = assumed_in_full(result) + inputs(result) + closure(result) + low_band(result) +
                    ranking_text(result);
  if (result.final)
    out += fit(*result.final) + noise(*result.final) + identifiability(*result.final) +
           residuals(*result.final);
  out += crosscheck(result.crosscheck);
  if (analysis.trace) out += trace_text(*analysis.trace);
  if (analysis.details.curves) out += residual_pictures(*analysis.details.curves);
  return out;
}

}  // namespace slideway
