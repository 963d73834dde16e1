#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "environment.hpp"
#include "output.hpp"
#include "progress.hpp"
#include "report_command.hpp"
#include "slideway/base/text.hpp"
#include "slideway/profile/outliers.hpp"
#include "slideway/report/layout.hpp"
#include "slideway/report/picture.hpp"
#include "slideway/report/report.hpp"
#include "trace_arguments.hpp"

namespace slideway {
namespace {

using Json = nlohmann::ordered_json;

/// In the file's own units.
struct Summary {
  std::size_t missing = 0;
  double first = 0.0, last = 0.0;                      // position of the first and the last point
  double low = INFINITY, high = -INFINITY, rms = 0.0;  // of the values, rms about their mean
  double step_low = 0.0, step_high = 0.0;
  [[nodiscard]] bool has_values() const { return low <= high; }
};

Summary summarise(const Trace& trace) {
  Summary out;
  double mean = 0.0, squares = 0.0, count = 0.0;
  for (const double value : trace.values) {
    if (std::isnan(value)) {
      ++out.missing;
      continue;
    }
    out.low = std::min(out.low, value);
    out.high = std::max(out.high, value);
    count += 1.0;
    const double change = value - mean;  // Welford
    mean += change / count;
    squares += change * (value - mean);
  }
  if (count > 0.0) out.rms = std::sqrt(squares / count);
  if (trace.positions.empty()) return out;
  out.first = trace.positions.front();
  out.last = trace.positions.back();
  for (std::size_t i = 1; i < trace.positions.size(); ++i) {
    const double step = trace.positions[i] - trace.positions[i - 1];
    out.step_low = i == 1 ? step : std::min(out.step_low, step);
    out.step_high = i == 1 ? step : std::max(out.step_high, step);
  }
  return out;
}

// By data row, from 1, in the file's units; none where the positions turn back.
std::vector<Outlier> outlier_rows(const Trace& trace) {
  std::vector<double> positions, values;
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < trace.values.size(); ++i) {
    if (std::isnan(trace.values[i])) continue;
    positions.push_back(trace.positions[i]);
    values.push_back(trace.values[i]);
    rows.push_back(i + 1);
  }
  if (positions.size() > 1 && positions[1] < positions[0])
    for (double& position : positions) position = -position;
  if (std::ranges::adjacent_find(positions, std::greater_equal<>()) != positions.end()) return {};
  std::vector<Outlier> outliers = find_outliers(positions, values);
  for (Outlier& each : outliers) each.index = rows[each.index];
  return outliers;
}

class InfoCommand : public ReportCommand {
 public:
  InfoCommand()
      : ReportCommand("info", "FILE | PROBLEM.toml [options]",
                      "Shows what a profile file holds, or all of a problem") {
    add_input("FILE", &input_);
    arguments_.add_to(add_options());
    add_options()("data", boost::program_options::value(&data_)->value_name("DIR"),
                  "PROBLEM.toml: what ${SLIDEWAY_DATA} in it stands for");
  }

  int run() override {
    keep(input_);
    if (is_problem()) return run_problem();
    TraceFile file = read_trace(input_, request_);
    if (file.trace.areal) {
      report([&] { return areal_text(file); }, [&] { return areal_json(file); });
      return kDone;
    }
    arguments_.add_units(file);
    const Summary summary = summarise(file.trace);
    outliers_ = outlier_rows(file.trace);
    report([&] { return text(file, summary); }, [&] { return json(file, summary); });
    return kDone;
  }

 private:
  [[nodiscard]] bool is_problem() const {
    return std::filesystem::path(input_).extension() == ".toml";
  }

  void check(const boost::program_options::variables_map& given) override {
    if (given.count("data") != 0 && !is_problem()) fail("--data belongs to a PROBLEM.toml");
    for (const char* option : {"position", "value", "position-unit", "value-unit", "delimiter",
                               "decimal", "encoding", "header-lines", "line"})
      if (is_problem() && given.count(option) != 0)
        fail(std::string("--") + option + " belongs to a FILE; a problem file has keys for it");
    request_ = arguments_.checked();
    request_.areal_without_line = true;
  }

  [[nodiscard]] int run_problem() const {
    const Problem problem = read_profiles_of_problem(input_, data_directory(data_));
    const Result result = [&] {
      StageLine line(!is_quiet());
      return summarise_data(problem, profiles_of(problem, request_.ignore_checksum, line));
    }();
    report([&] { return data_text(result); }, [&] { return data_json(result); });
    return kDone;
  }

  using Lines = std::vector<std::pair<std::string, std::string>>;

  [[nodiscard]] std::string laid_out(const Lines& lines) const {
    std::string out = printable(input_, input_.size()) + "\n";
    for (const auto& [label, value] : lines)
      out += paragraph("  " + label + std::string(11 - label.size(), ' '), value);
    return out;
  }

