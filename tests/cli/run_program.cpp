#include "cli/run_program.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <thread>

namespace slideway {
namespace {

void require(int error) {
  if (error != 0) throw std::system_error(error, std::generic_category(), SLIDEWAY_PROGRAM);
}

/// A file without a name: unlike a pipe it holds any amount, and nobody need read meanwhile.
class Capture {
 public:
  Capture() : file_(std::tmpfile(), &std::fclose) {
    if (!file_) require(errno);
  }
  [[nodiscard]] int descriptor() const { return ::fileno(file_.get()); }
  [[nodiscard]] std::string text() const {
    std::rewind(file_.get());
    std::string text;
    for (int c = 0; (c = std::fgetc(file_.get())) != EOF;) text += static_cast<char>(c);
    return text;
  }

 private:
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

class SpawnActions {
 public:
  SpawnActions() { require(::posix_spawn_file_actions_init(&actions_)); }
  ~SpawnActions() { ::posix_spawn_file_actions_destroy(&actions_); }
  SpawnActions(const SpawnActions&) = delete;
  SpawnActions& operator=(const SpawnActions&) = delete;
  posix_spawn_file_actions_t* get() { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

std::vector<std::string> environment_with(const std::map<std::string, std::string>& added) {
  std::vector<std::string> variables;
  for (char** at = environ; *at != nullptr; ++at) {
    const std::string variable = *at;
    const std::string name = variable.substr(0, variable.find('='));
    if (name != "SLIDEWAY_DATA" && !added.contains(name)) variables.push_back(variable);
  }
  for (const auto& [name, value] : added) variables.push_back(name + "=" + value);
  return variables;
}

std::vector<char*> pointers(std::vector<std::string>& words) {
  std::vector<char*> out;
  for (std::string& word : words) out.push_back(word.data());
  out.push_back(nullptr);
  return out;
}

}  // namespace

ProgramRun run_program(const std::vector<std::string>& arguments, const ProgramSetup& setup) {
  const Capture out, err;
  SpawnActions actions;
  require(::posix_spawn_file_actions_addchdir_np(actions.get(), setup.folder.c_str()));
  require(::posix_spawn_file_actions_addopen(actions.get(), 0, "/dev/null", O_RDONLY, 0));
  if (setup.stdout_number >= 0)
    require(::posix_spawn_file_actions_adddup2(actions.get(), setup.stdout_number, 1));
  else if (setup.stdout_to.empty())
    require(::posix_spawn_file_actions_adddup2(actions.get(), out.descriptor(), 1));
  else
    require(::posix_spawn_file_actions_addopen(actions.get(), 1, setup.stdout_to.c_str(),
                                               O_WRONLY | O_CREAT, 0666));
  require(::posix_spawn_file_actions_adddup2(
      actions.get(), setup.stderr_number >= 0 ? setup.stderr_number : err.descriptor(), 2));

  std::vector<std::string> words{SLIDEWAY_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<std::string> variables = environment_with(setup.environment);
  pid_t child = 0;
  require(::posix_spawn(&child, SLIDEWAY_PROGRAM, actions.get(), nullptr, pointers(words).data(),
                        pointers(variables).data()));
  if (setup.signal != 0) {
    std::this_thread::sleep_for(setup.signal_after);
    ::kill(child, setup.signal);
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0)
    if (errno != EINTR) require(errno);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, out.text(), err.text()};
}

testing::AssertionResult is_refused(const ProgramRun& run, int exit_code) {
  const std::string& err = run.err;
  const bool one_line =
      std::count(err.begin(), err.end(), '\n') == 1 && err.size() > 1 && err.back() == '\n';
  if (run.exit_code == exit_code && run.out.empty() && one_line) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "exit code " << run.exit_code << ", expected " << exit_code
                                     << "; stdout: '" << run.out << "'; stderr: '" << err << "'";
}

std::string contents(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream) throw std::runtime_error(file.string() + ": cannot be read");
  return text.str();
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> names_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string shipped(const std::string& path) { return SLIDEWAY_SOURCE_DIR "/" + path; }

}  // namespace slideway
