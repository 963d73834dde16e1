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
      : Command("report", "RESULT.json --html FILE | --svg FILE",
                "Makes the page or a picture of a result written by --json") {
    add_input("RESULT.json", &input_);
    add_options()("html", po::value(&html_)->value_name("FILE"), "the page; - for stdout");
    add_options()("svg", po::value(&svg_)->value_name("FILE"),
                  "one picture: a profile, the model, and what is left; - for stdout");
  }

  int run() override {
    if (html_.empty() && svg_.empty()) fail("--html FILE is missing, or --svg FILE");
    if (!html_.empty() && !svg_.empty() && is_one_file(html_, svg_))
      fail("--html and --svg name one file, " + html_ + "; accepted: two");
    keep_input(input_, html_);
    keep_input(input_, svg_);
    const FileBytes json = FileBytes::of_file_or_stdin(input_);
    if (!html_.empty()) write_output(html_, html_report(json.text(), input_));
    if (!svg_.empty()) write_output(svg_, svg_report(json.text(), input_));
    return kDone;
  }

 private:
  std::string input_, html_, svg_;
};

}  // namespace

std::unique_ptr<Command> make_report() { return std::make_unique<ReportAgainCommand>(); }

}  // namespace slideway
