#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "command.hpp"
#include "progress.hpp"
#include "slideway/identify/identify.hpp"

namespace slideway {

/// The problem file and all that it names.
std::vector<std::filesystem::path> files_of(const Problem& problem);
/// The same of a file that may have faults; of one that is no regular file, the file alone.
std::vector<std::filesystem::path> files_of(const std::filesystem::path& problem,
                                            const std::optional<std::filesystem::path>& data_dir);

/// A command whose result is a text and, with --json, a JSON document; with --html a page made from
/// the JSON.
class ReportCommand : public Command {
 protected:
  ReportCommand(std::string name, std::string arguments, std::string summary);

  using Make = std::function<std::string()>;

  /// Makes and writes the outputs that the options request. REQUIRES html where add_html() was
  /// called.
  void report(const Make& text, const Make& json, const Make& html = {}) const;

  void add_html();

  /// @throws UsageError  an output would replace the input
  void keep(const std::filesystem::path& input) const;

  /// @throws UsageError  the JSON or the page would replace another output
  void keep_apart(const std::filesystem::path& output) const;

  /// @throws UsageError  the file is one of data, not a problem
  static void require_problem(const std::filesystem::path& input);

  /// Reads the profiles of a problem, after a check that no output replaces one of its files.
  [[nodiscard]] std::vector<Profile> profiles_of(Problem problem, bool ignore_checksum,
                                                 StageLine& line) const;

  /// A document as --json writes it; what is no UTF-8 in it, a file's name, is replaced.
  static std::string document_text(const nlohmann::ordered_json& document);

  [[nodiscard]] bool wants_json() const { return !json_.empty(); }
  /// Where the page goes; "": none is asked for.
  [[nodiscard]] const std::string& page() const { return html_; }

 private:
  std::string json_, html_;
};

/// A command that reports on a problem file.
class ProblemCommand : public ReportCommand {
 protected:
  ProblemCommand(std::string name, std::string arguments, std::string summary);

  void add_strict();
  void check(const boost::program_options::variables_map& given) override;

  /// Reads the problem and its profiles, does the job and reports. @return the exit code.
  int run_problem(Scope scope, bool closes_loop = false,
                  std::optional<double> time_limit_s = std::nullopt) const;

  [[nodiscard]] const std::string& input() const { return input_; }

 private:
  std::string input_, data_, date_;
  bool strict_ = false, ignore_checksum_ = false, full_ = false, curves_ = false;
};

}  // namespace slideway
