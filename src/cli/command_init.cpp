#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <map>
#include <memory>

#include "command.hpp"
#include "output.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/identify/draft.hpp"
#include "slideway/report/layout.hpp"
#include "slideway/report/picture.hpp"

namespace slideway {
namespace {
namespace po = boost::program_options;

/// What each option of a question says in --help.
const std::map<std::string, const char*> kOptions{
    {"position-column", "column of the positions, header name or number"},
    {"value-column", "column of the values, header name or number"},
    {"position-unit", "where the file does not say it: m mm um nm inch s"},
    {"value-unit", "where the file does not say it: m mm um nm inch, or a slope's"},
    {"kind", "face: a turned face; slide: a reading along the slide"},
    {"trace", "face: diameter, the trace crossed the centre; radius, it did not"},
    {"center", "face: position of the spindle axis in the trace, mm"},
    {"feed", "face: mm/min, or unknown"},
    {"speed", "face: turns of the spindle per minute, or unknown"},
    {"direction", "face: the tool cut inward or outward, or unknown"},
    {"base", "slope: mm between the feet, or unknown"},
    {"free", "what levelling took away: offset,tilt or offset or none"},
    {"lever", "face: split, the tool hangs on the carriage; paper, as Eq. (16) has it"},
    {"overhang", "lever split: mm from the carriage to the tool tip"}};

std::string with_unit(const std::string& column, const std::string& unit) {
  return column + (unit.empty() ? " (no unit)" : " (" + unit + ")");
}

/// How a file was understood before any question.
std::string head_text(const DraftFile& file) {
  std::string text = paragraph("", file.path.string() + ": " + file.format +
                                       (file.decision.empty() ? "" : "; " + file.decision));
  std::vector<std::string> columns;
  for (std::size_t i = 0; i < file.columns.size(); ++i)
    columns.push_back(with_unit(file.columns[i], file.units[i]));
  return columns.empty() ? text : text + paragraph("  columns  ", joined(columns));
}

std::string trace_text(const DraftFile& file) {
  const auto [least, most] = std::ranges::minmax(file.trace->positions);
  return paragraph("  read     ", counted(file.trace->positions.size(), "reading") + " at " +
                                      significant(least, 6) + " to " + significant(most, 6)) +
         picture(file.trace->positions, file.trace->values, {.rows = 5});
}

class InitCommand : public Command {
 public:
  InitCommand()
      : Command("init", "FILE... [--out PROBLEM.toml] [options]",
                "Makes a problem of data files, with questions on a terminal") {
    add_inputs("FILE", &inputs_);
    add_options()("out", po::value(&out_)->value_name("PROBLEM.toml"),
                  "file to write; default problem.toml; - for stdout");
    add_options()("force", po::bool_switch(&force_), "replace an existing PROBLEM.toml");
    add_options()("yes", po::bool_switch(&yes_), "take every guess without a question");
    for (const std::string& key : Draft::keys())
      add_options()(key.c_str(), po::value(&options_[key])->value_name("ANSWER"),
                    (kOptions.at(key) +
                     std::string(Draft::is_of_file(key) ? "; once, or once for each file" : ""))
                        .c_str());
  }

  int run() override {
    keep_output();
    Draft draft({inputs_.begin(), inputs_.end()});
    for (const DraftFile& file : draft.files()) tell(head_text(file));
    std::vector<std::string> missing;
    std::vector<bool> shown(inputs_.size(), false);
    for (auto question = draft.next(); question; question = draft.next()) {
      show_traces(draft, shown);
      if (!settle(draft, *question)) {
        missing.push_back(in_words(draft, *question));
        draft.answer(*question, question->guess.empty() ? question->fallback : question->guess);
      }
    }
    show_traces(draft, shown);
    if (!missing.empty())
      fail("nobody to ask; accepted: on a terminal, or with the options " + joined(missing, "; "));
    write_output(out_, draft.problem_text(folder()));
    const std::string problem = as_typed(out_);
    tell("\n" + out_ + " is written. Next: slideway check " + problem +
         ", then slideway identify " + problem + "\n");
    return kDone;
  }

