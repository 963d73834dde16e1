#include <algorithm>
#include <memory>

#include "environment.hpp"
#include "report_command.hpp"
#include "slideway/report/check_report.hpp"

namespace slideway {
namespace {
namespace po = boost::program_options;

class CheckCommand : public ReportCommand {
 public:
  CheckCommand()
      : ReportCommand("check", "PROBLEM [options]",
                      "Finds every fault of a problem and what it can determine") {
    add_input("PROBLEM", &input_);
    add_options()("data", po::value(&data_)->value_name("DIR"),
                  "what ${SLIDEWAY_DATA} in the problem file stands for");
  }

  int run() override {
    for (const std::filesystem::path& file : files_of(input_, data_directory(data_))) keep(file);
    require_problem(input_);
    const ProblemCheck check = check_problem(input_, data_directory(data_));
    report([&] { return check_text(check); }, [&] { return check_json(check); });
    if (check.faults.empty()) return kDone;
    return std::ranges::all_of(check.faults, &Fault::is_of_data) ? kBadData : kBadUsage;
  }

 private:
  std::string input_, data_;
};

}  // namespace

std::unique_ptr<Command> make_check() { return std::make_unique<CheckCommand>(); }

}  // namespace slideway
