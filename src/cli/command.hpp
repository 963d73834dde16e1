#pragma once

#include <boost/program_options/options_description.hpp>
#include <boost/program_options/positional_options.hpp>
#include <boost/program_options/variables_map.hpp>
#include <string>
#include <vector>

namespace slideway {

inline constexpr int kDone = 0;
inline constexpr int kFailed = 1;
inline constexpr int kBadUsage = 2;
inline constexpr int kBadData = 3;
inline constexpr int kNegativeVerdict = 4;  // with --strict only
inline constexpr int kFailedItems = 5;      // batch

/// One command of the program. A command adds its options in the constructor, bound to its members.
class Command {
 public:
  /// @param arguments  what stands behind the name in the synopsis: "PROBLEM [options]"
  Command(std::string name, std::string arguments, std::string summary);
  virtual ~Command() = default;
  Command(const Command&) = delete;
  Command& operator=(const Command&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::string& arguments() const { return arguments_; }
  [[nodiscard]] const std::string& summary() const { return summary_; }
  [[nodiscard]] const boost::program_options::options_description& options() const {
    return options_;
  }
  /// What --help prints.
  [[nodiscard]] std::string help() const;

  /// Parses and validates the arguments; opens no file. False if nothing remains to be done
  /// because --help was asked for.
  /// @throws UsageError
  bool setup(const std::vector<std::string>& arguments);

  /// Does the work. @return the exit code. REQUIRES setup() returned true.
  virtual int run() = 0;

 protected:
  /// The named options, for `add_options()("level", value, "what it does")`.
  boost::program_options::options_description_easy_init add_options() {
    return options_.add_options();
  }

  /// An argument that needs no "--", called `name` in messages; in the order of the calls.
  void add_input(const char* name, std::string* value, bool required = true);

  [[nodiscard]] bool is_quiet() const { return quiet_; }
  /// All further arguments that need no "--".
  void add_inputs(const char* name, std::vector<std::string>* values);

  /// Checks what the options' own types cannot. @throws UsageError
  virtual void check(const boost::program_options::variables_map& given);

  /// @throws UsageError  "identify: what is wrong"
  [[noreturn]] void fail(const std::string& what) const;

 private:
  boost::program_options::variables_map parse(const std::vector<std::string>& arguments);
  [[nodiscard]] std::vector<std::string> option_names() const;
  [[nodiscard]] std::string usage() const;

  std::string name_, arguments_, summary_;
  boost::program_options::options_description options_{"Options"};
  boost::program_options::options_description inputs_;
  boost::program_options::positional_options_description positional_;
  std::vector<std::string> required_;
  bool quiet_ = false;
};

}  // namespace slideway
