#include <sys/wait.h>

#include <memory>

#include "example.hpp"
#include "output.hpp"
#include "progress.hpp"
#include "report_command.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/file.hpp"
#include "slideway/report/report.hpp"
#include "slideway/trace/analysis.hpp"

namespace slideway {
namespace {
namespace po = boost::program_options;

/// @return whether the desktop's program for pages took it
bool has_shown(const std::string& page) {
  const pid_t child = show_page(page);
  int status = 0;
  return child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) &&
         WEXITSTATUS(status) == 0;
}

class DemoCommand : public Command {
 public:
  DemoCommand()
      : Command("demo", "[--out DIR] [--open]",
                "Runs the main job on an example, and writes its page") {
    add_options()("out", po::value(&out_)->value_name("DIR"),
                  "directory to write into; default slideway-demo");
    add_options()("open", po::bool_switch(&open_), "show the page with xdg-open");
  }

  int run() override {
    write_example();
    const std::filesystem::path page = folder() / "report.html";
    const Analysis analysis = analysed();
    write_file(folder() / "result.json", json_report(analysis));
    write_file(page, html_report(analysis));
    if (!is_quiet())
      print_report(text_report(analysis, {.page = page.string()}) +
                   "\nAn example: " + (folder() / "problem.toml").string() +
                   "\nYour own file: slideway init FILE.csv\n");
    if (open_ && !has_shown(page.string()))
      say("no program shows the page; open it in a browser: " + page.string());
    return kDone;
  }

 private:
  [[nodiscard]] std::filesystem::path folder() const { return out_; }

  /// A file of another content is not the example's, and stays.
  void write_example() const {
    for (const auto& [name, contents] : example_files()) {
      const std::filesystem::path path = folder() / name;
      std::error_code ignored;
      if (std::filesystem::exists(path, ignored) && FileBytes(path).text() != contents)
        throw UsageError("demo: " + path.string() +
                         " is there and is not the example's; accepted: --out with another DIR");
    }
    make_directory(folder());
    for (const auto& [name, contents] : example_files()) write_file(folder() / name, contents);
  }

  [[nodiscard]] Analysis analysed() const {
    const Problem problem = read_problem(folder() / example_files().front().first);
    StageLine line(!is_quiet());
    line.show("fitting the declared model");
    return analyse(problem, read_profiles(problem), {.with_details = true, .with_curves = true},
                   [&](const std::string& stage, double done) {
                     line.show("closing the loop: " + stage, done);
                   });
  }

  std::string out_ = "slideway-demo";
  bool open_ = false;
};

}  // namespace

std::unique_ptr<Command> make_demo() { return std::make_unique<DemoCommand>(); }

}  // namespace slideway
