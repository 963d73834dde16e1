#include "command.hpp"

#include <boost/program_options/parsers.hpp>
#include <sstream>

#include "output.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"

namespace slideway {
namespace po = boost::program_options;

Command::Command(std::string name, std::string arguments, std::string summary)
    : name_(std::move(name)), arguments_(std::move(arguments)), summary_(std::move(summary)) {
  add_options()("help,h", "this text");
  add_options()("quiet,q", po::bool_switch(&quiet_), "only what is asked for, and errors");
}

void Command::add_input(const char* name, std::string* value, bool required) {
  inputs_.add_options()(name, po::value(value));
  positional_.add(name, 1);
  if (required) required_.emplace_back(name);
}

void Command::add_inputs(const char* name, std::vector<std::string>* values) {
  inputs_.add_options()(name, po::value(values));
  positional_.add(name, -1);
}

bool Command::setup(const std::vector<std::string>& arguments) {
  const po::variables_map given = parse(arguments);
  if (given.count("help") != 0) {
    print(help());
    return false;
  }
  check(given);
  for (const std::string& input : required_)
    if (given.count(input) == 0 || given[input].as<std::string>().empty())
      fail(input + " is missing; usage: " + usage());
  return true;
}

std::string Command::help() const {
  std::ostringstream text;
  text << usage() << "\n\n" << summary_ << ".\n\n" << options_;
  return text.str();
}

void Command::check(const po::variables_map& /*given*/) {}

void Command::fail(const std::string& what) const { throw UsageError(name_ + ": " + what); }

po::variables_map Command::parse(const std::vector<std::string>& arguments) {
  po::options_description all;
  all.add(options_).add(inputs_);
  // An abbreviation that works today would break with the next option.
  constexpr int kStyle =
      po::command_line_style::unix_style & ~po::command_line_style::allow_guessing;
  try {
    po::variables_map given;
    po::store(
        po::command_line_parser(arguments).options(all).positional(positional_).style(kStyle).run(),
        given);
    po::notify(given);
    return given;
  } catch (const po::unknown_option& error) {
    const std::vector<std::string> names = option_names();
    const std::string& option = error.get_option_name();
    fail("unknown option '" + option + "'" + did_you_mean(option, names) +
         "; accepted: " + joined(names, " "));
  } catch (const po::too_many_positional_options_error&) {
    fail("too many arguments; usage: " + usage());
  } catch (const po::error& error) {
    fail(std::string(error.what()) + "; usage: " + usage() + ", or slideway " + name_ + " --help");
  }
}

std::vector<std::string> Command::option_names() const {
  std::vector<std::string> names;
  for (const auto& option : options_.options()) names.push_back("--" + option->long_name());
  return names;
}

std::string Command::usage() const { return "slideway " + name_ + " " + arguments_; }

}  // namespace slideway
