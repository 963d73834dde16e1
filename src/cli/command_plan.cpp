#include <algorithm>
#include <memory>

#include "environment.hpp"
#include "output.hpp"
#include "report_command.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/file.hpp"
#include "slideway/report/plan_report.hpp"
#include "slideway/trace/plan.hpp"

namespace slideway {
namespace {
namespace po = boost::program_options;

class PlanCommand : public ReportCommand {
 public:
  PlanCommand()
      : ReportCommand("plan", "PROBLEM [options]",
                      "Tries further cuts on paper: what each one would bring") {
    add_input("PROBLEM", &input_);
    add_html();
    add_options()("out", po::value(&out_)->value_name("DIR"),
                  "write problem files with the best cut, pair and three cuts added");
    add_options()("data", po::value(&data_)->value_name("DIR"),
                  "what ${SLIDEWAY_DATA} in the problem file stands for");
  }

  int run() override {
    keep(input_);
    const Problem problem = read_problem(input_, data_directory(data_));
    require_measured(problem);
    std::vector<CutToCome> cuts;
    const Plan plan = [&] {
      StageLine line(!is_quiet());
      const std::vector<Profile> profiles = profiles_of(problem, false, line);
      cuts = cuts_to_come(problem, profiles);
      return plan_cuts(problem, profiles, cuts,
                       [&](const std::string& stage, double done) { line.show(stage, done); });
    }();
    if (!out_.empty()) write_problems(problem, cuts, plan);
    report([&] { return plan_text(plan); }, [&] { return plan_json(plan); },
           [&] { return plan_page(plan); });
    return kDone;
  }

 private:
  /// The noise of a cut to come is that of the profiles there are.
  static void require_measured(const Problem& problem) {
    std::error_code ignored;
    for (const ProfileEntry& entry : problem.profiles)
      if (problem.truth && !std::filesystem::exists(entry.source.path, ignored))
        throw UsageError(problem.path.string() + ": plan needs measured profiles, and '" +
                         entry.profile.name + "' has no file yet; accepted: slideway simulate " +
                         problem.path.string() + " --out DIR, then DIR/problem.toml");
  }

  void write_problems(const Problem& problem, const std::vector<CutToCome>& cuts,
                      const Plan& plan) const {
    std::vector<const PlannedDesign*> best{&plan.alone.front()};
    for (const PlannedDesign& set : plan.sets)
      if (set.cuts.size() > best.back()->cuts.size()) best.push_back(&set);
    make_directory(out_);
    for (const PlannedDesign* design : best) {
      const std::filesystem::path file =
          std::filesystem::path(out_) / (std::to_string(design->cuts.size()) +
                                         (design->cuts.size() == 1 ? "-cut" : "-cuts") + ".toml");
      for (const std::filesystem::path& input : files_of(problem)) keep_input(input, file);
      keep_apart(file);
      std::vector<CutToCome> chosen;
      for (const CutToCome& cut : cuts)
        if (std::ranges::count(design->cuts, cut.profile.name) > 0) chosen.push_back(cut);
      write_file(file, planned_problem_text(problem, chosen, out_));
    }
  }

  std::string input_, out_, data_;
};

}  // namespace

std::unique_ptr<Command> make_plan() { return std::make_unique<PlanCommand>(); }

}  // namespace slideway
