#include "drawn_problem.hpp"

#include <algorithm>

#include "drawn_lines.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/identify/gates.hpp"

namespace slideway {
namespace {

bool is_made(const std::string& name, const EffectOptions& options) {
  try {
    static_cast<void>(make_effect(name, options, Machine(Machine::paper_lathe(), Lever::paper),
                                  {.beam_span_mm = 400.0}));
    return true;
  } catch (const UsageError&) {
    return false;
  }
}

void drawn_priors(Draw& draw, Lines& lines, const std::string& name, int degree) {
  EffectOptions options;
  if (degree >= 0) options.degree = degree;
  if (!is_made(name, options)) return;
  const auto effect = make_effect(name, options, Machine(Machine::paper_lathe(), Lever::paper),
                                  {.beam_span_mm = 400.0});
  const Parameter& parameter = draw.one_of(effect->parameters());
  const double size = parameter.scale * draw.between(0.01, 3.0);
  lines.put("priors", "[{ parameter = \"" + parameter.name +
                          "\", value = " + shortest(parameter.scale * draw.between(-1.0, 2.0)) +
                          ", standard_uncertainty = " + shortest(size) + " }]");
}

void drawn_effect(Draw& draw, Lines& lines, const Outline& outline, const std::string& name) {
  lines.put("name", '"' + name + '"');
  int degree = -1;
  if (!is_made(name, {}) || (draw.once_in(4) && is_made(name, {.degree = 2})))
    degree = static_cast<int>(1 + draw.below(8));
  if (degree >= 0 && name == "straightness" && draw.once_in(4)) {
    lines.put("form", "\"curve\"");
    if (lines.maybe(2)) lines.number("resolution_mm", 1.0, 100.0);
    degree = -1;
  } else if (degree >= 0) {
    lines.put("degree", std::to_string(degree));
  }
  if (lines.maybe(6))
    lines.put("profiles", "[\"p" + std::to_string(draw.below(outline.profiles)) + "\"]");
  if (lines.maybe(8)) lines.word("scope", {"profile", "all", "instrument"});
  if (lines.maybe(6)) drawn_priors(draw, lines, name, degree);
}

struct OwnFormula {
  const char *formula, *parameters;
};
constexpr std::array<OwnFormula, 6> kFormulas{
    {{"a * (1 - exp(-max(t - t0, 0) / tau))",
      "[{ name = \"a\", unit = \"um\" }, { name = \"t0\", unit = \"s\", lower = 0, upper = 300 }, "
      "{ name = \"tau\", unit = \"s\", lower = 1, upper = 600 }]"},
     {"a * x + b * r^2", "[{ name = \"a\", unit = \"um\" }, { name = \"b\", unit = \"um/mm2\" }]"},
     {"a * tanh((X - x0) / w)",
      "[{ name = \"a\", unit = \"um\" }, { name = \"x0\", unit = \"mm\", lower = -5, upper = 50 }, "
      "{ name = \"w\", unit = \"mm\", lower = 0.5, upper = 20 }]"},
     {"a * sin(2 * pi * k / n)",
      "[{ name = \"a\", unit = \"um\" }, { name = \"n\", unit = \"1\", lower = 3, upper = 30 }]"},
     {"a / r", "[{ name = \"a\", unit = \"um\" }]"},
     {"a * log(s + 1) * feed / rpm", "[{ name = \"a\", unit = \"um\" }]"}}};

void drawn_own_effect(Draw& draw, Lines& lines, std::size_t logs) {
  if (logs > 0 && draw.once_in(2)) {
    lines.put("name", "\"channel\"");
    lines.put("channel", "\"log0\"");
    if (lines.maybe(2)) lines.put("lag_s", draw.one_of(Words{"\"free\"", "0", "20"}));
    if (lines.maybe(2)) lines.put("tau_s", draw.one_of(Words{"\"free\"", "5", "200"}));
    if (lines.maybe(2)) lines.word("from", {"log", "start"});
    return;
  }
  const OwnFormula& own = draw.one_of(kFormulas);
  lines.put("name", "\"formula\"");
  lines.put("as", "\"own\"");
  lines.put("formula", '"' + std::string(own.formula) + '"');
  lines.put("parameters", own.parameters);
}

void drawn_effects(Draw& draw, Lines& lines, const Outline& outline, std::size_t logs) {
  const std::size_t count = 1 + draw.below(draw.once_in(4) ? 6 : 3);
  Words left = effect_names();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t which = draw.below(left.size());
    lines.head("[[effect]]");
    if (i + 1 == count && draw.once_in(6)) {
      drawn_own_effect(draw, lines, logs);
      continue;
    }
    drawn_effect(draw, lines, outline, left[which]);
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(which));
  }
}

