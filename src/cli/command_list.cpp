#include "command_list.hpp"

#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"

namespace slideway {

#define SLIDEWAY_COMMAND(name) std::unique_ptr<Command> make_##name();
#include "command_list.inc"
#undef SLIDEWAY_COMMAND

const std::vector<std::pair<std::string, CommandMaker>>& commands() {
  static const std::vector<std::pair<std::string, CommandMaker>> kList{
#define SLIDEWAY_COMMAND(name) {#name, make_##name},
#include "command_list.inc"
#undef SLIDEWAY_COMMAND
  };
  return kList;
}

std::string first_steps() {
  return "slideway finds, from the measured flatness of a turned face, the errors of the\n"
         "carriages of the lathe. What to type first:\n\n"
         "  slideway demo                 an example: the verdict here, a page beside it\n"
         "  slideway info FILE            what is in a file of measured data\n"
         "  slideway init FILE...         makes a problem of your files, with questions\n"
         "  slideway check problem.toml   every fault of it, and what it can determine\n"
         "  slideway identify problem.toml --html report.html\n"
         "  slideway serve                the same in a browser on this machine\n\n"
         "All commands: slideway --help\n";
}

std::string program_help() {
  std::string text =
      "usage: slideway COMMAND [options] INPUT\n"
      "       slideway COMMAND --help\n"
      "       slideway --version\n\n"
      "Finds out from the flatness of a turned face which errors the carriages of\n"
      "the lathe have.\n\n"
      "Commands:\n";
  for (const auto& [name, make] : commands())
    text += "  " + name + std::string(12 - name.size(), ' ') + make()->summary() + "\n";
  return text + "\nConcepts: slideway help effects, slideway help problem-file\n\nExit codes: " +
         kExitCodes + "\n";
}

std::unique_ptr<Command> make_command(const std::string& wanted) {
  std::vector<std::string> names;
  for (const auto& [name, make] : commands()) {
    if (name == wanted) return make();
    names.push_back(name);
  }
  for (const char* option : {"--help", "--version"}) names.emplace_back(option);
  const std::string kind = wanted.starts_with('-') ? "option" : "command";
  throw UsageError("unknown " + kind + " '" + wanted + "'" + did_you_mean(wanted, names) +
                   "; accepted: " + joined(names, " "));
}

}  // namespace slideway
