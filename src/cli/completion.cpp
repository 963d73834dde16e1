#include "completion.hpp"

#include <algorithm>
#include <map>
#include <sstream>
#include <vector>

#include "command_list.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/report/compensation.hpp"
#include "slideway/signal/dwt.hpp"
#include "topics.hpp"

namespace slideway {
namespace {

/// The words an option takes, blanks between; "" where it is a file, a number or free text.
std::string words_of(const std::string& option) {
  static const std::map<std::string, std::string> kWords = [] {
    const std::string lengths(kLengthUnits);
    std::map<std::string, std::string> words{
        {"boundary", std::string(kBoundaries)},
        {"position-unit", lengths + " s"},
        {"value-unit", lengths + " " + std::string(kSlopeUnits)},
        {"encoding", "utf-8 utf-16 latin-1"},
        {"completion", "bash zsh"},
        {"kind", "face slide"},
        {"trace", "diameter radius"},
        {"direction", "inward outward unknown"},
        {"free", "offset,tilt offset none"},
        {"lever", "split paper"},
        {"to", joined(compensation_formats(), " ") + " residual dcc"}};
    for (int n = 1; n <= 19; ++n) words["wavelet"] += (n > 1 ? " db" : "db") + std::to_string(n);
    return words;
  }();
  const auto found = kWords.find(option);
  return found == kWords.end() ? "" : found->second;
}

std::string command_names() {
  std::vector<std::string> names;
  for (const auto& [name, make] : commands()) names.push_back(name);
  return joined(names, " ");
}

/// The words that can stand where a command's input does; "": files.
std::string inputs_of(const std::string& command) {
  if (command == "effects") return joined(effect_names(), " ");
  if (command == "help") return command_names() + " " + joined(topics(), " ");
  return "";
}

bool takes_value(const boost::program_options::option_description& option) {
  return option.semantic()->max_tokens() != 0;
}

std::string bash() {
  std::string values, options, inputs;
  for (const auto& [name, make] : commands()) {
    const auto command = make();
    std::string all;
    for (const auto& option : command->options().options()) {
      const std::string& word = option->long_name();
      all += (all.empty() ? "--" : " --") + word;
      if (takes_value(*option))
        values += "    " + name + ":--" + word + ") words='" + words_of(word) + "' ;;\n";
    }
    options += "      " + name + ") words='" + all + "' ;;\n";
    if (const std::string words = inputs_of(name); !words.empty())
      inputs += "      " + name + ") words='" + words + "' ;;\n";
  }
  return "# bash completion of slideway; made by: slideway help --completion bash\n"
         "_slideway() {\n"
         "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} words=\n"
         "  local command=${COMP_WORDS[1]}\n"
         "  COMPREPLY=()\n"
         "  if ((COMP_CWORD == 1)); then\n"
         "    COMPREPLY=($(compgen -W '" +
         command_names() +
         " --help --version' -- \"$word\"))\n"
         "    return\n"
         "  fi\n"
         "  case $command:$before in\n" +
         values +
         "    *)\n"
         "    if [[ $word == -* ]]; then\n"
         "      case $command in\n" +
         options +
         "      esac\n"
         "    else\n"
         "      case $command in\n" +
         inputs +
         "      esac\n"
         "    fi ;;\n"
         "  esac\n"
         "  # Without words, bash completes file names.\n"
         "  [[ -z $words ]] || COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n"
         "}\n"
         "complete -o default -F _slideway slideway\n";
}

/// Text inside '...' of zsh's _arguments and _describe.
std::string quoted(const std::string& text, const std::string& special) {
  std::string out;
  for (const char c : text) {
    if (special.find(c) != std::string::npos) out += '\\';
    if (c == '\'')
      out += "'\\''";
    else
      out += c == '\n' ? ' ' : c;
  }
  return out;
}

std::string zsh_options(const Command& command) {
  std::string text;
  for (const auto& option : command.options().options()) {
    text += " \\\n        '--" + option->long_name() + "[" +
            quoted(option->description(), "[]:\\") + "]";
    if (takes_value(*option)) {
      const std::string words = words_of(option->long_name());
      text += ":value:" + (words.empty() ? "_files" : "(" + words + ")");
    }
    text += "'";
  }
  const std::string words = inputs_of(command.name());
  return text + " \\\n        '*:input:" + (words.empty() ? "_files" : "(" + words + ")") + "'";
}

std::string zsh() {
  std::string names, cases;
  for (const auto& [name, make] : commands()) {
    const auto command = make();
    names += "      '" + name + ":" + quoted(command->summary(), ":\\") + "'\n";
    cases += "    " + name + ")\n      _arguments" + zsh_options(*command) + " ;;\n";
  }
  return "#compdef slideway\n"
         "# zsh completion of slideway; made by: slideway help --completion zsh\n"
         "_slideway() {\n"
         "  if (( CURRENT == 2 )); then\n"
         "    local -a names\n"
         "    names=(\n" +
         names +
         "    )\n"
         "    _describe command names\n"
         "    return\n"
         "  fi\n"
         "  shift words\n"
         "  (( CURRENT-- ))\n"
         "  case $words[1] in\n" +
         cases +
         "  esac\n"
         "}\n"
         "_slideway \"$@\"\n";
}

}  // namespace

std::string completion_script(const std::string& shell) {
  if (shell == "bash") return bash();
  if (shell == "zsh") return zsh();
  throw UsageError("unknown shell '" + printable(shell) + "'; accepted: bash zsh");
}

}  // namespace slideway
