#include <memory>

#include "output.hpp"
#include "report_command.hpp"
#include "slideway/report/comparison.hpp"
#include "slideway/report/document.hpp"

namespace slideway {
namespace {

class DiffCommand : public ReportCommand {
 public:
  DiffCommand()
      : ReportCommand("diff", "A.json B.json [options]",
                      "Compares two results, parameters in units of their combined U") {
    add_input("A.json", &a_);
    add_input("B.json", &b_);
  }

  int run() override {
    keep(a_);
    keep(b_);
    const NamedReport a{a_, read_report(a_)}, b{b_, read_report(b_)};
    report([&] { return comparison_text(a, b); }, [&] { return comparison_json(a, b); });
    return kDone;
  }

 private:
  std::string a_, b_;
};

}  // namespace

std::unique_ptr<Command> make_diff() { return std::make_unique<DiffCommand>(); }

}  // namespace slideway
