#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "report_command.hpp"
#include "slideway/base/text.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/report/layout.hpp"

namespace slideway {
namespace {

std::string with_unit(const Parameter& parameter) {
  return parameter.unit.empty() ? parameter.name : parameter.name + " (" + parameter.unit + ")";
}

std::string parameter_list(const Effect& effect) {
  std::vector<std::string> names;
  for (const Parameter& parameter : effect.parameters()) names.push_back(with_unit(parameter));
  return joined(names);
}

std::string line_of(const std::string& name) {
  const Effect& effect = specimen(name);
  const Description& about = effect.description();
  return name + "\n" +
         paragraph("  variable " + std::string(symbol(about.variable)) + "   ", about.formula) +
         paragraph("  parameters: ", parameter_list(effect));
}

std::string entry_of(const std::string& name) {
  const Effect& effect = specimen(name);
  const Description& about = effect.description();
  const std::vector<std::pair<std::string, std::string>> lines{
      {"standard name", about.standard_name},
      {"formula", about.formula},
      {"source", about.source},
      {"cause", about.cause},
      {"typical", about.typical},
      {"variable", std::string(symbol(about.variable))},
      {"parameters", parameter_list(effect)},
      {"confounded with", about.confounded_with},
      {"separated by", about.separated_by}};
  std::string text = name + "\n";
  for (const auto& [label, value] : lines) {
    if (value.empty()) continue;
    text += paragraph("  " + label + ":" + std::string(17 - label.size(), ' '), value);
  }
  return text;
}

nlohmann::ordered_json bound(double value) {
  if (std::isfinite(value)) return value;
  return nullptr;
}

nlohmann::ordered_json json_of(const std::string& name) {
  const Effect& effect = specimen(name);
  const Description& about = effect.description();
  nlohmann::ordered_json parameters = nlohmann::ordered_json::array();
  for (const Parameter& parameter : effect.parameters())
    parameters.push_back({{"name", parameter.name},
                          {"symbol", parameter.symbol},
                          {"unit", parameter.unit},
                          {"lower", bound(parameter.lower)},
                          {"upper", bound(parameter.upper)}});
  return {{"name", name},
          {"standard_name", about.standard_name},
          {"formula", about.formula},
          {"source", about.source},
          {"cause", about.cause},
          {"typical", about.typical},
          {"clock", symbol(about.variable)},
          {"parameters", parameters},
          {"confounded_with", about.confounded_with},
          {"confounded_effects", about.confounded_effects},
          {"separated_by", about.separated_by}};
}

class EffectsCommand : public ReportCommand {
 public:
  EffectsCommand()
      : ReportCommand("effects", "[NAME] [options]",
                      "Lists the catalogue of effects, or one entry in full") {
    add_input("NAME", &effect_, false);
  }

  int run() override {
    report([this] { return text(); }, [this] { return json(); });
    return kDone;
  }

 private:
  void check(const boost::program_options::variables_map& given) override {
    const std::vector<std::string>& names = effect_names();
    if (given.count("NAME") != 0 && std::find(names.begin(), names.end(), effect_) == names.end())
      fail("unknown effect '" + effect_ + "'" + did_you_mean(effect_, names) +
           "; accepted: " + joined(names, " "));
  }

  [[nodiscard]] std::string text() const {
    if (!effect_.empty()) return entry_of(effect_);
    std::string all;
    for (const std::string& name : effect_names()) {
      if (!all.empty()) all += '\n';
      all += line_of(name);
    }
    return all;
  }

  [[nodiscard]] std::string json() const {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const std::string& name : effect_names())
      if (effect_.empty() || effect_ == name) list.push_back(json_of(name));
    const nlohmann::ordered_json document = {{"schema", "slideway.effects/1"}, {"effects", list}};
    return document_text(document);
  }

  std::string effect_;
};

}  // namespace

std::unique_ptr<Command> make_effects() { return std::make_unique<EffectsCommand>(); }

}  // namespace slideway
