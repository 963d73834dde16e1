#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "environment.hpp"
#include "report_command.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/effects/contract.hpp"
#include "slideway/report/layout.hpp"
#include "slideway/trace/confounding.hpp"

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

std::string line_of(const Effect& effect) {
  const Description& about = effect.description();
  return about.name + "\n" +
         paragraph("  variable " + std::string(symbol(about.variable)) + "   ", about.formula) +
         paragraph("  parameters: ", parameter_list(effect));
}

using Lines = std::vector<std::pair<std::string, std::string>>;

std::string text_of(const Lines& lines) {
  std::string text;
  for (const auto& [label, value] : lines) {
    if (value.empty()) continue;
    text += paragraph("  " + label + ":" + std::string(17 - label.size(), ' '), value);
  }
  return text;
}

std::string entry_of(const Effect& effect) {
  const Description& about = effect.description();
  return about.name + "\n" +
         text_of({{"plain name", about.plain_name},
                  {"standard name", about.standard_name},
                  {"formula", about.formula},
                  {"source", about.source},
                  {"cause", about.cause},
                  {"typical", about.typical},
                  {"variable", std::string(symbol(about.variable))},
                  {"parameters", parameter_list(effect)},
                  {"confounded with", about.confounded_with},
                  {"separated by", about.separated_by}});
}

std::string percent(double share) { return significant(100.0 * share, 3) + " %"; }

/// What the profiles of a problem say of an effect of its own.
std::string design_of(const Confounding& design) {
  std::vector<std::string> alike, apart;
  for (const Lookalike& each : design.lookalikes)
    if (each.share >= kAlike)
      alike.push_back(each.effect + " " + percent(each.share));
    else
      apart.push_back(each.effect + " " + percent(each.share) + ", in " + each.profile + " alone " +
                      percent(each.largest_alone));
  return text_of({{"not testable", design.needs.empty() ? "" : "needs " + design.needs},
                  {"here looks like", joined(alike, "; ")},
                  {"here told from", joined(apart, "; ")}});
}

nlohmann::ordered_json bound(double value) {
  if (std::isfinite(value)) return value;
  return nullptr;
}

nlohmann::ordered_json json_of(const Effect& effect) {
  const Description& about = effect.description();
  nlohmann::ordered_json parameters = nlohmann::ordered_json::array();
  for (const Parameter& parameter : effect.parameters())
    parameters.push_back({{"name", parameter.name},
                          {"symbol", parameter.symbol},
                          {"unit", parameter.unit},
                          {"lower", bound(parameter.lower)},
                          {"upper", bound(parameter.upper)}});
  return {{"name", about.name},
          {"plain_name", about.plain_name},
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

nlohmann::ordered_json json_of(const Confounding& design) {
  nlohmann::ordered_json alike = nlohmann::ordered_json::array();
  for (const Lookalike& each : design.lookalikes)
    alike.push_back({{"effect", each.effect},
                     {"share", each.share},
                     {"largest_alone", each.largest_alone},
                     {"profile", each.profile}});
  return {{"needs", design.needs}, {"lookalikes", alike}};
}

/// An effect as it is listed; what a problem says of it, if it is the problem's own.
struct Listed {
  std::shared_ptr<const Effect> effect;
  std::optional<Confounding> design;

  [[nodiscard]] const std::string& name() const { return effect->description().name; }
};

std::vector<Listed> catalogue() {
  std::vector<Listed> out;
  for (const std::string& name : effect_names())
    out.push_back({std::shared_ptr<const Effect>(&specimen(name), [](const Effect*) {}), {}});
  return out;
}

Listed own(const DeclaredEffect& declared, const Machine& machine) {
  return {make_effect(declared.name, declared.options, machine, {}), {}};
}

/// The effects of a file that problems share, each of which keeps the contract of the catalogue.
std::vector<Listed> in_file(const std::string& path) {
  std::vector<Listed> out;
  std::vector<std::string> faults;
  for (const DeclaredEffect& declared : read_effect_file(path)) {
    out.push_back(own(declared, Machine(Machine::paper_lathe(), Lever::paper)));
    for (const std::string& fault : contract_faults(*out.back().effect))
      faults.push_back(declared.name + ": " + fault);
  }
  if (!faults.empty()) throw UsageError(path + ": " + joined(faults, "; "));
  return out;
}

class EffectsCommand : public ReportCommand {
 public:
  EffectsCommand()
      : ReportCommand("effects", "[NAME|FILE.toml] [options]",
                      "Lists the effects: all, one in full, of a file or of a problem") {
    namespace po = boost::program_options;
    add_input("NAME", &effect_, false);
    add_options()("problem", po::value(&problem_)->value_name("FILE"),
                  "the effects of this problem besides, and what its profiles can tell of them");
    add_options()("data", po::value(&data_)->value_name("DIR"),
                  "what ${SLIDEWAY_DATA} in the problem file stands for");
  }

  int run() override {
    if (!is_file()) listed_ = catalogue();
    if (is_file()) listed_ = in_file(effect_);
    if (!problem_.empty()) add_problem();
    if (is_named_ && !is_file()) choose();
    report([this] { return text(); }, [this] { return json(); });
    return kDone;
  }

 private:
  [[nodiscard]] bool is_file() const { return effect_.ends_with(".toml"); }

  void check(const boost::program_options::variables_map& given) override {
    is_named_ = given.count("NAME") > 0;
    if (is_file() && !problem_.empty()) fail("a file and --problem; accepted: one of the two");
    if (is_named_ && !is_file() && problem_.empty()) {
      listed_ = catalogue();
      choose();
    }
  }

  void add_problem() {
    keep(problem_);
    const Problem problem = read_problem(problem_, data_directory(data_));
    StageLine line(!is_quiet());
    const std::vector<Confounding> designs =
        confounding_of(problem, profiles_of(problem, false, line));
    for (std::size_t i = 0; i < designs.size(); ++i) {
      listed_.push_back(own(problem.own_effects[i], problem.machine()));
      listed_.back().design = designs[i];
    }
  }

  void choose() {
    if (effect_ == "formula" || effect_ == "channel")
      fail("'" + effect_ +
           "' is no effect of the catalogue but makes one in a problem file: see "
           "[[effect]] in slideway help problem-file");
    std::vector<std::string> names;
    for (const Listed& each : listed_) names.push_back(each.name());
    std::erase_if(listed_, [&](const Listed& each) { return each.name() != effect_; });
    if (listed_.empty())
      fail("unknown effect '" + effect_ + "'" + did_you_mean(effect_, names) +
           "; accepted: " + joined(names, " "));
  }

  [[nodiscard]] std::string text() const {
    std::string all;
    for (const Listed& each : listed_) {
      if (!all.empty()) all += '\n';
      const bool in_full = is_named_ || each.design;
      all += in_full ? entry_of(*each.effect) : line_of(*each.effect);
      if (each.design) all += design_of(*each.design);
    }
    return all;
  }

  [[nodiscard]] std::string json() const {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const Listed& each : listed_) {
      list.push_back(json_of(*each.effect));
      if (each.design) list.back()["design"] = json_of(*each.design);
    }
    const nlohmann::ordered_json document = {{"schema", "slideway.effects/1"}, {"effects", list}};
    return document_text(document);
  }

  std::string effect_, problem_, data_;
  bool is_named_ = false;
  std::vector<Listed> listed_;
};

}  // namespace

std::unique_ptr<Command> make_effects() { return std::make_unique<EffectsCommand>(); }

}  // namespace slideway
