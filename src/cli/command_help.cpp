#include <algorithm>
#include <memory>

#include "command_list.hpp"
#include "completion.hpp"
#include "manual.hpp"
#include "output.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "topics.hpp"

namespace slideway {
namespace {

class HelpCommand : public Command {
 public:
  HelpCommand()
      : Command("help", "[COMMAND | TOPIC] [options]",
                "Explains a command, or a concept: effects, problem-file") {
    add_input("TOPIC", &topic_, false);
    add_options()("man", boost::program_options::bool_switch(&manual_),
                  "the manual page of COMMAND, or of the program, in roff");
    add_options()("completion", boost::program_options::value(&shell_)->value_name("SHELL"),
                  "the completion script of a shell: bash zsh");
    add_options()("out", boost::program_options::value(&out_)->value_name("FILE"),
                  "file to write; default stdout");
  }

  int run() override {
    write_output(out_, text());
    return kDone;
  }

 private:
  void check(const boost::program_options::variables_map& /*given*/) override {
    if (manual_ && !shell_.empty()) fail("--man and --completion exclude one another");
    if (!shell_.empty() && !topic_.empty()) fail("--completion takes no COMMAND");
  }

  [[nodiscard]] std::string text() const {
    if (!shell_.empty()) return completion_script(shell_);
    if (topic_.empty()) return manual_ ? manual_page(SLIDEWAY_VERSION) : program_help();
    std::vector<std::string> names = topics();
    if (!manual_ && std::ranges::find(names, topic_) != names.end()) return topic_text(topic_);
    for (const auto& [name, make] : commands()) {
      if (name == topic_) return manual_ ? manual_page(*make(), SLIDEWAY_VERSION) : make()->help();
      if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    }
    fail("no help on '" + printable(topic_) + "'" + did_you_mean(topic_, names) +
         "; accepted: " + joined(names, " "));
  }

  std::string topic_, shell_, out_ = "-";
  bool manual_ = false;
};

}  // namespace

std::unique_ptr<Command> make_help() { return std::make_unique<HelpCommand>(); }

}  // namespace slideway
