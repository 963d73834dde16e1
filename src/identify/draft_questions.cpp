#include "draft_questions.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "problem_section.hpp"
#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"

namespace slideway {
namespace {

constexpr const char* kLeverPicture =
    "    split: the carriage carries the tool on an arm of constant length.\n"
    "    A pitch of the carriage lifts the tool by pitch times overhang.\n"
    "\n"
    "      face |          arm\n"
    "    -------+ <-- tool ======[ carriage ]\n"
    "           |         |<- overhang ->|\n"
    "                            ~~~~~~~~~~~~~~~ slide\n"
    "\n"
    "    paper: the arm reaches from the spindle axis to the tool, as in Eq. (16)\n"
    "    of the paper: a pitch acts on the radius the tool is at.\n";

bool is_word(const std::string& text, std::string_view accepted) {
  const std::vector<std::string> known = words(accepted);
  return std::ranges::count(known, text) > 0;
}

std::optional<std::string> one_of(const std::string& text, std::string_view accepted) {
  return is_word(text, accepted) ? std::optional(text) : std::nullopt;
}

/// A number with a decimal point or comma, as a problem writes it.
std::optional<std::string> number(std::string text, bool must_be_positive) {
  std::ranges::replace(text, ',', '.');
  const std::optional<double> value = parse_double(text);
  if (!value || !std::isfinite(*value) || (must_be_positive && !(*value > 0.0)))
    return std::nullopt;
  return shortest(*value);
}

std::optional<std::string> positive_or(const std::string& text, const char* word) {
  return text == word ? std::optional(text) : number(text, true);
}

bool is_face(const DraftState& state) { return state.said("kind") == "face"; }
bool is_slope(const DraftState& state) { return slope_unit(state.said("value-unit")).has_value(); }
bool always(const DraftState& /*state*/) { return true; }
void no_guess(const DraftState& /*state*/, DraftQuestion& /*out*/) {}

void be(DraftQuestion& out, std::string guess, std::string why, bool certain = false) {
  out.guess = std::move(guess);
  out.why = std::move(why);
  out.certain = certain;
}

// --- columns and units --------------------------------------------------------------------------

bool is_text(const DraftState& state) { return !state.file.columns.empty(); }

std::string lower_case(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

/// Columns whose unit is one of these, or whose name begins with one of these words.
std::vector<std::string> columns_like(const DraftFile& file, std::string_view units,
                                      std::string_view beginnings) {
  std::vector<std::string> out;
  const std::vector<std::string> known = words(beginnings);
  for (std::size_t i = 0; i < file.columns.size(); ++i) {
    const std::string name = lower_case(file.columns[i]);
    const bool named = std::ranges::any_of(known, [&](const std::string& word) {
      return name.starts_with(word) && (word.size() > 1 || name.size() == 1 || name[1] == '_' ||
                                        name[1] == ' ' || name[1] == '[');
    });
    if (named || is_word(file.units[i], units)) out.push_back(file.columns[i]);
  }
  return out;
}

/// The one column that is like this, or that of this number of two; else a guess to confirm.
void guess_column(const DraftFile& file, const std::vector<std::string>& like, std::size_t fallback,
                  DraftQuestion& out) {
  if (file.columns.size() == 2)
    be(out, file.columns[fallback], "the file has two columns", true);
  else if (like.size() == 1)
    be(out, like[0], "its name and unit", true);
  else if (!like.empty())
    be(out, like[0], "the first that may be it");
  else if (file.columns.size() > fallback)
    be(out, file.columns[fallback], "column " + std::to_string(fallback + 1));
}

void guess_position_column(const DraftState& state, DraftQuestion& out) {
  constexpr const char* kNames = "x pos weg abstand station lateral distance s";
  const std::vector<std::string> lengths = columns_like(state.file, "m mm inch", "");
  std::vector<std::string> like = columns_like(state.file, "", kNames);
  std::erase_if(like, [&](const auto& name) { return std::ranges::count(lengths, name) == 0; });
  if (like.empty()) like = columns_like(state.file, "m mm inch s", kNames);
  guess_column(state.file, like, 0, out);
}

void guess_value_column(const DraftState& state, DraftQuestion& out) {
  std::vector<std::string> like =
      columns_like(state.file, std::string("um nm ") + std::string(kSlopeUnits),
                   "z h\xc3\xb6he hoehe height profil wert value slope neigung winkel angle "
                   "deviation abweichung");
  std::erase(like, state.said("position-column"));
  guess_column(state.file, like, 1, out);
}

std::optional<std::string> read_column(const DraftState& state, const std::string& text) {
  if (std::ranges::count(state.file.columns, text) > 0) return text;
  const std::optional<double> place = parse_double(text);
  const bool fits = place && *place >= 1.0 && *place == std::floor(*place) &&
                    *place <= static_cast<double>(state.file.columns.size());
  return fits ? std::optional(state.file.columns[static_cast<std::size_t>(*place) - 1])
              : std::nullopt;
}

/// The unit the file states of a column, or of its positions or values.
std::string stated(const DraftState& state, const char* column, std::size_t place) {
  if (!is_text(state)) return state.file.units[place];
  const auto at = std::ranges::find(state.file.columns, state.said(column));
  return at == state.file.columns.end()
             ? ""
             : state.file.units[static_cast<std::size_t>(at - state.file.columns.begin())];
}

void guess_position_unit(const DraftState& state, DraftQuestion& out) {
  if (const std::string unit = stated(state, "position-column", 0); !unit.empty())
    be(out, unit, "the file says so", true);
}

void guess_value_unit(const DraftState& state, DraftQuestion& out) {
  if (const std::string unit = stated(state, "value-column", 1); !unit.empty())
    be(out, unit, "the file says so", true);
}

std::optional<std::string> read_unit(const DraftState& /*state*/, const std::string& text) {
  return one_of(std::string(unit_spelled(text)),
                std::string(kLengthUnits) + " s " + std::string(kSlopeUnits));
}

// --- what was measured --------------------------------------------------------------------------

void guess_kind(const DraftState& state, DraftQuestion& out) {
  constexpr std::size_t kManyReadings = 300;
  const std::size_t readings = state.file.trace->positions.size();
  if (is_slope(state))
    be(out, "slide", "an angle is read with a level or an autocollimator, along a slide", true);
  else if (readings >= kManyReadings)
    be(out, "face", std::to_string(readings) + " readings, as a profilometer takes them");
  else
    be(out, "slide", std::to_string(readings) + " readings, as stations along a slide");
}

/// Ends of the trace in mm, or as they are where the unit is a time.
std::pair<double, double> ends(const DraftState& state) {
  const auto [least, most] = std::ranges::minmax(state.file.trace->positions);
  const UnitScale scale = length_unit(state.said("position-unit")).value_or(UnitScale{});
  return {scale(least), scale(most)};
}

/// Of the larger end, how far zero may be from where it should be.
constexpr double kNearZero = 0.1;

/// Means of the values over equal cells of the trace, without their line; empty where a cell is.
std::vector<double> form_of(const Trace& trace) {
  constexpr std::size_t kCells = 60;
  const auto [least, most] = std::ranges::minmax(trace.positions);
  std::vector<double> sum(kCells), count(kCells);
  for (std::size_t i = 0; i < trace.positions.size(); ++i) {
    if (std::isnan(trace.values[i])) continue;
    const double place = (trace.positions[i] - least) / (most - least) * kCells;
    const std::size_t cell = std::min(static_cast<std::size_t>(place), kCells - 1);
    sum[cell] += trace.values[i];
    ++count[cell];
  }
  if (std::ranges::count(count, 0.0) > 0) return {};
  double mean = 0.0, moment = 0.0, squares = 0.0;
  const auto place = [](std::size_t i) { return static_cast<double>(i) - 0.5 * (kCells - 1); };
  for (std::size_t i = 0; i < kCells; ++i) {
    sum[i] /= count[i];
    mean += sum[i] / kCells;
    moment += place(i) * sum[i];
    squares += place(i) * place(i);
  }
  for (std::size_t i = 0; i < kCells; ++i) sum[i] -= mean + moment / squares * place(i);
  return sum;
}

/// Share of the square of a trace's form that is the same on both sides of its middle.
double even_share(const Trace& trace) {
  const std::vector<double> form = form_of(trace);
  double even = 0.0, odd = 0.0;
  for (std::size_t i = 0; i < form.size(); ++i) {
    const double there = form[form.size() - 1 - i];
    even += (form[i] + there) * (form[i] + there);
    odd += (form[i] - there) * (form[i] - there);
  }
  return even > 0.0 ? even / (even + odd) : 0.0;
}

void guess_trace(const DraftState& state, DraftQuestion& out) {
  constexpr double kEven = 0.9;
  const auto [least, most] = ends(state);
  const double reach = std::max(std::abs(least), std::abs(most));
  if (std::abs(least + most) < kNearZero * reach)
    be(out, "diameter", "the positions run to both sides of 0");
  else if (even_share(*state.file.trace) > kEven)
    be(out, "diameter", "the trace is the same on both sides of its middle");
  else if (std::min(std::abs(least), std::abs(most)) < kNearZero * reach)
    be(out, "radius", "the positions begin near 0");
}

std::optional<std::string> read_trace_kind(const DraftState& /*state*/, const std::string& text) {
  if (text == "yes") return "diameter";
  if (text == "no") return "radius";
  return one_of(text, "diameter radius");
}

void guess_center(const DraftState& state, DraftQuestion& out) {
  const auto [least, most] = ends(state);
  const double reach = std::max(std::abs(least), std::abs(most));
  const double middle = 0.5 * (least + most);
  if (state.said("trace") == "diameter" && std::abs(middle) > kNearZero * reach)
    be(out, significant(middle, 6), "the middle of the trace");
  else
    be(out, "0", "where the positions have their zero");
}

bool has_feed(const DraftState& state) { return is_face(state) && state.said("feed") != "unknown"; }

void guess_free(const DraftState& state, DraftQuestion& out) {
  if (is_slope(state))
    be(out, "offset", "the zero of an angle is arbitrary");
  else
    be(out, "offset,tilt", "most instruments level a trace");
}

std::optional<std::string> read_free(const DraftState& /*state*/, const std::string& text) {
  if (text == "yes" || text == "offset,tilt") return R"(["offset", "tilt"])";
  if (text == "no" || text == "offset") return R"(["offset"])";
  return text == "none" ? std::optional<std::string>("[]") : std::nullopt;
}

constexpr const char* kUnits =
    "m mm um nm inch; positions in time: s; angles: rad mrad urad arcsec um_per_m mm_per_m";

constexpr std::array kRules{
    QuestionRule{"position-column", true, "Which column says where it was read?",
                 "a column's name or number", "", "1", is_text, guess_position_column, read_column},
    QuestionRule{"value-column", true, "Which column says what was read?",
                 "a column's name or number", "", "2", is_text, guess_value_column, read_column},
    QuestionRule{"position-unit", true, "What are the positions in?", kUnits, "", "mm", always,
                 guess_position_unit, read_unit},
    QuestionRule{"value-unit", true, "What are the values in?", kUnits, "", "um", always,
                 guess_value_unit, read_unit},
    QuestionRule{
        "kind", true, "Is it a turned face (face), or a reading along the slide itself (slide)?",
        "face slide", "", "slide", always, guess_kind,
        [](const DraftState&, const std::string& text) { return one_of(text, "face slide"); }},
    QuestionRule{"trace", true, "Did the trace cross the centre of the face?",
                 "yes (diameter) or no (radius)", "", "radius", is_face, guess_trace,
                 read_trace_kind},
    QuestionRule{"center", true, "At which position, in mm, does the spindle axis lie?", "mm", "",
                 "0", is_face, guess_center,
                 [](const DraftState&, const std::string& text) { return number(text, false); }},
    QuestionRule{"feed", true, "How fast did the tool cross the face when it was cut?",
                 "mm/min, or unknown", "", "1", is_face, no_guess,
                 [](const DraftState& state, const std::string& text) {
                   const bool is_needed = state.said("position-unit") == "s";
                   return is_needed ? number(text, true) : positive_or(text, "unknown");
                 }},
    QuestionRule{
        "speed", true, "How fast did the spindle turn?", "turns per minute, or unknown", "",
        "unknown", is_face, no_guess,
        [](const DraftState&, const std::string& text) { return positive_or(text, "unknown"); }},
    QuestionRule{"direction", true,
                 "Did the tool cut from the rim to the centre (inward), or outward?",
                 "inward, outward or unknown", "", "unknown", has_feed, no_guess,
                 [](const DraftState&, const std::string& text) {
                   return one_of(text, "inward outward unknown");
                 }},
    QuestionRule{
        "base", true,
        "How far apart are the feet of the level or the mirror? A position is their middle.",
        "mm, or unknown for a slope at a point", "", "unknown", is_slope, no_guess,
        [](const DraftState&, const std::string& text) { return positive_or(text, "unknown"); }},
    QuestionRule{"free", true, "Was the trace levelled, so that its height and tilt mean nothing?",
                 "yes (offset,tilt), no (offset: its height alone means nothing) or none", "",
                 "offset", always, guess_free, read_free},
    QuestionRule{
        "lever", false, "How does a pitch of the carriage reach the tool?", "split paper",
        kLeverPicture, "paper", [](const DraftState& state) { return state.has_face; }, no_guess,
        [](const DraftState&, const std::string& text) { return one_of(text, "split paper"); }},
    QuestionRule{"overhang", false, "How far is the tool tip from the carriage?", "mm", "", "0",
                 [](const DraftState& state) { return state.said("lever") == "split"; }, no_guess,
                 [](const DraftState&, const std::string& text) { return number(text, false); }}};

}  // namespace

std::span<const QuestionRule> question_rules() { return kRules; }

}  // namespace slideway
