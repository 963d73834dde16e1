#include <algorithm>
#include <nlohmann/json.hpp>

#include "slideway/base/text.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/identify/identifiability.hpp"
#include "slideway/report/number.hpp"
#include "summary.hpp"
#include "text_parts.hpp"

/// Names and sentences for people.
namespace slideway {

std::vector<std::string> names_of(const TraceRound& round) {
  std::vector<std::string> names{term_name(round.accepted, round.profiles)};
  names.insert(names.end(), round.ambiguous_with.begin(), round.ambiguous_with.end());
  return names;
}

std::string effect_title(const std::string& name) {
  if (name == kUnnamedRival) return "something without a name";
  return plain_name(name);
}

std::string effect_titles(const std::vector<std::string>& names, const std::string& separator) {
  std::vector<std::string> out;
  for (const std::string& name : names) out.push_back(effect_title(name));
  return joined(out, separator);
}

std::string parts_beside(const Result& result) {
  const std::vector<std::string>& known = effect_names();
  std::vector<std::string> parts;
  std::string of;
  const auto& form = result.final->straightness;
  if (form && !form->profiles.empty())
    of = ", of " + joined(form->profiles) + ", the largest of " + std::to_string(form->each.size());
  for (const std::string& term : result.final->effects) {
    const std::string name = term.substr(0, term.find('['));
    if (std::ranges::count(known, name) == 0 || std::ranges::count(parts, name) > 0 ||
        (form && std::ranges::count(form->parts, term) > 0))
      continue;
    if (is_part_of_straightness(specimen(name).description())) parts.push_back(name);
  }
  return of + (parts.empty() ? "" : ", without " + effect_titles(parts, " and "));
}

std::string parameter_title(const FittedParameter& parameter) {
  const std::size_t dot = parameter.name.rfind('.');
  if (dot == std::string::npos) return parameter.name;
  return effect_title(parameter.name.substr(0, dot)) + " " +
         (parameter.symbol.empty() ? parameter.name.substr(dot + 1) : parameter.symbol);
}

std::string with_titles(std::string text) {
  const auto is_word = [](char c) { return c == '_' || c == '.' || (c >= 'a' && c <= 'z'); };
  for (const std::string& name : effect_names()) {
    if (name.find('_') == std::string::npos) continue;
    for (std::size_t at = 0; (at = text.find(name, at)) != std::string::npos; at += name.size()) {
      const std::size_t end = at + name.size();
      const bool alone = (at == 0 || !is_word(text[at - 1])) &&
                         (end == text.size() || text[end] != '_') &&
                         (end + 1 >= text.size() || text[end] != '.' || !is_word(text[end + 1]));
      if (alone) text.replace(at, name.size(), effect_title(name));
    }
  }
  return text;
}

bool is_squareness(const FittedParameter& parameter) {
  return motion_error_of(parameter.name) == MotionError::squareness;
}

bool is_vertical(const std::string& effect) {
  return motion_error_of(effect) == MotionError::vertical_straightness;
}

std::string variable_of(const Unnamed& left) {
  constexpr const char* kVariables[][2] = {{"r", "the slide coordinate"},
                                           {"t", "the cutting time"},
                                           {"s", "the cutting distance"},
                                           {"X", "the trace position"},
                                           {"t_read", "the reading time"}};
  for (const auto& [symbol, variable] : kVariables)
    if (left.clock == symbol) return variable;
  return "";
}

std::string likeness(const Unnamed& left) {
  if (const std::string variable = variable_of(left); !variable.empty())
    return "a curve over " + variable;
  return left.clock == "per profile" ? "a curve of its own in every profile"
                                     : "a curve in " + left.clock;
}

std::string in_sentence(std::string text) {
  if (text.empty()) return text;
  if (text.front() >= 'a' && text.front() <= 'z') text.front() += 'A' - 'a';
  return text.back() == '.' ? text : text + ".";
}

std::string value_of(const Assumption& assumption) {
  if (!nlohmann::json::accept(assumption.value)) return assumption.value;
  return nlohmann::ordered_json::parse(assumption.value).dump();
}

std::optional<Shift> largest_shift(const Result& result) {
  if (!result.declared || !result.final) return std::nullopt;
  std::optional<Shift> most;
  const auto compare = [&](const std::string& what, const QuantityValue& before,
                           const QuantityValue& after) {
    if (!is_known(after) || !before.value || !(*after.expanded_uncertainty > 0.0)) return;
    const double shift = (*before.value - *after.value) / *after.expanded_uncertainty;
    if (!most || std::abs(shift) > std::abs(most->in_expanded_uncertainties)) most = {what, shift};
  };
  for (const FittedParameter& before : result.declared->parameters)
    if (const FittedParameter* const after = result.final->find(before.name))
      compare(parameter_title(before), before, *after);
  if (result.declared->straightness && result.final->straightness) {
    const auto &before = result.declared->straightness->errors,
               &after = result.final->straightness->errors;
    for (std::size_t i = 0; i < std::min(before.size(), after.size()); ++i)
      if (after[i].line == ReferenceLineKind::end_point) compare("E_ZX", before[i], after[i]);
  }
  return most;
}

bool was_extended(const Analysis& analysis) {
  return analysis.trace && !analysis.trace->rounds.empty() && analysis.result.declared &&
         analysis.result.final;
}

std::string residual_change(const std::optional<double>& before_um,
                            const std::optional<double>& after_um,
                            const std::optional<double>& before_urad,
                            const std::optional<double>& after_urad) {
  const auto change = [](double before, double after, const char* unit) {
    return number(before, 3) + " → " + number(after, 3) + unit;
  };
  std::vector<std::string> out;
  if (before_um && after_um) out.push_back(change(*before_um, *after_um, " µm"));
  if (before_urad && after_urad) out.push_back(change(*before_urad, *after_urad, " µrad"));
  return joined(out);
}

}  // namespace slideway