 private:
  void check(const po::variables_map& /*given*/) override {
    if (inputs_.empty()) fail("FILE is missing; usage: slideway init FILE... [--out PROBLEM.toml]");
    for (const auto& [key, values] : options_)
      if (values.size() > 1 && (!Draft::is_of_file(key) || values.size() != inputs_.size()))
        fail("--" + key + " is given " + std::to_string(values.size()) + " times; accepted: once" +
             (Draft::is_of_file(key) ? ", or once for each file" : ""));
    for (const char* key : {"center", "feed", "speed", "base"})
      for (const std::string& value : options_[key])
        if (inputs_.size() > 1 && value.find(',') != std::string::npos)
          fail("--" + std::string(key) + " " + value +
               ": a list, or a decimal comma? accepted: one number with a decimal point, once, or "
               "once for each file");
  }

  [[nodiscard]] std::filesystem::path folder() const {
    const std::filesystem::path path(out_);
    return out_ != "-" && path.has_parent_path() ? path.parent_path() : ".";
  }

  void keep_output() const {
    for (const std::string& input : inputs_) keep_input(input, out_);
    std::error_code ignored;
    if (out_ != "-" && !force_ && std::filesystem::exists(out_, ignored))
      fail(out_ + " is there; accepted: --force to replace it, or --out with another name");
  }

  void tell(const std::string& text) const {
    if (!is_quiet() && out_ != "-") print_report(text);
  }

  void show_traces(const Draft& draft, std::vector<bool>& shown) const {
    for (std::size_t i = 0; i < shown.size(); ++i) {
      if (shown[i] || !draft.files()[i].trace) continue;
      shown[i] = true;
      tell("\n" + draft.files()[i].name + "\n" + trace_text(draft.files()[i]));
    }
  }

  /// Answers by option, by a guess, or by who is asked. @return false: nobody answers
  bool settle(Draft& draft, const DraftQuestion& question) const {
    const std::vector<std::string>& values = options_.at(question.key);
    if (!values.empty()) {
      const std::string& value = values.size() > 1 ? values[question.file] : values.front();
      try {
        draft.answer(question, value);
      } catch (const UsageError& error) {
        fail("--" + question.key + ": " + error.what());
      }
      return true;
    }
    if (question.certain || (yes_ && !question.guess.empty())) {
      tell(paragraph("  taken    ", question.key + " " + question.guess + ": " + question.why));
      draft.answer(question, question.guess);
      return true;
    }
    if (yes_ || isatty(STDIN_FILENO) == 0) return false;
    ask(draft, question);
    return true;
  }

  static void ask(Draft& draft, const DraftQuestion& question) {
    const std::string about =
        Draft::is_of_file(question.key) ? draft.files()[question.file].name + ": " : "";
    std::cerr << "\n" << question.picture << paragraph("", about + question.words);
    if (!question.guess.empty())
      std::cerr << paragraph("  ", "I guess " + question.guess + ": " + question.why);
    for (std::string text;;) {
      std::cerr << "  " << question.accepted
                << (question.guess.empty() ? "" : " [" + question.guess + "]") << ": "
                << std::flush;
      if (!std::getline(std::cin, text)) throw UsageError("init: the input ended at a question");
      if (trimmed(text).empty()) text = question.guess;
      try {
        return draft.answer(question, text);
      } catch (const UsageError& error) {
        std::cerr << "  " << error.what() << "\n";
      }
    }
  }

  /// An option that is missing: "--feed (mm/min, or unknown)".
  static std::string in_words(const Draft& draft, const DraftQuestion& question) {
    const bool of_one = Draft::is_of_file(question.key) && draft.files().size() > 1;
    return "--" + question.key + " (" + (of_one ? draft.files()[question.file].name + ": " : "") +
           question.accepted + (question.guess.empty() ? "" : "; --yes takes " + question.guess) +
           ")";
  }

  std::vector<std::string> inputs_;
  std::string out_ = "problem.toml";
  std::map<std::string, std::vector<std::string>> options_;
  bool force_ = false, yes_ = false;
};

}  // namespace

std::unique_ptr<Command> make_init() { return std::make_unique<InitCommand>(); }

}  // namespace slideway
