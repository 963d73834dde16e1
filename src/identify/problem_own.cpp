#include "problem_own.hpp"

#include <algorithm>

#include "problem_toml.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/effects/formula.hpp"

namespace slideway {
namespace {

constexpr std::string_view kFormulaKeys =
    "as formula parameters standard_name cause source typical confounded_with separated_by";

std::string identifier(const Section& section, std::string_view key) {
  std::string name = section.required(key, section.text(key), "a name of its own");
  if (!is_identifier(name))
    section.fail(key, "'" + name + "' is no name; accepted: a letter, then letters, digits, _");
  return name;
}

std::vector<FormulaParameter> read_formula_parameters(const Section& effect) {
  std::vector<FormulaParameter> out;
  for (const Section& section : effect.tables("parameters")) {
    section.accept("name unit lower upper");
    FormulaParameter parameter{identifier(section, "name"), "", section.number("lower"),
                               section.number("upper")};
    // A [[truth.effect]] has keys and values of parameters in one table.
    const std::vector<std::string> keys =
        words(std::string(kEffectOptions) + " priors " + std::string(kFormulaKeys));
    if (std::ranges::count(keys, parameter.name) > 0)
      section.fail("name",
                   "'" + parameter.name + "' is a key of an effect; accepted: another name");
    parameter.unit =
        section.required("unit", section.text("unit"), "um, urad, um/min, s, mm, 1 ...");
    if (parameter.lower && parameter.upper && !(*parameter.lower < *parameter.upper))
      section.fail("upper", "must be greater than lower");
    out.push_back(std::move(parameter));
  }
  if (out.empty())
    effect.missing("parameters", R"([{ name = "a", unit = "um" }, ...], one of them the size)");
  return out;
}

DeclaredEffect read_formula(const Section& section, const std::vector<Channel>& /*channels*/) {
  Formula formula;
  formula.name = identifier(section, "as");
  formula.text = section.required("formula", section.text("formula"),
                                  "µm (slopes: µrad) of r x X z theta t m k s R feed rpm");
  formula.parameters = read_formula_parameters(section);
  for (const auto& [key, member] :
       {std::pair("standard_name", &Formula::standard_name), std::pair("cause", &Formula::cause),
        std::pair("source", &Formula::source), std::pair("typical", &Formula::typical),
        std::pair("confounded_with", &Formula::confounded_with),
        std::pair("separated_by", &Formula::separated_by)})
    formula.*member = section.text(key).value_or("");
  try {
    return {formula.name, {.own = formula_effect(formula)}, {}};
  } catch (const UsageError& error) {
    section.fail("formula", error.what());
  }
}

/// A number, or "free"; the number, if it is one.
std::optional<double> number_or_free(const Section& section, std::string_view key, bool& is_free) {
  is_free = section.is_text(key);
  if (!is_free) return section.not_negative(key);
  static_cast<void>(section.one_of(key, "free"));
  return std::nullopt;
}

DeclaredEffect read_channel_effect(const Section& section, const std::vector<Channel>& channels) {
  std::vector<std::string> names;
  for (const Channel& channel : channels) names.push_back(channel.name);
  const std::string channel = section.required("channel", section.one_of("channel", names),
                                               "a [[channel]]: " + joined(names, " "));
  ChannelResponse response;
  response.name = section.has("as") ? identifier(section, "as") : channel;
  const std::optional<double> lag = number_or_free(section, "lag_s", response.free_lag);
  response.tau_s = number_or_free(section, "tau_s", response.free_tau);
  response.lag_s = lag.value_or(0.0);
  if (!section.has("lag_s") && !section.has("tau_s")) response.free_lag = true;
  response.since_start = section.one_of("from", "log start").value_or("log") == "start";
  try {
    const Channel& found = *std::ranges::find(channels, channel, &Channel::name);
    return {response.name, {.own = channel_effect(found, response)}, {}};
  } catch (const UsageError& error) {
    section.fail("channel", error.what());
  }
}

constexpr OwnKind kOwnKinds[] = {
    {"formula", kFormulaKeys, true, read_formula},
    {"channel", "as channel lag_s tau_s from", false, read_channel_effect}};

}  // namespace

std::span<const OwnKind> own_kinds() { return kOwnKinds; }

const OwnKind* own_kind_of(const Section& section) {
  const auto found = std::ranges::find_if(kOwnKinds, [&](const OwnKind& kind) {
    return section.is_text("name") && section.text("name") == kind.name;
  });
  return found == std::end(kOwnKinds) ? nullptr : found;
}

namespace {

void check_name_is_free(const std::string& name, const std::vector<DeclaredEffect>& known) {
  const bool is_kind = std::ranges::count(own_kinds(), name, &OwnKind::name) > 0;
  const bool is_known = std::ranges::count(known, name, &DeclaredEffect::name) > 0;
  if (is_kind || is_known || name == "all" || std::ranges::count(effect_names(), name) > 0)
    throw UsageError("'" + name + "' is the name of another effect; accepted: one of its own");
}

}  // namespace

void look_for(DeclaredEffect effect, Problem& problem) {
  check_name_is_free(effect.name, problem.own_effects);
  problem.own_effects.push_back(effect);
  problem.trace.own.push_back(std::move(effect));
}

void check_name_is_free(const Section& section, std::string_view key, const std::string& name,
                        const std::vector<DeclaredEffect>& known) {
  try {
    check_name_is_free(name, known);
  } catch (const UsageError& error) {
    section.fail(key, error.what());
  }
}

std::vector<DeclaredEffect> read_effect_file(const std::filesystem::path& path) {
  const std::string file = path.string();
  const TomlValue tree = read_toml(path);
  const Section root(file, "", tree);
  root.accept("effect");
  std::vector<std::string> kinds;
  for (const OwnKind& kind : own_kinds())
    if (kind.in_files) kinds.emplace_back(kind.name);
  std::vector<DeclaredEffect> out;
  for (const Section& section : root.tables("effect")) {
    if (!section.one_of("name", kinds)) section.missing("name", joined(kinds, " "));
    const OwnKind& kind = *own_kind_of(section);
    section.accept("name " + std::string(kind.keys));
    for (const char* key : {"cause", "source", "typical"})
      if (!section.text(key)) section.missing(key, "a text: what others must know of the effect");
    out.push_back(kind.read(section, {}));
    check_name_is_free(section, "as", out.back().name, std::vector(out.begin(), out.end() - 1));
  }
  if (out.empty()) root.fail("effect", "missing; accepted: at least one [[effect]]");
  return out;
}

}  // namespace slideway
