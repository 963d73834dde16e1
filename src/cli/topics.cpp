#include "topics.hpp"

#include "slideway/base/text.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/identify/gates.hpp"
#include "slideway/report/layout.hpp"

namespace slideway {
namespace {

struct Key {
  const char *name, *text;
};
struct Section {
  const char *name, *text;
  std::vector<Key> keys;
};

// The keys of the problem file; a test compares them with those the reader accepts.
/// Names and sentences of gates are literals: they end with a zero.
Section trace_section() {
  Section out{"[trace]",
              "The closed loop. slideway help trace: the gates with their ranges and reasons.",
              {{"candidates", "[\"all\"], or names of effects"},
               {"candidate", "[[trace.candidate]], as [[effect]]: looked for, not declared"},
               {"max_effects", "how many may enter, each counted once; default 3"},
               {"time_limit_s",
                "seconds after which the loop ends with what it has; default: none. What is not "
                "held against its rivals by then is not named"}}};
  for (const Gate& gate : gate_table()) out.keys.push_back({gate.name.data(), gate.decides.data()});
  return out;
}

const std::vector<Section>& sections() {
  static const std::vector<Section> kSections{
      {"",
       "A problem file (TOML) says where the profiles are, how each was cut and measured, and "
       "which effects to look for. An unknown key, a missing unit or a wrong type is refused with "
       "file, line, key and what is accepted. Paths are relative to the problem file; "
       "${SLIDEWAY_DATA} in a path is --data DIR or the environment variable.",
       {{"title", "a line for the report"},
        {"effects",
         "[\"our-lathes.toml\"]: files of [[effect]] tables, each a formula with cause, source and "
         "typical size, that problems share. Their effects are looked for, and can be declared by "
         "name"}}},
      {"[about]",
       "Who measured what with which instrument: free text for the head of the report.",
       {{"machine", "text"},
        {"serial", "text"},
        {"manufacturer", "text: of the machine"},
        {"operator", "text: who measured"},
        {"responsible", "text: who answers for the result"},
        {"instrument", "text"},
        {"instrument_serial", "text"},
        {"calibrated", "text: when, until when, by whom"},
        {"workpiece", "text"},
        {"place", "text: where it was measured; \"laboratory\" or \"customer\" for a DCC"},
        {"country", "text: its two letters, \"DE\""},
        {"conditions", "text: temperature, warm-up, what the control compensates"},
        {"customer", "text: name, address"},
        {"laboratory", "text: name, address"},
        {"certificate", "text: its number, one of its kind"},
        {"date", "text: of the measurement; as 2026-11-23 for a DCC"},
        {"remark", "text"}}},
      {"[tolerance]",
       "Limits of the workpiece and the slide, for conformity by ISO 14253-1: |value| + U within "
       "the limit conforms, |value| - U beyond it does not, between the two it cannot be decided.",
       {{"flatness_um", "of the face: peak to valley of its low band about the mean line"},
        {"straightness_um", "of the slide, E_ZX about the minimum zone lines"},
        {"squareness_um_per_m", "of the slide to the spindle, its amount"}}},
      {"[machine]",
       "The lathe.",
       {{"lever",
         "needed as soon as a face is fitted. \"paper\": one p_x = r for every term, Eq. (16); "
         "\"split\": pitch terms act on the constant overhang_mm, squareness on r"},
        {"overhang_mm", "lever \"split\": from the carriage's reference point to the tool tip"},
        {"spindle_position_mm",
         "slide coordinate x at which the tool meets the spindle axis: x = spindle_position_mm + "
         "r; default 0"},
        {"span_mm", "between the supports of the cross-beam; needed for its sag"},
        {"body", "[[machine.body]], below; default is the paper's lathe"}}},
      {"[[machine.body]]",
       "The lower-body array of Eq. (1), one table per body from the bed to the tool.",
       {{"name", "a name of its own"},
        {"lower", "number of the body it rides on; 0 is the bed"},
        {"axis", "x, y or z"}}},
      {"[low_band]",
       "What of each profile is fitted; a profile may have keys of its own.",
       {{"wavelet", "db1 to db19; default db1"},
        {"level", "levels of the decomposition; 0: the raw profile"},
        {"boundary", "how a profile goes on beyond its ends; default symmetric"}}},
      {"[[profile]]",
       "One measured trace.",
       {{"name", "a name of its own"},
        {"file", "CSV or other delimited text, X3P, SDF, SMD, PRF, NIST XML; the content decides"},
        {"kind", R"("face": a face-turned surface; "slide": a reading along the slide itself)"},
        {"quantity", R"("height" or "slope")"},
        {"position_column", "text: header name or number"},
        {"value_column", "text: header name or number"},
        {"position_unit", "m mm um nm inch, or s with feed_mm_per_min; not where the file says it"},
        {"value_unit", "m mm um nm inch; slope: rad mrad urad arcsec um_per_m mm_per_m"},
        {"time_column",
         "text: header name or number; when each station was read, or a clock time (08:29:40)"},
        {"time_unit", "s min h; with time_column"},
        {"delimiter", "text, if not detected: , ; tab blank"},
        {"decimal", "text, if not detected: . or ,"},
        {"encoding", "text, if not detected: utf-8 utf-16 latin-1"},
        {"header_lines", "text, if not detected: lines before the first numbers"},
        {"line", R"(areal file: "row:12", "column:3", "diameter:30")"},
        {"base_mm",
         "slope: foot spacing of the mirror or level, whose middle is the position; none: the "
         "local slope"},
        {"window", "[from, to] in position_unit: keep only this part"},
        {"mask", "[[from, to], ...] in position_unit: parts that are left out"},
        {"leave_out", "\"spikes\", or data rows, the first one 1: [120, 121]"},
        {"from_mm",
         "where the line lies on the surface: [x, y] of its smallest position; slope with base_mm: "
         "of the foot there. With to_mm, for the closure between lines"},
        {"to_mm", "[x, y] of its largest position"},
        {"center_mm", "face: where the spindle axis lies in the trace; r = |s - center_mm|"},
        {"z_mm", "Z coordinate of this face"},
        {"overhang_mm", "instead of that of [machine]: another tool, another holder"},
        {"feed_mm_per_min", "feed of the cut"},
        {"spindle_rpm", "turns per minute of the cut"},
        {"cut_direction",
         "\"inward\": t = (cut_radius_mm - r) / feed; \"outward\": t = r / feed; slide: t grows "
         "with s (\"outward\") or against it"},
        {"cut_radius_mm", "where the cut began; default the largest r of the trace"},
        {"start_s", "time at which this cut began; default 0, one state for every cut"},
        {"traverse_mm_per_s", "speed of the stylus"},
        {"nose_radius_mm", "face: of the tool that cut it"},
        {"azimuth_deg",
         "face: direction of the trace on the workpiece, from any mark; default 0. On a diameter "
         "the half with positions below center_mm lies half a turn further"},
        {"surface", "which surface was traced: traces of one share its form; default its own"},
        {"instrument",
         "what measured: traces of one share its errors; default one for each kind and quantity"},
        {"level", "this profile's low band: levels; default that of [low_band]"},
        {"wavelet", "this profile's low band; default that of [low_band]"},
        {"boundary", "this profile's low band; default that of [low_band]"},
        {"free", R"(what levelling left undetermined: ["offset", "tilt"])"},
        {"loss",
         "what a large residual costs: \"none\", its square; \"huber\", \"cauchy\", less, for a "
         "trace with dirt"},
        {"standard_uncertainty", "the instrument's, in value_unit; none: estimated"},
        {"reversed",
         "slide: true: read with the instrument, or the straightedge, turned over by 180°: the "
         "form "
         "of the slide keeps its sign, what is the instrument's changes it"},
        {"role", R"("fit", or "holdout": never fitted, only predicted)"}}},
      {"[[effect]]",
       "One effect of the declared model: slideway effects lists them all.",
       {{"name",
         "of the catalogue, of a file of `effects`, of a channel, or \"formula\" or \"channel\", "
         "below"},
        {"body", "a carriage's name, where more than one moves along the axis"},
        {"degree", "of a polynomial"},
        {"form", "of a straightness: \"polynomial\", or \"curve\": smooth, kinks allowed"},
        {"resolution_mm", "of a curve: between its knots; at least 1/117 of the travel"},
        {"harmonics", "of the grooves of one cut: [1, 2, 5], each with a cosine and a sine"},
        {"each_half", "with harmonics: true: the two halves of a diameter have their own"},
        {"span_mm", "instead of that of [machine]"},
        {"profiles",
         "[\"feed2\"]: only in these profiles, and its parameters then carry their names: "
         "step[feed2].height_um"},
        {"scope",
         "\"profile\": once for each profile that sees it, with all parameters of its own, "
         "step[feed2].height_um, step[feed8].height_um; \"instrument\": once for each instrument, "
         "default of what is an error of the instrument; \"all\": once, default of all else"},
        {"priors", "what is known of its parameters, below"}}},
      {"[[effect]] name = \"formula\"",
       "An effect of your own; keys of any effect besides. Under [[trace.candidate]] it is looked "
       "for, under [[truth.effect]] simulated.",
       {{"as", "its name in the report"},
        {"formula",
         "um of a height, urad of a slope, of r x X z R (mm), theta (rad), t m t_read (s), k "
         "(turns), s "
         "(m), feed (mm/min), rpm, pi and its parameters"},
        {"parameters",
         "[{ name = \"a\", unit = \"um\" }, { name = \"tau\", unit = \"s\", lower = 1, upper = 600 "
         "}]: what enters linearly is a size in um or urad, all else needs lower and upper"},
        {"standard_name", "text: the term of a standard"},
        {"cause", "text: what makes it"},
        {"source", "text: who says so"},
        {"typical", "text: its ordinary size"},
        {"confounded_with", "text: what looks like it"},
        {"separated_by", "text: what tells the two apart"}}},
      {"priors = [{ ... }]",
       "A normal prior on one parameter of an [[effect]].",
       {{"parameter", "its name in the effect: \"b2\""},
        {"value", "in the parameter's unit"},
        {"standard_uncertainty", "above 0, in the same unit"}}},
      {"[runout]",
       "The run-out measurement of Eq. (21), never fitted: the squareness is held against it.",
       {{"r_um", "r of Eq. (21)"},
        {"p_um", "p of Eq. (21)"},
        {"diameter_mm", "L of Eq. (21)"},
        {"standard_uncertainty_um", "of r + p"}}},
      {"[[channel]]",
       "A log beside the profiles: a temperature, a power, a pressure. The loop asks of each "
       "whether "
       "it, or what follows it slowly, explains what is left; as an effect it has the channel's "
       "name.",
       {{"name", "a name of its own"},
        {"file", "as of a profile"},
        {"time_column",
         "header name or number; default 1; clock times (08:29:40, 2026-03-12T08:29:40, "
         "12.03.2026 08:29) are s from the midnight before the first"},
        {"time_unit", "s min h; m mm um nm inch where the clock is x; none: as the file states"},
        {"value_column", "header name or number; default 2"},
        {"value_unit", "text: for the report"},
        {"clock",
         "\"t\" cutting time, start_s included; \"m\" measuring time; \"t_read\" reading time, of "
         "time_column; \"x\" slide coordinate; "
         "default t"}}},
      {"[[effect]] name = \"channel\"",
       "h = a q: a logged quantity as cause; keys of any effect besides.",
       {{"channel", "name of a [[channel]]"},
        {"as", "its name in the report; default the channel's"},
        {"lag_s",
         "the height follows so much later, or \"free\"; default free without tau_s, else 0"},
        {"tau_s", "first-order lag: tau dy/dt = q - y, or \"free\"; default none"},
        {"from", "\"log\": q as it is; \"start\": its change since the cut began; default log"}}},
      trace_section(),
      {"[[plan.cut]]",
       "A cut or trace that can be made next, for `slideway plan`; keys of a [[profile]] besides, "
       "but for those that say how a file is read. A key left out is as in the profile it is "
       "like. Without any, what the workshop can make of the first face is tried.",
       {{"like", "name of a [[profile]]; default the first of its kind and quantity"},
        {"samples", "in its window; default as close as those of that profile"},
        {"cost", "a number in any unit, for the table"},
        {"time_min", "minutes it takes, for the table"}}},
      {"[truth]",
       "What `simulate` makes the profiles from.",
       {{"seed", "of the noise; default 1"},
        {"noise_um", "standard deviation of a sample; slope: urad"},
        {"noise_correlation_mm", "0: white, else exp(-|distance| / it)"},
        {"samples", "of a profile whose file is not there yet; default 20000"},
        {"parameters", "of the declared effects: { \"squareness.dbeta_xz\" = 2.8e-6 }"},
        {"effect",
         "[[truth.effect]]: effects that the model does not declare, by name and "
         "parameters"}}}};
  return kSections;
}

std::string problem_file_text() {
  std::string text;
  for (const Section& section : sections()) {
    if (!text.empty()) text += std::string("\n") + section.name + "\n";
    text += paragraph(text.empty() ? "" : "  ", section.text);
    for (const Key& key : section.keys) {
      const std::string name = std::string("    ") + key.name;
      text +=
          paragraph(name + std::string(27 - std::min<std::size_t>(26, name.size()), ' '), key.text);
    }
  }
  return text;
}

struct VariableText {
  IndependentVariable variable;
  const char* text;
};
constexpr VariableText kVariables[] = {
    {IndependentVariable::radius, "radius on the face: |position - center_mm|"},
    {IndependentVariable::slide, "slide coordinate: spindle_position_mm + r"},
    {IndependentVariable::time, "machining time: needs feed_mm_per_min, cut_direction"},
    {IndependentVariable::revolution, "turns of the spindle: needs spindle_rpm besides"},
    {IndependentVariable::distance, "cutting distance along the spiral: needs spindle_rpm besides"},
    {IndependentVariable::trace, "position in the trace from the spindle axis, with its sign"},
    {IndependentVariable::measuring_time, "time on the instrument: needs traverse_mm_per_s"},
    {IndependentVariable::reading_time, "when a station was read: needs time_column"}};

std::string effects_text() {
  std::string text = paragraph(
      "",
      "Every error is an effect: a function of one independent variable. What moves with the slide "
      "is the carriage's; what moves with time, turns or cutting distance only looks like it. Two "
      "cuts in which a variable runs differently (another feed, direction or Z) tell the two "
      "apart. An effect whose variable needs metadata the problem file lacks is listed as not "
      "testable, never guessed. slideway effects NAME has one in full.");
  for (const VariableText& entry : kVariables) {
    text += '\n';
    text += paragraph(std::string(symbol(entry.variable)) + "  ", entry.text);
    for (const std::string& name : effect_names()) {
      const Effect& effect = specimen(name);
      if (effect.description().variable != entry.variable) continue;
      text +=
          paragraph("   " + name + std::string(23 - std::min<std::size_t>(22, name.size()), ' '),
                    effect.description().formula);
    }
  }
  return text;
}

std::string gates_text() {
  std::string text = paragraph(
      "",
      "Every number that decides what the closed loop says is a gate: a key of [trace] with a "
      "default, a range and a reason. The report lists the values used, and which smallest change "
      "of one gate within its range would have changed the verdict.");
  const Gates defaults;
  for (const Gate& gate : gate_table()) {
    text += "\n" + std::string(gate.name) + " = " + shortest(defaults.*gate.value) +
            (gate.unit.empty() ? "" : " " + std::string(gate.unit)) + ", from " +
            shortest(gate.lower) + " to " + shortest(gate.upper) + "\n";
    text += paragraph("    ", std::string(gate.decides));
    text += paragraph("    ", "Source: " + std::string(gate.source) + ".");
  }
  return text;
}

}  // namespace

const std::vector<std::string>& topics() {
  static const std::vector<std::string> kTopics{"effects", "problem-file", "trace"};
  return kTopics;
}

std::string topic_text(const std::string& topic) {
  if (topic == "effects") return effects_text();
  return topic == "trace" ? gates_text() : problem_file_text();
}

}  // namespace slideway
