#include <algorithm>
#include <cmath>
#include <map>

#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/identify/result_fields.hpp"
#include "slideway/report/layout.hpp"
#include "slideway/report/number.hpp"
#include "slideway/report/report.hpp"
#include "summary.hpp"
#include "text_parts.hpp"

namespace slideway {

std::string heading(const std::string& text) { return "\n" + paragraph("", text); }
std::string item(const std::string& text) { return paragraph("  ", text); }
std::string note(const std::string& text) { return paragraph("  - ", text); }

std::string number(double value, int digits) {
  return std::isfinite(value) ? to_digits(value, digits) : "-";
}

std::string unit_text(const std::string& unit) {
  if (unit == "1") return "";
  return unit == "um" ? "µm" : unit == "urad" ? "µrad" : unit;
}

std::string probability(double p) { return p < 1e-4 ? "< 1e-4" : number(p, 2); }

std::string p_text(double p) { return (p < 1e-4 ? "p " : "p = ") + probability(p); }

std::string en_text(double En) {
  constexpr int kDigitsOfADouble = 15;
  std::string text = number(En, 2);
  for (int digits = 3; En > 1.0 && text == "1" && digits <= kDigitsOfADouble; ++digits)
    text = number(En, digits);
  return text;
}

std::string verdict_text(ConformityVerdict verdict) {
  return verdict == ConformityVerdict::undecided ? "cannot be decided"
                                                 : std::string(text_of(verdict));
}

std::string toleranced(const std::string& what) {
  return motion_error_of(what) == MotionError::straightness ? what + " (minimum zone)" : what;
}

std::string declared_value(const Result& result, const FittedParameter& p) {
  const FittedParameter* const before = result.declared ? result.declared->find(p.name) : nullptr;
  return before == nullptr || value_text(*before) == value_text(p) ? "" : value_text(*before);
}

std::string size_text(const std::optional<double>& um, const std::optional<double>& urad,
                      int digits) {
  std::vector<std::string> out;
  if (um) out.push_back(number(*um, digits) + " µm");
  if (urad) out.push_back(number(*urad, digits) + " µrad");
  return out.empty() ? "-" : joined(out);
}

namespace {

constexpr std::size_t kBoxLines = 6, kAllLines = 40;
constexpr std::size_t kParameterRows = 18, kAssumedLines = 3, kStations = 11;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

std::string in_lines(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

/// The first lines of a text; where there are more the last one ends in an ellipsis.
std::vector<std::string> first_lines(std::vector<std::string> lines, std::size_t most) {
  if (lines.size() <= most) return lines;
  lines.resize(most);
  std::string& last = lines.back();
  while (code_points(last) + 2 > kLineWidth) last.erase(last.rfind(' '));
  last += " …";
  return lines;
}

// --- the box ---------------------------------------------------------------------------------

/// With room for six lines: where a sentence needs a second one, entries that say nothing leave;
/// only then long entries are cut, from the last one up, the verdict and the numbers last.
std::string box(const Summary& summary, const TextOptions& options) {
  const auto entry = [&](const char* label, const std::string& words) {
    std::string first = "│ " + std::string(label);
    first.append(11 - code_points(first), ' ');
    std::vector<std::string> lines = lines_of(paragraph(first, words));
    for (std::size_t i = 1; i < lines.size(); ++i) lines[i].replace(0, 1, "│");
    return lines;
  };
  const auto verdict = [&](const std::string& words) {
    return entry("Verdict", summary.badge + ": " + words + ".");
  };
  std::vector<std::vector<std::string>> entries{
      verdict(summary.verdict),
      entry("Result", summary.result),
      entry("Check", options.full ? summary.checks : summary.checks_in_brief),
      entry("Missing", options.full ? summary.missing : summary.missing_in_brief),
      entry("Next", options.full ? summary.next : summary.next_in_brief),
      entry("Page",
            options.page.empty() ? "none was written; --html FILE writes it" : options.page)};
  std::size_t count = 0;
  for (const auto& lines : entries) count += lines.size();
  const auto leave = [&](std::size_t which, bool says_nothing) {
    if (count <= kBoxLines || !says_nothing) return;
    count -= entries[which].size();
    entries[which].clear();
  };
  leave(3, !summary.has_missing || summary.verdict_names_missing);
  leave(5, options.page.empty());
  if (!options.full && count > kBoxLines) {
    count -= entries[0].size();
    entries[0] = verdict(summary.verdict_in_brief);
    count += entries[0].size();
  }
  const auto cut = [&](std::size_t give) {
    while (!options.full && count > kBoxLines && entries[give].size() > 1) {
      entries[give] = first_lines(entries[give], entries[give].size() - 1);
      --count;
    }
  };
  for (const std::size_t give : {5U, 3U, 2U, 4U, 0U}) cut(give);
  leave(5, !options.full);  // sooner than the condition of a number
  cut(1);
  std::string text;
  for (const auto& lines : entries) text += in_lines(lines);
  return text;
}

// --- parameters ---------------------------------------------------------------------------------

/// k; "" for the 2 of many degrees of freedom.
std::string coverage(const FittedParameter& p) {
  if (!is_known(p) || !p.coverage_factor) return "";
  const std::string k = fixed_point(*p.coverage_factor, 2);
  return k == "2.00" ? "" : k;
}

std::string value_of(const FittedParameter& p) {
  return value_text(p) + (p.at_bound ? ", at its bound" : "");
}

std::string model_heading(const ModelResult& model) {
  return heading("Final model: " + effect_titles(model.effects, ", ") + "; " +
                 counted(model.observations, "value") + " (" +
                 number(std::round(model.effective_observations), 15) + " effective), residual " +
                 size_text(model.rms_um, model.rms_urad) + " rms");
}

// --- stations, assumptions, tolerances, notes
// -----------------------------------------------------

std::string stations(const Result& result) {
  if (!result.final || !result.final->straightness) return "";
  const Straightness& form = *result.final->straightness;
  std::string forms;
  if (!form.each.empty()) {
    TextTable table({"form of", "E_ZX ± U, µm"}, {TextColumn::text, TextColumn::text});
    for (const StraightnessOfPart& part : form.each)
      table.add({joined(part.profiles),
                 part.end_point_um && part.expanded_uncertainty_um
                     ? with_uncertainty(*part.end_point_um, *part.expanded_uncertainty_um)
                     : "not determined"});
    forms =
        heading("Straightness of each form, from the line through the end points") + table.text();
  }
  const std::vector<StraightnessStation>& all = form.stations;
  if (all.size() < 2) return forms;
  const std::size_t count = std::min(kStations, all.size());
  std::vector<std::string> x{"x, mm"}, deviation{"E_ZX, µm"}, U{"± U, µm"};
  for (std::size_t i = 0; i < count; ++i) {
    const StraightnessStation& at = all[i * (all.size() - 1) / (count - 1)];
    x.push_back(fixed_point(at.position_mm, 0));
    const RoundedPair pair = rounded(at.deviation_um, at.expanded_uncertainty_um.value_or(0.0));
    deviation.push_back(pair.uncertainty == "0" ? number(at.deviation_um, 3) : pair.value);
    U.push_back(pair.uncertainty);
  }
  TextTable table(std::move(x), std::vector<TextColumn>(count + 1, TextColumn::number));
  table.add(std::move(deviation));
  table.add(std::move(U));
  return forms +
         heading("Station heights" + (form.profiles.empty() ? "" : " of " + joined(form.profiles)) +
                 " from the line through the end points" +
                 (count < all.size()
                      ? " (" + std::to_string(count) + " of " + std::to_string(all.size()) + ")"
                      : std::string())) +
         table.text();
}

/// Keys of profiles without the profile's name, equal ones of several profiles once.
std::string assumed(const Result& result) {
  std::vector<std::pair<std::string, std::vector<std::string>>> entries;
  for (const Assumption& each : result.assumed) {
    std::string key = each.key, profile;
    for (const InputSummary& in : result.inputs) {
      const std::string prefix = "profile." + in.name + ".";
      if (!key.starts_with(prefix)) continue;
      profile = in.name;
      key.erase(0, prefix.size());
      break;
    }
    if (!each.value.empty()) key += " = " + value_of(each);
    auto found = std::ranges::find(entries, key, [](const auto& entry) { return entry.first; });
    if (found == entries.end()) found = entries.insert(found, {key, {}});
    if (!profile.empty()) found->second.push_back(profile);
  }
  std::vector<std::string> out;
  for (const auto& [key, profiles] : entries) {
    const bool some = !profiles.empty() && profiles.size() < result.inputs.size();
    out.push_back(key + (some ? " (" + joined(profiles) + ")" : ""));
  }
  if (out.empty()) return "";
  const std::string text = paragraph("  Assumed: ", joined(out, "; ") + ".");
  return "\n" + in_lines(first_lines(lines_of(text), kAssumedLines));
}

std::string tolerances(const Result& result) {
  std::string out;
  for (const Conformity& each : result.conformity) {
    QuantityValue value;
    const bool angle = each.limit_um_per_m.has_value();
    value.value = angle ? each.value_um_per_m : each.value_um;
    value.expanded_uncertainty = angle ? each.U_um_per_m : each.U_um;
    const double limit = (angle ? each.limit_um_per_m : each.limit_um).value_or(NAN);
    out += item("Tolerance of " + toleranced(each.what) + ": " + value_text(value) + ", limit " +
                number(limit, 4) + (angle ? " µm/m: " : " µm: ") + verdict_text(each.verdict) +
                condition(result, each));
  }
  return out.empty() ? "" : "\n" + out;
}

std::vector<std::string> all_notes(const Analysis& analysis) {
  std::vector<std::string> out;
  const auto add = [&](const std::vector<std::string>& notes) {
    for (const std::string& each : notes) out.push_back(with_titles(each));
  };
  add(analysis.result.notes);
  if (analysis.trace)
    for (const LeftEffect& each : analysis.trace->left)
      out.push_back(effect_title(each.effect) +
                    " was accepted and left again: " + with_titles(each.reason));
  if (analysis.trace) add(analysis.trace->notes);
  if (analysis.result.final) add(analysis.result.final->notes);
  return out;
}

/// As many notes as there is room for, and how many there are besides.
std::string notes(const Analysis& analysis, std::size_t room) {
  const std::vector<std::string> all = all_notes(analysis);
  if (all.empty() || room < 3) return "";
  std::string out;
  std::size_t left = room - 2;  // a blank line, the last line
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::string next = note(all[i]);
    const std::size_t size = lines_of(next).size();
    if (size > left + (i + 1 == all.size() ? 1 : 0)) {
      out += item(counted(all.size() - i, "more note") + ": --full");
      break;
    }
    out += next;
    left -= std::min(left, size);
  }
  return "\n" + out;
}

std::string unseen_lines(const Summary& summary) {
  std::string out;
  if (!summary.same.empty())
    out += note("The straightness holds whatever has its columns: " + summary.same + ".");
  std::vector<std::string> moved;
  if (!summary.unseen.empty()) moved.push_back("the squareness " + summary.unseen);
  if (!summary.bent_unseen.empty()) moved.push_back("E_ZX " + summary.bent_unseen);
  if (!moved.empty())
    out += note("What these data do not show may move " + joined(moved, ", and ") + ".");
  return out;
}

std::string short_text(const Analysis& analysis, const Summary& summary, std::string text) {
  const Result& result = analysis.result;
  const std::string more =
      unseen_lines(summary) + stations(result) + assumed(result) + tolerances(result);
  if (result.final) {
    text += model_heading(*result.final);
    const std::size_t used = lines_of(text + more).size() + 4;  // headings, a note
    const std::size_t room = kAllLines - std::min(kAllLines - 4, used);
    std::size_t rows = std::min(kParameterRows, room);
    std::string table = parameter_table(result, rows);
    while (rows > 1 && lines_of(table).size() > room + 1) table = parameter_table(result, --rows);
    text += table;
  } else {
    text += ranking_text(result);
  }
  text += more;
  const std::size_t used = lines_of(text).size();
  return text + notes(analysis, used < kAllLines ? kAllLines - used : 0);
}

}  // namespace

std::string parameter_table(const Result& result, std::size_t most) {
  const std::vector<FittedParameter>& all = result.final->parameters;
  std::vector<std::vector<std::string>> rows;
  bool has_k = false, has_declared = false;
  for (const FittedParameter& p : all) {
    if (rows.size() + 1 >= most && rows.size() + 1 < all.size()) break;
    rows.push_back({parameter_title(p), value_of(p), unit_text(p.unit), coverage(p),
                    declared_value(result, p)});
    has_k = has_k || !rows.back()[3].empty();
    has_declared = has_declared || !rows.back()[4].empty();
  }
  if (all.empty()) return "";
  std::vector<std::string> headings{"parameter", "value ± U", "unit", has_k ? "k" : "",
                                    has_declared ? "declared model" : ""};
  TextTable table(std::move(headings), std::vector<TextColumn>(5, TextColumn::text));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (has_k && rows[i][3].empty() && is_known(all[i]) && all[i].coverage_factor)
      rows[i][3] = "2.00";
    table.add(std::move(rows[i]));
  }
  if (rows.size() == all.size()) return table.text();
  return table.text() + item(counted(all.size() - rows.size(), "more parameter") + ": --full");
}

std::string text_report(const Analysis& analysis, const TextOptions& options) {
  const Result& result = analysis.result;
  const Summary summary = summary_of(analysis);
  std::string text = box(summary, options);
  text += in_lines(first_lines(lines_of(heading("slideway " + result.version +
                                                (result.title.empty() ? "" : ": " + result.title))),
                               2));
  if (!options.full) return short_text(analysis, summary, std::move(text));
  if (result.final)
    text +=
        model_heading(*result.final) + parameter_table(result, result.final->parameters.size() + 1);
  text += unseen_lines(summary) + stations(result) + tolerances(result) + full_text(analysis);
  std::string notes;
  for (const std::string& each : all_notes(analysis)) notes += note(each);
  return text + (notes.empty() ? "" : heading("Notes") + notes);
}

}  // namespace slideway
