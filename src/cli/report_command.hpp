#pragma once

#include <functional>
#include <optional>
#include <string>

#include "command.hpp"
#include "slideway/identify/identify.hpp"

namespace slideway {

/// A command whose result is a text for people and, with --json, a JSON document.
class ReportCommand : public Command {
 protected:
  ReportCommand(std::string name, std::string arguments, std::string summary);

  /// Writes what the options ask for, and makes no more than that.
  void report(const std::function<std::string()>& text,
              const std::function<std::string()>& json) const;

  [[nodiscard]] const std::string& json_file() const { return json_; }

 private:
  std::string json_;
};

/// A command that reports on a problem file.
class ProblemCommand : public ReportCommand {
 protected:
  ProblemCommand(std::string name, std::string arguments, std::string summary);

  void add_strict();

  /// Reads the problem and its profiles, does the job and reports. @return the exit code.
  int run_problem(Scope scope, bool closes_loop = false) const;

  [[nodiscard]] const std::string& input() const { return input_; }

 private:
  std::string input_, data_;
  bool strict_ = false, ignore_checksum_ = false;
};

/// --data DIR, as read_problem() wants it.
std::optional<std::filesystem::path> data_directory(const std::string& option);

}  // namespace slideway