void drawn_trace(Draw& draw, Lines& lines) {
  lines.head("[trace]");
  if (lines.maybe(2))
    lines.put("candidates",
              "[\"" + draw.one_of(effect_names()) + "\", \"" + draw.one_of(effect_names()) + "\"]");
  if (lines.maybe(2)) lines.put("max_effects", std::to_string(draw.below(4)));
  const std::span<const Gate> gates = gate_table();
  const std::size_t count = draw.below(3);
  Words used;
  for (std::size_t i = 0; i < count; ++i) {
    const Gate& gate = gates[draw.below(gates.size())];
    if (std::ranges::count(used, gate.name) > 0) continue;
    used.emplace_back(gate.name);
    const double high = std::min(gate.upper, 1e6);
    lines.put(std::string(gate.name),
              shortest(draw.one_of(
                  std::array{gate.lower, high, gate.lower + 0.3 * (high - gate.lower)})));
  }
}

void drawn_rest(Draw& draw, Lines& lines) {
  if (lines.maybe()) drawn_trace(draw, lines);
  if (lines.maybe()) {
    lines.head("[tolerance]");
    lines.number("flatness_um", 0.1, 20.0);
    lines.number("straightness_um", 0.1, 20.0);
    lines.number("squareness_um_per_m", 0.1, 20.0);
  }
  if (!lines.maybe()) return;
  lines.head("[runout]");
  lines.number("r_um", -5.0, 5.0);
  lines.number("p_um", -5.0, 5.0);
  lines.number("diameter_mm", 10.0, 1000.0);
  lines.number("standard_uncertainty_um", 0.01, 1.0);
}

std::string drawn_head(Draw& draw, Intent intent, Outline& outline) {
  Lines lines(draw, intent);
  outline.is_split = draw.once_in(4);
  lines.put("title", "\"drawn\"");
  lines.head("[machine]");
  lines.put("lever", outline.is_split ? "\"split\"" : "\"paper\"");
  if (outline.is_split) lines.number("overhang_mm", 0.0, 200.0);
  lines.number("span_mm", 100.0, 3000.0);
  if (lines.maybe()) lines.number("spindle_position_mm", -500.0, 500.0);
  if (lines.maybe(10))
    for (const char* body :
         {"name = \"low\"\nlower = 0\naxis = \"z\"", "name = \"high\"\nlower = 1\naxis = \"x\""})
      lines.head("[[machine.body]]\n" + std::string(body));
  lines.head("[low_band]");
  lines.put("level", std::to_string(draw.below(4)));
  return lines.take();
}

std::string table_of(const std::vector<const std::vector<double>*>& columns) {
  std::string text;
  for (std::size_t i = 0; i < columns.front()->size(); ++i)
    for (const auto* column : columns)
      text += shortest((*column)[i]) + (column == columns.back() ? "\n" : ",");
  return text;
}

std::vector<double> scaled(const std::vector<double>& values, double factor) {
  std::vector<double> out = values;
  for (double& value : out) value *= factor;
  return out;
}

}  // namespace

DrawnProblem draw_problem(Draw& draw, Intent intent) {
  DrawnProblem out;
  Outline outline;
  out.head = drawn_head(draw, intent, outline);
  outline.has_times = draw.once_in(4);
  outline.profiles = 1 + draw.below(3);
  for (std::size_t i = 0; i < outline.profiles; ++i)
    out.profiles.push_back(drawn_profile(draw, intent, outline, i));
  if (draw.once_in(6)) out.logs.push_back(drawn_log(draw, intent));
  Lines lines(draw, intent);
  drawn_effects(draw, lines, outline, out.logs.size());
  drawn_rest(draw, lines);
  out.tail = lines.take();
  return out;
}

std::string ProblemFiles::keep(const std::string& bytes) {
  files_.push_back(std::make_unique<MemoryFile>(bytes));
  return "file = \"" + files_.back()->path().string() + "\"\n";
}

ProblemFiles::ProblemFiles(const DrawnProblem& problem, const Wording& wording) {
  std::vector<std::string> profiles;
  for (const DrawnProfile& each : problem.profiles) {
    const double per_value =
        wording.size * (each.is_slope ? wording.slopes_per_urad : wording.heights_per_um);
    const auto positions = scaled(each.positions_mm, wording.positions_per_mm);
    const auto values = scaled(each.values, per_value);
    std::vector<const std::vector<double>*> columns{&positions, &values};
    std::string text = "[[profile]]\nname = \"" + each.name + "\"\nposition_unit = \"" +
                       wording.position_unit + "\"\nvalue_unit = \"" +
                       (each.is_slope ? wording.slope_unit : wording.height_unit) + "\"\n";
    if (!each.times_s.empty()) {
      columns.push_back(&each.times_s);
      text += "time_column = \"3\"\ntime_unit = \"s\"\n";
    }
    if (each.standard_uncertainty > 0.0)
      text += "standard_uncertainty = " + shortest(each.standard_uncertainty * per_value) + "\n";
    profiles.push_back(text + keep(table_of(columns)) + each.keys);
  }
  if (wording.is_reversed) std::ranges::reverse(profiles);
  text_ = problem.head;
  for (const std::string& profile : profiles) text_ += profile;
  for (const DrawnLog& log : problem.logs)
    text_ += "[[channel]]\nname = \"" + log.name + "\"\n" + keep(table_of({&log.at, &log.values})) +
             log.keys;
  text_ += problem.tail;
  static_cast<void>(keep(text_));
}

}  // namespace slideway
