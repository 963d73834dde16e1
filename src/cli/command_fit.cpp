#include <memory>

#include "report_command.hpp"

namespace slideway {
namespace {

class FitCommand : public ProblemCommand {
 public:
  FitCommand()
      : ProblemCommand("fit", "PROBLEM [options]", "Fits the declared model, nothing else") {
    add_strict();
  }
  int run() override { return run_problem(Scope::fit); }
};

}  // namespace

std::unique_ptr<Command> make_fit() { return std::make_unique<FitCommand>(); }

}  // namespace slideway
