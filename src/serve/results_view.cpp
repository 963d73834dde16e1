#include "results_view.hpp"

#include <algorithm>
#include <chrono>

#include "http_server.hpp"
#include "json_text.hpp"
#include "slideway/base/error.hpp"
#include "slideway/batch/pool.hpp"
#include "slideway/batch/results.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/report/comparison.hpp"
#include "slideway/report/compensation.hpp"
#include "slideway/report/document.hpp"
#include "slideway/report/report.hpp"

namespace slideway {
namespace fs = std::filesystem;
namespace {

using ViewJson = nlohmann::ordered_json;

constexpr std::size_t kMostRows = 10'000;

/// What stands at a path of keys; null where there is nothing.
ViewJson part(const ViewJson& document, const char* path) {
  const ViewJson::json_pointer pointer(path);
  return document.contains(pointer) ? document.at(pointer) : ViewJson();
}

ViewJson plain_names(ViewJson effects) {
  for (ViewJson& name : effects)
    if (name.is_string()) name = plain_name(name.get<std::string>());
  return effects;
}

/// What a report says first. Numbers as they stand; null where it has none.
ViewJson brief(const ViewJson& report) {
  ViewJson out{{"title", part(report, "/title")},
               {"machine", part(report, "/about/machine")},
               {"verdict", part(report, "/trace/verdict")},
               {"effects", plain_names(part(report, "/final/effects"))},
               {"rms_um", part(report, "/final/rms_um")},
               {"straightness_um", part(report, "/final/straightness/end_point_um")},
               {"straightness_U_um", part(report, "/final/straightness/expanded_uncertainty_um")},
               {"squareness_rad", part(report, "/crosscheck/squareness/fit_rad")},
               {"squareness_U_rad", part(report, "/crosscheck/squareness/fit_U_rad")}};
  return out;
}

ViewJson brief_of_run(const fs::path& run) {
  const fs::path result = run / run_file::kResult;
  if (!is_plain_file(result)) return ViewJson::object();
  const ViewJson report = ViewJson::parse(bytes_of(result), nullptr, false);
  return report.is_object() ? brief(report) : ViewJson::object();
}

double seconds_of(const fs::path& path) {
  std::error_code ignored;
  const auto time = std::chrono::file_clock::to_sys(fs::last_write_time(path, ignored));
  return std::chrono::duration<double>(time.time_since_epoch()).count();
}

/// What the items of each machine say together; a sentence where they say nothing.
ViewJson machines_of(const fs::path& results) try {
  const PooledResults pooled = pool_machines(results);
  return ViewJson::parse(pooled_json(pooled.machines, pooled.are_dates));
} catch (const DataError& error) {
  return error.what();
}

Analysis analysis_of(const fs::path& run) {
  return parse_report(bytes_of(run / run_file::kResult),
                      run.filename().string() + "/" + run_file::kResult);
}

}  // namespace

ResultsView::Json ResultsView::brief_of(const fs::path& run) {
  std::error_code ignored;
  const fs::file_time_type time = fs::last_write_time(run / run_file::kResult, ignored);
  const std::lock_guard lock(mutex_);
  auto& [then, what] = known_[run];
  if (what.is_null() || then != time) {
    then = time;
    what = brief_of_run(run);
  }
  return what;
}

std::string ResultsView::list() {
  ViewJson runs = ViewJson::array();
  for (const std::string& name : workspace_.runs()) {
    const fs::path run = workspace_.run(name);
    ViewJson one{{"name", name}, {"seconds", seconds_of(run)}};
    for (const char* file : {run_file::kProblem, run_file::kResult, run_file::kPage})
      one[file] = is_plain_file(run / file);
    one.update(brief_of(run));
    runs.push_back(one);
  }
  return json_text({{"folder", workspace_.folder().filename().string()},
                    {"runs", runs},
                    {"batches", workspace_.batches()}});
}

std::string ResultsView::difference(const std::string& a, const std::string& b) {
  const fs::path first = workspace_.run(a), second = workspace_.run(b);
  ViewJson out{{"a", brief_of(first)}, {"b", brief_of(second)}};
  out["diff"] = ViewJson::parse(comparison_json({a, analysis_of(first)}, {b, analysis_of(second)}));
  return json_text(out);
}

std::string ResultsView::table(const std::string& run, const std::string& format) const {
  check_compensation_format(format);
  const Analysis analysis = analysis_of(workspace_.run(run));
  const std::string source = "slideway " + analysis.result.version + ", " + run + "/" +
                             run_file::kResult + ": " + analysis.result.title;
  return compensation_table(compensation(analysis), format, source);
}

std::string ResultsView::batch_rows(const std::string& name) const {
  std::vector<ViewJson> rows;
  std::size_t lines = 0;
  const fs::path path = workspace_.batch(name);
  const std::size_t torn = read_results(path, [&](const ResultHead& head, std::string_view line) {
    if (++lines > kMostRows) return;
    ViewJson row{{"id", head.id}, {"status", head.status}, {"reason", head.reason}};
    const ViewJson whole = ViewJson::parse(line, nullptr, false);
    row["has_report"] = part(whole, "/report").is_object();
    if (row["has_report"]) row.update(brief(whole["report"]));
    if (!head.machine.empty()) row["machine"] = head.machine;
    row["time"] = head.time;
    rows.push_back(row);
  });
  std::ranges::stable_sort(rows, {}, [](const ViewJson& row) { return row.value("machine", ""); });
  return json_text(
      {{"rows", rows}, {"machines", machines_of(path)}, {"lines", lines}, {"torn", torn}});
}

std::string ResultsView::batch_page(const std::string& name, const std::string& id) const {
  std::string report;
  read_results(workspace_.batch(name), [&](const ResultHead& head, std::string_view line) {
    if (head.id != id || !report.empty()) return;
    const ViewJson whole = ViewJson::parse(line, nullptr, false);
    if (part(whole, "/report").is_object()) report = json_text(whole["report"]);
  });
  if (report.empty()) throw HttpFailure(404, "no report of that item");
  return html_report(report, name);
}

}  // namespace slideway
