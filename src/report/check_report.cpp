#include "slideway/report/check_report.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "slideway/base/text.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/identify/result_fields.hpp"
#include "slideway/report/layout.hpp"
#include "summary.hpp"
#include "text_parts.hpp"

namespace slideway {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostAlike = 3;  // that are listed

std::string percent(double share) { return significant(100.0 * share, 3) + " %"; }

std::string profiles(const Result& data) {
  std::string text = heading("Profiles");
  for (std::size_t i = 0; i < data.inputs.size(); ++i) {
    const InputSummary& in = data.inputs[i];
    const std::string values =
        data.low_band[i].level == 0
            ? "no low band"
            : "low band " + std::to_string(data.low_band[i].values) + " values";
    text += paragraph("  " + in.name + "  ",
                      std::string(text_of(in.kind)) + ", " + std::string(text_of(in.quantity)) +
                          ", " + in.file + ": " + counted(in.samples, "reading") + " from " +
                          significant(in.position_min_mm, 6) + " to " +
                          significant(in.position_max_mm, 6) + " mm; " + values +
                          (in.role == Role::holdout ? "; held out" : ""));
    for (const std::string& each : in.notes) text += paragraph("    - ", each);
  }
  return text;
}

std::string assumed_defaults(const Result& data) {
  if (data.assumed.empty()) return "";
  std::string text = heading("Assumed, because the problem file does not say");
  for (const Assumption& each : data.assumed)
    text +=
        item(each.key + (each.value.empty() ? "" : " = " + value_of(each)) + " (" + each.why + ")");
  return text;
}

std::string combination(const UndeterminedDirection& direction) {
  std::vector<std::string> names;
  for (const auto& [name, factor] : direction.combination) names.push_back(name);
  return joined(names);
}

bool is_convention(const UndeterminedDirection& direction) {
  return std::ranges::all_of(direction.combination,
                             [](const auto& part) { return fixed_by_convention(part.first); });
}

std::string determined(const DesignCheck& design) {
  std::string text = heading("These profiles determine");
  text += item(design.rank.determined.empty() ? "no parameter of the declared model"
                                              : joined(design.rank.determined));
  std::string open, convention;
  for (const UndeterminedDirection& each : design.rank.undetermined)
    if (is_convention(each))
      convention += (convention.empty() ? "" : ", ") + combination(each);
    else
      open += note(combination(each) + ": " +
                   (each.combination.size() > 1 ? "not one by one. " : "not at all. ") +
                   in_sentence(with_titles(each.advice)));
  if (!open.empty()) text += heading("They do not determine") + open;
  if (!convention.empty()) text += item("Set to 0 by convention: " + convention + ".");
  return text;
}

std::string not_testable(const DesignCheck& design) {
  std::string text;
  for (const Confounding& each : design.confounding)
    if (!each.needs.empty()) text += note(effect_title(each.effect) + ": needs " + each.needs);
  return text.empty() ? "" : heading("Effects that cannot be looked for") + text;
}

std::vector<std::string> looks_like(const Confounding& each) {
  std::vector<std::string> out;
  std::size_t count = 0;
  for (const Lookalike& other : each.lookalikes)
    if (other.share >= kAlike && ++count <= kMostAlike)
      out.push_back(effect_title(other.effect) + " " + percent(other.share));
  if (count > kMostAlike) out.push_back(std::to_string(count - kMostAlike) + " more");
  return out;
}

std::string alike(const DesignCheck& design) {
  std::string text;
  for (const Confounding& each : design.confounding)
    if (const auto others = looks_like(each); !others.empty())
      text += note(effect_title(each.effect) + ": " + joined(others));
  return text.empty() ? ""
                      : heading(
                            "Effects that look alike here, by the share of one that the other "
                            "makes") +
                            text;
}

std::string faults_text(const Faults& faults) {
  std::string text;
  for (const Fault& fault : faults) text += (text.empty() ? "" : "\n") + fault_text(fault);
  return text + "\n" + counted(faults.size(), "fault") + "\n";
}

Json json_of(const Fault& fault) {
  const std::optional<Excerpt> excerpt = excerpt_of(fault);
  const auto or_null = [](bool known, const auto& value) { return known ? Json(value) : Json(); };
  Json out{{"message", fault.message},
           {"file", or_null(!fault.file.empty(), fault.file)},
           {"line", or_null(fault.line > 0, fault.line)},
           {"key", or_null(!fault.key.empty(), fault.key)},
           {"kind", fault.is_of_data ? "data" : "problem"}};
  out["excerpt"] = excerpt ? Json(excerpt->line) : Json();
  out["column"] = excerpt ? Json(excerpt->first + 1) : Json();
  out["length"] = excerpt ? Json(excerpt->count) : Json();
  return out;
}

Json json_of(const DesignCheck& design) {
  Json undetermined = Json::array(), confounding = Json::array();
  for (const UndeterminedDirection& each : design.rank.undetermined) {
    Json combination = Json::object();
    for (const auto& [name, factor] : each.combination) combination[name] = factor;
    undetermined.push_back({{"combination", combination}, {"advice", each.advice}});
  }
  for (const Confounding& each : design.confounding) {
    Json others = Json::array();
    for (const Lookalike& other : each.lookalikes)
      others.push_back({{"effect", other.effect},
                        {"share", other.share},
                        {"largest_alone", other.largest_alone},
                        {"profile", other.profile}});
    confounding.push_back({{"effect", each.effect},
                           {"needs", each.needs.empty() ? Json() : Json(each.needs)},
                           {"lookalikes", others}});
  }
  return {{"effects", design.effects},
          {"identifiable", design.rank.determined},
          {"unidentifiable", undetermined},
          {"candidates", confounding}};
}

}  // namespace

std::string fault_text(const Fault& fault) {
  std::string text = paragraph("", fault.message);
  const std::optional<Excerpt> excerpt = excerpt_of(fault);
  if (!excerpt) return text;
  const std::string margin = "  " + std::to_string(fault.line) + " | ";
  const std::string blank(code_points(margin) - 2, ' ');
  return text + margin + excerpt->line + "\n" + blank + "| " + std::string(excerpt->first, ' ') +
         std::string(std::max<std::size_t>(excerpt->count, 1), '^') + "\n";
}

std::string check_text(const ProblemCheck& check) {
  if (!check.design) return faults_text(check.faults);
  return paragraph("", check.path.string() + ": no fault; slideway identify will read it") +
         profiles(*check.data) + assumed_defaults(*check.data) + determined(*check.design) +
         not_testable(*check.design) + alike(*check.design);
}

std::string check_json(const ProblemCheck& check) {
  Json faults = Json::array(), assumed = Json::array(), notes = Json::array();
  for (const Fault& fault : check.faults) faults.push_back(json_of(fault));
  if (check.data)
    for (const Assumption& each : check.data->assumed)
      assumed.push_back(
          {{"key", each.key},
           {"value", Json::accept(each.value) ? Json::parse(each.value) : Json(each.value)},
           {"why", each.why}});
  if (check.data)
    for (const InputSummary& in : check.data->inputs)
      for (const std::string& each : in.notes)
        notes.push_back({{"profile", in.name}, {"note", each}});
  const Json document{{"schema", "slideway.check/1"},
                      {"problem", check.path.string()},
                      {"faults", faults},
                      {"assumed", assumed},
                      {"notes", notes},
                      {"design", check.design ? json_of(*check.design) : Json()}};
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace slideway
