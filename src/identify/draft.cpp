#include "slideway/identify/draft.hpp"
#include "slideway/effects/catalogue.hpp"

#include <algorithm>
#include <cmath>

#include "draft_questions.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/file.hpp"
#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"
#include "slideway/format/table.hpp"

namespace slideway {
namespace {

/// The head of a text, whose first columns may hold words: the first pair of columns with numbers.
TableHead head_of(std::string_view bytes) {
  constexpr std::size_t kMostPairs = 8;
  for (std::size_t i = 1;; ++i) try {
      return parse_head(bytes, {.columns = {std::to_string(i), std::to_string(i + 1)}});
    } catch (const DataError&) {
      if (i == kMostPairs) throw;
    }
}

/// A name for the profile of a file: its stem, unlike those before it.
std::string profile_name(const std::filesystem::path& path, const std::vector<DraftFile>& before) {
  const std::string stem = printable(path.stem().string(), path.string().size());
  std::string name = stem;
  for (int i = 2; std::ranges::count(before, name, &DraftFile::name) > 0; ++i)
    name = stem + "-" + std::to_string(i);
  return name;
}

DraftFile read_file(const std::filesystem::path& path, const std::vector<DraftFile>& before) {
  const FileBytes bytes = FileBytes::of_regular_file(path);
  const Format& format = recognised_format(bytes.text());
  DraftFile out{path, profile_name(path, before), std::string(format.name()), "", {}, {}, {}};
  if (format.states_units()) {
    out.trace = read_trace(path, {}).trace;
    out.units = {out.trace->position_unit, out.trace->value_unit};
    return out;
  }
  try {
    TableHead head = head_of(bytes.text());
    out.columns = std::move(head.names);
    out.units = std::move(head.units);
    out.decision = std::move(head.decision);
  } catch (const DataError& error) {
    throw DataError(path.string() + ": " + error.what());
  }
  return out;
}

}  // namespace

Draft::Draft(const std::vector<std::filesystem::path>& files) : answers_(files.size()) {
  for (const std::filesystem::path& path : files) files_.push_back(read_file(path, files_));
}

const std::vector<std::string>& Draft::keys() {
  static const std::vector<std::string> kKeys = [] {
    std::vector<std::string> keys;
    for (const QuestionRule& rule : question_rules()) keys.emplace_back(rule.key);
    return keys;
  }();
  return kKeys;
}

bool Draft::is_of_file(const std::string& key) {
  return std::ranges::find(question_rules(), key, &QuestionRule::key)->of_file;
}

std::optional<std::string> Draft::said(const std::string& key, std::size_t file) const {
  const auto at = answers_[file].find(key);
  return at == answers_[file].end() ? std::nullopt : std::optional(at->second);
}

bool Draft::has_face() const {
  return std::ranges::any_of(answers_, [](const auto& answers) {
    const auto kind = answers.find("kind");
    return kind != answers.end() && kind->second == "face";
  });
}

std::optional<DraftQuestion> Draft::question(const std::string& key, std::size_t file) {
  const QuestionRule& rule = *std::ranges::find(question_rules(), key, &QuestionRule::key);
  const DraftState state{files_[file], answers_[file], has_face()};
  if (said(key, file) || !rule.applies(state)) return std::nullopt;
  DraftQuestion out{key,           file, rule.words, rule.accepted, rule.picture,
                    rule.fallback, "",   "",         false};
  rule.guess(state, out);
  return out;
}

std::optional<DraftQuestion> Draft::next() {
  for (const bool of_file : {true, false})
    for (std::size_t i = 0; i < (of_file ? files_.size() : 1); ++i)
      for (const QuestionRule& rule : question_rules()) {
        if (rule.of_file != of_file) continue;
        if (auto open = question(rule.key, i)) return open;
      }
  return std::nullopt;
}

void Draft::answer(const DraftQuestion& question, const std::string& text) {
  const QuestionRule& rule = *std::ranges::find(question_rules(), question.key, &QuestionRule::key);
  const DraftState state{files_[question.file], answers_[question.file], has_face()};
  const std::optional<std::string> value = rule.read(state, std::string(trimmed(text)));
  if (!value)
    throw UsageError("'" + printable(text) + "' is no answer; accepted: " + question.accepted);
  answers_[question.file][question.key] = *value;
  if (question.key == "value-column") read_trace_of(question.file);
}

void Draft::read_trace_of(std::size_t file) {
  const TraceRequest request{.position_column = *said("position-column", file),
                             .value_column = *said("value-column", file)};
  files_[file].trace = read_trace(files_[file].path, request).trace;
}

// --- the problem file ---------------------------------------------------------------------------

namespace {

/// Name of the effect that is an error of the carriages.
const std::string& name_of(MotionError error) {
  return *std::ranges::find_if(effect_names(), [&](const std::string& name) {
    return specimen(name).description().motion == error;
  });
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += (c == '"' || c == '\\' ? "\\" : "") + std::string(1, c);
  return out + "\"";
}

/// A column as a problem names it: by number where the header has no name for it alone.
std::string column(const DraftFile& file, const std::string& name) {
  const bool is_number = std::ranges::all_of(name, [](char c) { return c >= '0' && c <= '9'; });
  return is_number && std::ranges::count(file.columns, name) == 0 ? name : quoted(name);
}

std::string line(const std::string& key, const std::string& value, const std::string& remark = "") {
  return key + " = " + value + (remark.empty() ? "" : "  # " + remark) + "\n";
}

double length_mm(const Trace& trace, const std::string& unit) {
  const auto [least, most] = std::ranges::minmax(trace.positions);
  return length_unit(unit).value_or(UnitScale{})(most - least);
}

}  // namespace

/// Low-band values of two grooves at least, 500 at most, and not below 50.
int Draft::level_of(std::size_t file) const {
  constexpr std::size_t kMostValues = 500, kLeastValues = 50;
  const Trace& trace = *files_[file].trace;
  const std::size_t samples = trace.positions.size();
  const auto number = [&](const char* key) { return parse_double(said(key, file).value_or("")); };
  const std::optional<double> feed = number("feed"), speed = number("speed");
  const std::string unit = said("position-unit", file).value_or("mm");
  const double step =
      length_mm(trace, unit) / static_cast<double>(std::max<std::size_t>(samples, 2) - 1);
  int level = 0;
  while ((samples >> level) > kMostValues) ++level;
  if (feed && speed && step > 0.0)
    while (static_cast<double>(1 << level) * step < 2.0 * *feed / *speed && level < 20) ++level;
  while (level > 0 && (samples >> level) < kLeastValues) --level;
  return level;
}

std::string Draft::profile_text(std::size_t i, int common_level,
                                const std::filesystem::path& folder) const {
  const DraftFile& file = files_[i];
  const bool face = said("kind", i) == "face", is_text = !file.columns.empty();
  std::string out = "\n[[profile]]\n" + line("name", quoted(file.name)) +
                    line("file", quoted(std::filesystem::proximate(file.path, folder).string()));
  out += line("kind", quoted(*said("kind", i)));
  const std::string unit = *said("value-unit", i);
  if (slope_unit(unit)) out += line("quantity", "\"slope\"");
  const auto has_unit = [&](const std::string& name) {
    const auto at = std::ranges::find(file.columns, name) - file.columns.begin();
    return at < std::ssize(file.units) && !file.units[static_cast<std::size_t>(at)].empty();
  };
  for (const char* which : {"position", "value"}) {
    if (!is_text) continue;
    const std::string name = *said(which + std::string("-column"), i);
    const std::string in = *said(which + std::string("-unit"), i);
    out += line(which + std::string("_column"), column(file, name),
                has_unit(name) ? "in " + in + ", as the header says" : "");
    if (!has_unit(name)) out += line(which + std::string("_unit"), quoted(in));
  }
  const auto number = [&](const char* key, const char* name, const char* remark) {
    if (const auto value = said(key, i); value && *value != "unknown")
      out += line(name, *value, remark);
  };
  number("base", "base_mm", "between the feet");
  if (face && said("center", i) != "0")
    number("center", "center_mm", "of the trace: the spindle axis");
  number("feed", "feed_mm_per_min", "");
  number("speed", "spindle_rpm", "");
  if (const auto direction = said("direction", i); direction && *direction != "unknown")
    out += line("cut_direction", quoted(*direction));
  if (level_of(i) != common_level) out += line("level", std::to_string(level_of(i)));
  return out + line("free", *said("free", i), "what levelling left undetermined");
}

std::string Draft::problem_text(const std::filesystem::path& folder) const {
  const int level = level_of(0);
  std::string out =
      "# Made by slideway init. All keys: slideway help problem-file\n" +
      line("title", quoted(files_[0].name + (files_.size() > 1 ? " and others" : "")));
  out +=
      "\n# Free text for the head of the report:\n[about]\n# machine = \"\"\n# instrument = \"\"\n";
  if (has_face()) {
    out += "\n[machine]\n" + line("lever", quoted(*said("lever", 0)));
    if (const auto overhang = said("overhang", 0))
      out += line("overhang_mm", *overhang, "from the carriage to the tool tip");
  }
  out +=
      "\n[low_band]\n" + line("level", std::to_string(level),
                              level == 0 ? "the readings as they are"
                                         : "means of " + std::to_string(1 << level) + " readings");
  std::size_t fewest = files_[0].trace->positions.size();
  for (std::size_t i = 0; i < files_.size(); ++i) {
    out += profile_text(i, level, folder);
    fewest = std::min(fewest, files_[i].trace->positions.size());
  }
  constexpr std::size_t kLeastDegree = 2, kFaceDegree = 3, kMostDegree = 5;
  const std::size_t most = has_face() ? kFaceDegree : kMostDegree;
  const std::size_t degree = std::clamp(fewest / 3, kLeastDegree, most);
  out +=
      "\n# The declared model; identify looks for what it lacks (slideway effects).\n[[effect]]\n" +
      line("name", quoted(name_of(MotionError::straightness))) +
      line("degree", std::to_string(degree));
  if (said("lever", 0) == "split")
    out +=
        "# The slope of the way at the spindle axis is the squareness, not the way's own.\n"
        "priors = [{ parameter = \"b1\", value = 0.0, standard_uncertainty = 1e-9 }]\n";
  if (has_face()) out += "\n[[effect]]\n" + line("name", quoted(name_of(MotionError::squareness)));
  return out;
}

}  // namespace slideway
