#include "manual.hpp"

#include <algorithm>
#include <boost/program_options/cmdline.hpp>

#include "command_list.hpp"

namespace slideway {
namespace {

constexpr const char* kDescription =
    "Finds out from the flatness of a turned face which errors the carriages of the lathe have.";

/// Text as roff prints it: no hyphen where a minus is meant, no request at the start of a line.
std::string plain(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else if ((c == '.' || c == '\'') && out.empty())
      out += std::string("\\&") + c;
    else
      out += c == '\n' ? ' ' : c;
  }
  return out;
}

std::string upper(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](char c) { return c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c; });
  return text;
}

std::string header(const std::string& name, const std::string& version,
                   const std::string& summary) {
  return ".TH " + upper(name) + R"( 1 "" "slideway )" + version +
         "\" \"slideway\"\n.ad l\n.SH NAME\n" + plain(name) + " \\- " + plain(summary) + "\n";
}

std::string options_of(const Command& command) {
  std::string text;
  for (const auto& option : command.options().options()) {
    const std::string letter = option->canonical_display_name(
        boost::program_options::command_line_style::allow_dash_for_short);
    text += ".TP\n";
    if (letter.starts_with('-') && letter.size() == 2) text += "\\fB" + plain(letter) + "\\fR, ";
    text += R"(\fB\-\-)" + plain(option->long_name()) + "\\fR";
    if (const std::string value = option->format_parameter(); !value.empty())
      text += " \\fI" + plain(value) + "\\fR";
    text += '\n';
    text += plain(option->description()) + "\n";
  }
  return text;
}

std::string ending() {
  return std::string(".SH EXIT STATUS\n") + plain(kExitCodes) +
         "\n.SH ENVIRONMENT\n.TP\nSLIDEWAY_DATA\nwhat ${SLIDEWAY_DATA} in the paths of a problem "
         "file stands for\n";
}

}  // namespace

std::string manual_page(const Command& command, const std::string& version) {
  return header("slideway-" + command.name(), version, command.summary()) +
         ".SH SYNOPSIS\n.B slideway " + plain(command.name()) + "\n" + plain(command.arguments()) +
         "\n.SH DESCRIPTION\n" + plain(command.summary()) + ".\n.SH OPTIONS\n" +
         options_of(command) + ending() + ".SH SEE ALSO\n.BR slideway (1)\n";
}

std::string manual_page(const std::string& version) {
  std::string text = header("slideway", version, "carriage errors of a lathe from its faces") +
                     ".SH SYNOPSIS\n.B slideway\nCOMMAND [options] INPUT\n.br\n.B slideway help\n"
                     "[COMMAND | TOPIC]\n.SH DESCRIPTION\n" +
                     plain(kDescription) + "\n.SH COMMANDS\n";
  std::string also;
  for (const auto& [name, make] : commands()) {
    text += ".TP\n\\fB" + plain(name) + "\\fR\n" + plain(make()->summary()) + "\n";
    also += (also.empty() ? "" : " ,\n") + (".BR slideway\\-" + plain(name) + " (1)");
  }
  return text + ending() + ".SH SEE ALSO\n" + also + "\n";
}

}  // namespace slideway
