#include <memory>

#include "command.hpp"
#include "output.hpp"
#include "slideway/base/file.hpp"
#include "slideway/report/report.hpp"

namespace slideway {
namespace {
namespace po = boost::program_options;

class ReportAgainCommand : public Command {
 public:
  ReportAgainCommand()
      : Command("report", "RESULT.json --html FILE",
                "Makes the page of a result written by --json") {
    add_input("RESULT.json", &input_);
    add_options()("html", po::value(&html_)->value_name("FILE"), "the page; - for stdout");
  }

  int run() override {
    if (html_.empty()) fail("--html FILE is missing");
    keep_input(input_, html_);
    const FileBytes json(input_);
    write_output(html_, html_report(json.text(), input_));
    return kDone;
  }

 private:
  std::string input_, html_;
};

}  // namespace

std::unique_ptr<Command> make_report() { return std::make_unique<ReportAgainCommand>(); }

}  // namespace slideway
