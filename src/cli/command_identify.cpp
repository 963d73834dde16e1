#include <memory>
#include <optional>

#include "report_command.hpp"

namespace slideway {
namespace {
namespace po = boost::program_options;

class IdentifyCommand : public ProblemCommand {
 public:
  IdentifyCommand()
      : ProblemCommand("identify", "PROBLEM [options]",
                       "Finds the carriages' errors and what else made the face") {
    add_strict();
    add_options()("no-trace", po::bool_switch(&no_trace_), "stop before the closed loop");
    add_options()("time-limit", po::value<double>()->value_name("SECONDS"),
                  "the closed loop ends after so long with what it has (time_limit_s of [trace])");
  }
  void check(const po::variables_map& given) override {
    ProblemCommand::check(given);
    if (given.count("time-limit") == 0) return;
    time_limit_s_ = given["time-limit"].as<double>();
    if (!(*time_limit_s_ > 0.0 && *time_limit_s_ < 1e9))
      fail("--time-limit: accepted: seconds above 0 and below 1e9");
  }
  int run() override { return run_problem(Scope::identify, !no_trace_, time_limit_s_); }

 private:
  bool no_trace_ = false;
  std::optional<double> time_limit_s_;
};

}  // namespace

std::unique_ptr<Command> make_identify() { return std::make_unique<IdentifyCommand>(); }

}  // namespace slideway
