#include "slideway/report/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "json_parts.hpp"
#include "json_writer.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/report/layout.hpp"
#include "slideway/report/number.hpp"
#include "slideway/trace/analysis_fields.hpp"
#include "summary.hpp"
#include "text_parts.hpp"

namespace slideway {
namespace {

using Parameters = std::vector<FittedParameter>;
using Facts = std::vector<std::pair<std::string, std::string>>;

/// One parameter in both; absent where a report has none or does not determine it.
struct Pair {
  std::string name, symbol, unit;
  std::optional<double> a, b, difference, U, En;
  std::string in_a, in_b;  // with U
};

struct Change {
  std::string what, a, b;  // "" where a report does not have it
};

const Parameters& parameters_of(const Analysis& analysis) {
  static const Parameters kNone;
  return analysis.result.final ? analysis.result.final->parameters : kNone;
}

const FittedParameter* find(const Parameters& all, const std::string& name) {
  const auto found = std::ranges::find(all, name, &FittedParameter::name);
  return found == all.end() ? nullptr : &*found;
}

std::optional<double> value_of(const FittedParameter* p) {
  return p != nullptr && p->identifiable ? p->value : std::nullopt;
}

Pair pair_of(const FittedParameter* a, const FittedParameter* b) {
  const FittedParameter& any = a != nullptr ? *a : *b;
  Pair out{.name = any.name,
           .symbol = any.symbol,
           .unit = any.unit,
           .a = value_of(a),
           .b = value_of(b),
           .difference = {},
           .U = {},
           .En = {},
           .in_a = a != nullptr ? value_text(*a) : "-",
           .in_b = b != nullptr ? value_text(*b) : "-"};
  if (!out.a || !out.b) return out;
  out.difference = *out.b - *out.a;
  if (!a->expanded_uncertainty || !b->expanded_uncertainty) return out;
  out.U = std::hypot(*a->expanded_uncertainty, *b->expanded_uncertainty);
  if (*out.U > 0.0 && std::isfinite(*out.difference / *out.U))
    out.En = std::abs(*out.difference) / *out.U;
  return out;
}

std::vector<Pair> pairs_of(const NamedReport& a, const NamedReport& b) {
  const Parameters &in_a = parameters_of(a.analysis), &in_b = parameters_of(b.analysis);
  std::vector<Pair> out;
  for (const FittedParameter& p : in_a) {
    const FittedParameter* other = find(in_b, p.name);
    if (other != nullptr && other->unit != p.unit)
      throw DataError(b.name + ": " + p.name + " is in '" + other->unit + "', in " + a.name +
                      " in '" + p.unit + "'; accepted: two reports in the same units");
    out.push_back(pair_of(&p, other));
  }
  for (const FittedParameter& p : in_b)
    if (find(in_a, p.name) == nullptr) out.push_back(pair_of(nullptr, &p));
  return out;
}

std::string in_short(const std::optional<double>& value) {
  return value ? significant(*value, 4) : "";
}

std::string in_words(const LowBandSummary& band) {
  if (band.level == 0) return "none";
  return band.wavelet + ", level " + std::to_string(band.level) + ", ends " +
         std::string(text_of(band.boundary));
}

/// Members of a record that are there, but for some.
template <Recorded T>
void add_members(const std::string& what, const T& object, std::span<const std::string_view> others,
                 Facts& facts) {
  JsonWriter writer(JsonWriter::Layout::one_line);
  writer.write(object);
  const Json members = Json::parse(writer.take());
  for (const auto& [key, value] : members.items())
    if (!value.is_null() && std::ranges::count(others, key) == 0)
      facts.emplace_back(what + ", " + key,
                         value.is_string() ? value.template get<std::string>() : value.dump());
}

void add_inputs(const Analysis& analysis, Facts& facts) {
  constexpr std::string_view kNotInput[] = {"name",  "file",  "sha256",   "outliers", "rms_um",
                                            "pv_um", "notes", "rms_urad", "pv_urad",  "format"};
  constexpr std::string_view kName[] = {"profile"};
  const Result& result = analysis.result;
  for (const InputSummary& in : result.inputs) {
    facts.emplace_back("input " + in.name + ", sha256", in.sha256.substr(0, 16));
    add_members("input " + in.name, in, kNotInput, facts);
  }
  for (const LowBandSummary& band : result.low_band)
    facts.emplace_back("low band of " + band.profile, in_words(band));
  if (result.travel) facts.emplace_back("lever", text_of(result.travel->lever));
  for (const ProfileSetup& each : analysis.details.setups)
    add_members("setup of " + each.profile, each, kName, facts);
  if (analysis.details.options) add_members("options", *analysis.details.options, {}, facts);
  for (const Assumption& each : result.assumed)
    facts.emplace_back("assumed " + each.key, value_of(each));
  if (!result.final || !result.declared) return;
  std::vector<std::string> free;
  for (const FittedParameter& p : result.final->nuisances) free.push_back(p.name);
  facts.emplace_back("levelling", joined(free));
  facts.emplace_back("declared effects", joined(result.declared->effects));
  for (const NoiseSummary& each : result.final->noise)
    facts.emplace_back("uncertainty of " + each.profile, text_of(each.scaling));
}

void add_checks(const Result& result, Facts& facts) {
  for (const Conformity& each : result.conformity) {
    facts.emplace_back("tolerance of " + each.what,
                       in_short(each.limit_um ? each.limit_um : each.limit_um_per_m));
    facts.emplace_back("conformity of " + each.what,
                       verdict_text(each.verdict) + condition(result, each));
  }
  if (result.closure) facts.emplace_back("closure between lines", text_of(result.closure->verdict));
  const Crosscheck& checks = result.crosscheck;
  if (checks.squareness)
    facts.emplace_back("cross-check of squareness", text_of(checks.squareness->verdict));
  for (const ProfileCheck& each : checks.profiles)
    facts.emplace_back(each.what + " of " + who_of(each), text_of(each.verdict));
  for (const HeldOutCheck& each : checks.held_out)
    facts.emplace_back(each.profile + ", held out", text_of(each.verdict));
  for (const PureErrorCheck& each : checks.repeats)
    facts.emplace_back("repeats " + joined(each.profiles, " and "), text_of(each.verdict));
}

void add_loop(const TraceResult& trace, Facts& facts) {
  facts.emplace_back("closed loop", text_of(trace.verdict));
  if (trace.unfinished) facts.emplace_back("closed loop, ended by", "the time limit");
  for (const Blunder& each : trace.blunders)
    facts.emplace_back("blunder of " + each.profile, text_of(each.what));
  std::vector<std::string> accepted;
  for (const TraceRound& round : trace.rounds)
    accepted.push_back(term_name(round.accepted, round.profiles));
  facts.emplace_back("effects found", accepted.empty() ? "none" : joined(accepted));
}

/// @param with_gates  the other report has a closed loop, too
Facts facts_of(const Analysis& analysis, bool with_gates) {
  const Result& result = analysis.result;
  Facts facts{{"title", result.title}, {"version", result.version}};
  for (const auto& [key, value] : result.about) facts.emplace_back("about, " + key, value);
  add_inputs(analysis, facts);
  facts.emplace_back("dominant by correlation", result.dominant.by_correlation.value_or("none"));
  facts.emplace_back("dominant by fit", result.dominant.by_fit.value_or("none"));
  if (result.declared)
    facts.emplace_back("residual rms of the declared model, um", in_short(result.declared->rms_um));
  if (result.final) {
    facts.emplace_back("fit", result.final->converged ? "converged" : "not converged");
    facts.emplace_back("residual rms of the final model, um", in_short(result.final->rms_um));
  }
  add_checks(result, facts);
  if (!analysis.trace) return facts;
  add_loop(*analysis.trace, facts);
  if (with_gates)
    for (const auto& [gate, value] : analysis.trace->gates)
      facts.emplace_back("gate " + gate, in_short(value));
  return facts;
}

std::vector<Change> changes_of(const NamedReport& a, const NamedReport& b) {
  const bool both = a.analysis.trace && b.analysis.trace;
  const Facts in_a = facts_of(a.analysis, both), in_b = facts_of(b.analysis, both);
  std::vector<Change> out;
  for (const auto& [what, value] : in_a) {
    const auto other = std::ranges::find(in_b, what, &Facts::value_type::first);
    const std::string there = other == in_b.end() ? "" : other->second;
    if (there != value) out.push_back({what, value, there});
  }
  for (const auto& [what, value] : in_b)
    if (!value.empty() && std::ranges::find(in_a, what, &Facts::value_type::first) == in_a.end())
      out.push_back({what, "", value});
  return out;
}

std::string parameter_text(const std::vector<Pair>& pairs) {
  if (pairs.empty()) return heading("Parameters: none in either report");
  TextTable table({"parameter", "A ± U", "B ± U", "B - A", "E_n", "unit"},
                  {TextColumn::text, TextColumn::text, TextColumn::text, TextColumn::number,
                   TextColumn::number, TextColumn::text});
  std::vector<std::string> changed;
  const auto digits = [](const std::optional<double>& value, int count) {
    return value ? number(*value, count) : "-";
  };
  for (const Pair& p : pairs) {
    table.add({p.name, p.in_a, p.in_b, digits(p.difference, 2), p.En ? en_text(*p.En) : "-",
               unit_text(p.unit)});
    if (p.En && *p.En > 1.0) changed.push_back(p.name);
  }
  return heading("Final parameters; E_n = |B - A| / U of the difference") + table.text() +
         item(changed.empty() ? "None has changed by more than U."
                              : "Changed by more than U: " + joined(changed) + ".");
}

Json json_of(const Pair& p) {
  return {{"name", p.name},
          {"symbol", p.symbol},
          {"unit", p.unit},
          {"a", or_null(p.a)},
          {"b", or_null(p.b)},
          {"difference", or_null(p.difference)},
          {"expanded_uncertainty", or_null(p.U)},
          {"En", or_null(p.En)}};
}

Json json_of(const Change& change) {
  return {{"what", change.what}, {"a", change.a}, {"b", change.b}};
}

Json json_of(const NamedReport& report) {
  return {{"file", report.name},
          {"title", report.analysis.result.title},
          {"version", report.analysis.result.version}};
}

}  // namespace

std::string comparison_text(const NamedReport& a, const NamedReport& b) {
  std::string text = paragraph("A: ", a.name + ": " + a.analysis.result.title) +
                     paragraph("B: ", b.name + ": " + b.analysis.result.title) +
                     parameter_text(pairs_of(a, b));
  const std::vector<Change> changes = changes_of(a, b);
  if (changes.empty()) return text + heading("Inputs, options and verdicts are the same.");
  text += heading("What else is not the same");
  for (const Change& change : changes)
    text += note(change.what + ": " + (change.a.empty() ? "-" : change.a) + " -> " +
                 (change.b.empty() ? "-" : change.b));
  return text;
}

std::string comparison_json(const NamedReport& a, const NamedReport& b) {
  const auto to_json = [](const auto& each) { return json_of(each); };
  const Json document = {{"schema", "slideway.diff/1"},
                         {"a", json_of(a)},
                         {"b", json_of(b)},
                         {"parameters", array_of(pairs_of(a, b), to_json)},
                         {"changes", array_of(changes_of(a, b), to_json)}};
  return laid_out(document) + "\n";
}

}  // namespace slideway
