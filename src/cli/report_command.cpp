#include "report_command.hpp"

#include "output.hpp"
#include "slideway/base/error.hpp"
#include "slideway/report/report.hpp"
#include "slideway/trace/analysis.hpp"

namespace slideway {
namespace po = boost::program_options;

ReportCommand::ReportCommand(std::string name, std::string arguments, std::string summary)
    : Command(std::move(name), std::move(arguments), std::move(summary)) {
  add_options()("json", po::value(&json_)->value_name("FILE"),
                "write the result as JSON; - for stdout, which then holds nothing else");
}

void ReportCommand::report(const std::function<std::string()>& text,
                           const std::function<std::string()>& json) const {
  if (!json_.empty()) write_output(json_, json());
  if (!is_quiet() && json_ != "-") print(text());
}

ProblemCommand::ProblemCommand(std::string name, std::string arguments, std::string summary)
    : ReportCommand(std::move(name), std::move(arguments), std::move(summary)) {
  add_input("PROBLEM", &input_);
  add_options()("data", po::value(&data_)->value_name("DIR"),
                "what ${SLIDEWAY_DATA} in the problem file stands for");
  add_options()("ignore-checksum", po::bool_switch(&ignore_checksum_),
                "read a file whose checksum is wrong; the report then says so");
}

void ProblemCommand::add_strict() {
  add_options()("strict", po::bool_switch(&strict_), "exit code 4 if the verdict is negative");
}

int ProblemCommand::run_problem(Scope scope, bool closes_loop) const {
  keep_input(input_, json_file());
  Problem problem = read_problem(input_, data_directory(data_));
  for (ProfileEntry& entry : problem.profiles) {
    keep_input(entry.source.path, json_file());
    entry.source.request.ignore_checksum = ignore_checksum_;
  }
  const Analysis analysis = [&] {
    const ProgressLine line(closes_loop && !is_quiet());
    return analyse(problem, read_profiles(problem), {scope, closes_loop},
                   [&](const std::string& stage) { line.show("closing the loop: " + stage); });
  }();
  report([&] { return text_report(analysis.result, analysis.trace); },
         [&] { return json_report(analysis.result, analysis.trace); });
  return strict_ && is_negative(analysis) ? kNegativeVerdict : kDone;
}

std::optional<std::filesystem::path> data_directory(const std::string& option) {
  if (option.empty()) return std::nullopt;
  return option;
}

}  // namespace slideway
