#include <malloc.h>

#include <csignal>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include "command.hpp"
#include "output.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"

namespace slideway {

#define SLIDEWAY_COMMAND(name) std::unique_ptr<Command> make_##name();
#include "command_list.inc"
#undef SLIDEWAY_COMMAND

namespace {

using Maker = std::unique_ptr<Command> (*)();

const std::vector<std::pair<std::string, Maker>>& commands() {
  static const std::vector<std::pair<std::string, Maker>> kList{
#define SLIDEWAY_COMMAND(name) {#name, make_##name},
#include "command_list.inc"
#undef SLIDEWAY_COMMAND
  };
  return kList;
}

std::string help() {
  std::string text =
      "usage: slideway COMMAND [options] INPUT\n"
      "       slideway COMMAND --help\n"
      "       slideway --version\n\n"
      "Finds out from the flatness of a turned face which errors the carriages of\n"
      "the lathe have.\n\n"
      "Commands:\n";
  for (const auto& [name, make] : commands())
    text += "  " + name + std::string(12 - name.size(), ' ') + make()->summary() + "\n";
  return text +
         "\nExit codes: 0 done, 1 failed while working, 2 bad usage or bad problem file,\n"
         "3 unreadable or invalid data, 4 negative verdict (--strict only),\n"
         "5 batch finished with failed items\n";
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

int run(const std::vector<std::string>& arguments) {
  if (arguments.empty())
    throw UsageError("no command; usage: slideway COMMAND [options] INPUT, or slideway --help");
  if (arguments[0] == "--help" || arguments[0] == "-h") {
    print(help());
    return kDone;
  }
  if (arguments[0] == "--version") {
    print("slideway " SLIDEWAY_VERSION "\n");
    return kDone;
  }
  const std::unique_ptr<Command> command = make_command(arguments[0]);
  if (!command->setup({arguments.begin() + 1, arguments.end()})) return kDone;
  return command->run();
}

int failed(int code, std::string_view message) {
  say(message);
  return code;
}

}  // namespace
}  // namespace slideway

int main(int argc, char** argv) {
  using namespace slideway;
  // Memory a matrix gives back serves the next: fresh pages cost more than the arithmetic on them.
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  // A closed pipe or a file beyond the limit is a failed write, reported as one.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    return run({argv + 1, argv + argc});
  } catch (const UsageError& error) {
    return failed(kBadUsage, error.what());
  } catch (const DataError& error) {
    return failed(kBadData, error.what());
  } catch (const std::bad_alloc&) {
    return failed(kFailed, "out of memory");
  } catch (const std::exception& error) {
    return failed(kFailed, error.what());
  } catch (...) {
    return failed(kFailed, "unknown error");
  }
}
