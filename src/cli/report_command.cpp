#include "report_command.hpp"

#include <nlohmann/json.hpp>

#include "output.hpp"
#include "slideway/base/error.hpp"
#include "slideway/report/report.hpp"
#include "slideway/trace/analysis.hpp"

namespace slideway {
namespace po = boost::program_options;
namespace {

void require_simulated(const Problem& problem) {
  if (!problem.truth) return;
  std::error_code ignored;
  for (const ProfileEntry& entry : problem.profiles)
    if (std::filesystem::status(entry.source.path, ignored).type() ==
        std::filesystem::file_type::not_found)
      throw DataError(
          "profile '" + entry.profile.name + "': " + entry.source.path.string() +
          ": is not there; the problem has a [truth] that makes it: slideway simulate " +
          problem.path.string() + " --out DIR, then take DIR/problem.toml");
}

}  // namespace

ReportCommand::ReportCommand(std::string name, std::string arguments, std::string summary)
    : Command(std::move(name), std::move(arguments), std::move(summary)) {
  add_options()("json", po::value(&json_)->value_name("FILE"),
                "write the result as JSON; - for stdout, which then holds nothing else");
}

void ReportCommand::add_html() {
  add_options()("html", po::value(&html_)->value_name("FILE"),
                "write the result as one self-contained page; - for stdout");
}

void ReportCommand::keep(const std::filesystem::path& input) const {
  if (!json_.empty() && json_ == html_)
    fail("--json and --html name one file, " + json_ + "; accepted: two");
  keep_input(input, json_);
  keep_input(input, html_);
}

void ReportCommand::report(const std::function<std::string()>& text,
                           const std::function<std::string()>& json) const {
  if (wants_json()) {
    const std::string document = json();
    if (!json_.empty()) write_output(json_, document);
    if (!html_.empty()) write_output(html_, html_report(document));
  }
  if (!is_quiet() && json_ != "-" && html_ != "-") print_report(text());
}

std::vector<Profile> ReportCommand::profiles_of(Problem problem, bool ignore_checksum,
                                                StageLine& line) const {
  for (ProfileEntry& entry : problem.profiles) {
    keep(entry.source.path);
    entry.source.request.ignore_checksum = ignore_checksum;
  }
  require_simulated(problem);
  const auto reading = [&](double done) { line.show("reading", done); };
  reading(0.0);
  return read_profiles(problem, reading);
}

std::string ReportCommand::document_text(const nlohmann::ordered_json& document) {
  return document.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

ProblemCommand::ProblemCommand(std::string name, std::string arguments, std::string summary)
    : ReportCommand(std::move(name), std::move(arguments), std::move(summary)) {
  add_input("PROBLEM", &input_);
  add_html();
  add_options()("data", po::value(&data_)->value_name("DIR"),
                "what ${SLIDEWAY_DATA} in the problem file stands for");
  add_options()("ignore-checksum", po::bool_switch(&ignore_checksum_),
                "read a file whose checksum is wrong; the report then says so");
}

void ProblemCommand::add_strict() {
  add_options()("strict", po::bool_switch(&strict_), "exit code 4 if the verdict is negative");
}

int ProblemCommand::run_problem(Scope scope, bool closes_loop) const {
  keep(input_);
  const Problem problem = read_problem(input_, data_directory(data_));
  const Analysis analysis = [&] {
    StageLine line(!is_quiet());
    const std::vector<Profile> profiles = profiles_of(problem, ignore_checksum_, line);
    line.show("fitting the declared model");
    return analyse(problem, profiles, {scope, closes_loop, closes_loop || wants_json()},
                   [&](const std::string& stage, double done) {
                     line.show("closing the loop: " + stage, done);
                   });
  }();
  report([&] { return text_report(analysis); }, [&] { return json_report(analysis); });
  return strict_ && is_negative(analysis) ? kNegativeVerdict : kDone;
}

std::optional<std::filesystem::path> data_directory(const std::string& option) {
  if (option.empty()) return std::nullopt;
  return option;
}

}  // namespace slideway
