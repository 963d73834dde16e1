#include <memory>

#include "report_command.hpp"

namespace slideway {
namespace {

class IdentifyCommand : public ProblemCommand {
 public:
  IdentifyCommand()
      : ProblemCommand("identify", "PROBLEM [options]",
                       "Finds the carriages' errors: low band, ranking, fit, cross-check") {
    add_strict();
    add_options()("no-trace", "stop before the closed loop");
  }
  int run() override { return run_problem(Scope::identify); }
};

}  // namespace

std::unique_ptr<Command> make_identify() { return std::make_unique<IdentifyCommand>(); }

}  // namespace slideway
