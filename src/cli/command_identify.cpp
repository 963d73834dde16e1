#include <memory>

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
  }
  int run() override { return run_problem(Scope::identify, !no_trace_); }

 private:
  bool no_trace_ = false;
};

}  // namespace

std::unique_ptr<Command> make_identify() { return std::make_unique<IdentifyCommand>(); }

}  // namespace slideway