  [[nodiscard]] std::string areal_text(const TraceFile& file) const {
    const Areal& areal = *file.trace.areal;
    const std::size_t rows = areal.y.size(), columns = areal.x.size();
    const auto axis = [&](const std::vector<double>& at) {
      std::string text = significant(at.front(), 7) + " to " + significant(at.back(), 7) + " " +
                         file.trace.position_unit;
      if (at.size() > 1)
        text += ", " +
                significant((at.back() - at.front()) / static_cast<double>(at.size() - 1), 4) +
                " apart";
      return text;
    };
    Lines lines{{"format", file.format},
                {"sha256", file.sha256},
                {"points", std::to_string(rows * columns) + " in " + std::to_string(rows) +
                               " rows of " + std::to_string(columns)},
                {"missing", std::to_string(areal.missing)},
                {"x", axis(areal.x)},
                {"y", axis(areal.y)}};
    if (areal.heights)
      lines.emplace_back("values", significant(areal.heights->first, 7) + " to " +
                                       significant(areal.heights->second, 7) + " " +
                                       file.trace.value_unit);
    for (const std::string& decision : file.trace.decisions)
      lines.emplace_back("taken as", decision);
    lines.emplace_back("a profile",
                       "is one line of it: --line row:1 to row:" + std::to_string(rows) +
                           ", column:1 to column:" + std::to_string(columns) +
                           " or diameter:DEGREES; in a problem line = \"row:1\"");
    return laid_out(lines);
  }

  [[nodiscard]] std::string areal_json(const TraceFile& file) const {
    const Areal& areal = *file.trace.areal;
    Json document = head_of(file, areal.x.size() * areal.y.size(), areal.missing);
    document["rows"] = areal.y.size();
    document["columns"] = areal.x.size();
    document["x_first"] = areal.x.front();
    document["x_last"] = areal.x.back();
    document["y_first"] = areal.y.front();
    document["y_last"] = areal.y.back();
    document["value_min"] = areal.heights ? Json(areal.heights->first) : Json();
    document["value_max"] = areal.heights ? Json(areal.heights->second) : Json();
    document["decisions"] = file.trace.decisions;
    return document_text(document);
  }

  [[nodiscard]] std::string text(const TraceFile& file, const Summary& summary) const {
    const Trace& trace = file.trace;
    const auto unit = [](const std::string& name) {
      return name.empty() ? std::string(" (unit not stated)") : " " + name;
    };
    const auto range = [](double from, double to, int digits) {
      return significant(from, digits) + " to " + significant(to, digits);
    };
    Lines lines{{"format", file.format},
                {"sha256", file.sha256},
                {"points", std::to_string(trace.positions.size())},
                {"missing", std::to_string(summary.missing)},
                {"positions", range(summary.first, summary.last, 7) + unit(trace.position_unit)}};
    if (trace.positions.size() > 1)
      lines.emplace_back("step",
                         (significant(summary.step_low, 4) == significant(summary.step_high, 4)
                              ? significant(summary.step_low, 4)
                              : range(summary.step_low, summary.step_high, 4)) +
                             unit(trace.position_unit));
    if (summary.has_values()) {
      lines.emplace_back("values", range(summary.low, summary.high, 7) + unit(trace.value_unit));
      lines.emplace_back("rms", significant(summary.rms, 4) + unit(trace.value_unit));
      lines.emplace_back("p-v",
                         significant(summary.high - summary.low, 4) + unit(trace.value_unit));
    }
    constexpr std::size_t kListed = 20;
    for (std::size_t i = 0; i < std::min(outliers_.size(), kListed); ++i) {
      const Outlier& each = outliers_[i];
      lines.emplace_back(
          i == 0 ? "spikes" : "",
          "data row " + std::to_string(each.index) + ": " + significant(each.value, 7) +
              ", neighbours say " + significant(each.expected, 7) +
              (each.kind == OutlierKind::lost_minus_sign ? " (lost minus sign)" : ""));
    }
    if (outliers_.size() > kListed)
      lines.emplace_back("", "and " + std::to_string(outliers_.size() - kListed) + " more");
    for (const std::string& decision : trace.decisions) lines.emplace_back("taken as", decision);
    const std::string out = laid_out(lines);
    return summary.has_values() ? out + "\n" + picture(trace.positions, trace.values) : out;
  }

  [[nodiscard]] Json head_of(const TraceFile& file, std::size_t points, std::size_t missing) const {
    const auto unit = [](const std::string& name) { return name.empty() ? Json() : Json(name); };
    return {{"schema", "slideway.info/1"},
            {"file", printable(input_, input_.size())},
            {"format", file.format},
            {"sha256", file.sha256},
            {"points", points},
            {"missing", missing},
            {"position_unit", unit(file.trace.position_unit)},
            {"value_unit", unit(file.trace.value_unit)}};
  }

  [[nodiscard]] std::string json(const TraceFile& file, const Summary& summary) const {
    const Trace& trace = file.trace;
    const auto or_null = [](bool known, const auto& value) { return known ? Json(value) : Json(); };
    const bool values = summary.has_values(), steps = trace.positions.size() > 1;
    Json outliers = Json::array();
    for (const Outlier& each : outliers_)
      outliers.push_back({{"row", each.index},
                          {"value", each.value},
                          {"expected", each.expected},
                          {"unit", or_null(!trace.value_unit.empty(), trace.value_unit)},
                          {"kind", slideway::name(each.kind)}});
    Json document = head_of(file, trace.positions.size(), summary.missing);
    document["position_first"] = summary.first;
    document["position_last"] = summary.last;
    document["step_min"] = or_null(steps, summary.step_low);
    document["step_max"] = or_null(steps, summary.step_high);
    document["value_min"] = or_null(values, summary.low);
    document["value_max"] = or_null(values, summary.high);
    document["rms"] = or_null(values, summary.rms);
    document["pv"] = or_null(values, summary.high - summary.low);
    document["outliers"] = outliers;
    document["decisions"] = trace.decisions;
    return document_text(document);
  }

  std::string input_, data_;
  TraceArguments arguments_;
  TraceRequest request_;
  std::vector<Outlier> outliers_;
};

}  // namespace

std::unique_ptr<Command> make_info() { return std::make_unique<InfoCommand>(); }

}  // namespace slideway
