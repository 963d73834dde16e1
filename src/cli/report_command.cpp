#include "report_command.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "environment.hpp"
#include "output.hpp"
#include "slideway/base/date.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/file.hpp"
#include "slideway/base/text.hpp"
#include "slideway/format/format.hpp"
#include "slideway/identify/problem_tree.hpp"
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

std::vector<std::filesystem::path> files_of(const Problem& problem) {
  std::vector<std::filesystem::path> files{problem.path};
  for (const ProfileEntry& entry : problem.profiles) files.push_back(entry.source.path);
  files.insert(files.end(), problem.beside.begin(), problem.beside.end());
  return files;
}

std::vector<std::filesystem::path> files_of(const std::filesystem::path& problem,
                                            const std::optional<std::filesystem::path>& data_dir) {
  constexpr std::string_view kVariable = "${SLIDEWAY_DATA}";
  std::vector<std::filesystem::path> files{problem};
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(problem, ignored)) return files;
  for (std::string file : files_named(problem)) {
    if (const std::size_t at = file.find(kVariable); at != std::string::npos && data_dir)
      file.replace(at, kVariable.size(), std::filesystem::absolute(*data_dir).string());
    files.push_back(problem.parent_path() / file);
  }
  return files;
}

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
  if (!json_.empty() && !html_.empty() && is_one_file(json_, html_))
    fail("--json and --html name one file, " + html_ + "; accepted: two");
  keep_input(input, json_);
  keep_input(input, html_);
}

void ReportCommand::keep_apart(const std::filesystem::path& output) const {
  for (const std::string& name : {json_, html_})
    if (!name.empty() && is_one_file(name, output))
      fail(name + ": two results would go there; accepted: another name");
}

void ReportCommand::require_problem(const std::filesystem::path& input) {
  std::error_code ignored;
  if (input.extension() == ".toml" || !std::filesystem::is_regular_file(input, ignored)) return;
  const Format& format = recognised_format(FileBytes::of_regular_file(input).text());
  const Format& text = *formats().back();
  const std::string ending = input.extension().string();
  if (&format == &text && std::ranges::count(text.endings(), std::string_view(ending)) == 0) return;
  throw UsageError(input.string() + ": is a data file (" + std::string(format.name()) +
                   "), no problem; make a problem of it: slideway init " +
                   as_typed(input.string()));
}

void ReportCommand::report(const Make& text, const Make& json, const Make& html) const {
  if (!json_.empty()) write_output(json_, json());
  if (!html_.empty()) write_output(html_, html());
  if (!is_quiet() && json_ != "-" && html_ != "-") print_report(text());
}

std::vector<Profile> ReportCommand::profiles_of(Problem problem, bool ignore_checksum,
                                                StageLine& line) const {
  for (const std::filesystem::path& file : files_of(problem)) keep(file);
  for (ProfileEntry& entry : problem.profiles)
    entry.source.request.ignore_checksum = ignore_checksum;
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
  add_options()("date", po::value(&date_)->value_name("DATE"),
                "when this was evaluated, 2026-11-23; without it the report has no date");
  add_options()("full", po::bool_switch(&full_),
                "print all that was found, not the verdict and the numbers alone");
  add_options()("curves", po::bool_switch(&curves_),
                "put what the page draws into the JSON, too; --html implies it");
}

void ProblemCommand::add_strict() {
  add_options()("strict", po::bool_switch(&strict_), "exit code 4 if the verdict is negative");
}

void ProblemCommand::check(const po::variables_map& given) {
  if (given.count("date") != 0 && !parse_date(date_))
    fail("--date: '" + printable(date_) + "' is no date; accepted: as 2026-11-23");
}

int ProblemCommand::run_problem(Scope scope, bool closes_loop,
                                std::optional<double> time_limit_s) const {
  keep(input_);
  require_problem(input_);
  Problem problem = read_problem(input_, data_directory(data_));
  if (!date_.empty()) problem.about["evaluated"] = date_;
  if (time_limit_s) problem.trace.time_limit_s = time_limit_s;
  const Analysis analysis = [&] {
    StageLine line(!is_quiet());
    const std::vector<Profile> profiles = profiles_of(problem, ignore_checksum_, line);
    line.show("fitting the declared model");
    const bool with_curves = curves_ || !page().empty() || full_;
    return analyse(problem, profiles,
                   {.scope = scope,
                    .closes_loop = closes_loop,
                    .with_details = with_curves || wants_json(),
                    .with_curves = with_curves},
                   [&](const std::string& stage, double done) {
                     line.show("closing the loop: " + stage, done);
                   });
  }();
  report([&] { return text_report(analysis, {.full = full_, .page = page()}); },
         [&] { return json_report(analysis); }, [&] { return html_report(analysis); });
  return strict_ && is_negative(analysis) ? kNegativeVerdict : kDone;
}

}  // namespace slideway
