#include "answer.hpp"

#include <cmath>
#include <functional>
#include <regex>
#include <sstream>

#include "slideway/report/certificate.hpp"
#include "slideway/report/comparison.hpp"
#include "slideway/report/compensation.hpp"
#include "slideway/report/document.hpp"
#include "slideway/report/layout.hpp"
#include "slideway/report/report.hpp"
#include "slideway/report/residual_table.hpp"
#include "slideway/trace/analysis_fields.hpp"

namespace slideway {
namespace {

using Breaches = std::vector<std::string>;

/// Walks through all numbers of a report.
class NumberWalk {
 public:
  explicit NumberWalk(Breaches& faults) : faults_(faults) {}

  template <Recorded T>
  void walk(const T& object, const std::string& place) {
    if constexpr (std::is_base_of_v<QuantityValue, T>) check(object, place);
    for_each_field<T>([&](const auto& field) {
      walk(std::invoke(field.access, object), place + "." + std::string(field.key));
    });
  }

 private:
  void check(const QuantityValue& quantity, const std::string& place) {
    const std::optional<double>& expanded = quantity.expanded_uncertainty;
    if (quantity.value && expanded && !(*expanded > 0.0))
      faults_.push_back(place + ": U = " + shortest(*expanded));
  }
  void walk(double number, const std::string& place) {
    if (!std::isfinite(number)) faults_.push_back(place + " = " + shortest(number));
  }
  void walk(const std::string& text, const std::string& place) {
    if (text.find("is not a finite number and is left out") != std::string::npos)
      faults_.push_back(place + ": " + text);
  }
  void walk(const std::pair<std::string, double>& entry, const std::string& place) {
    walk(entry.second, place + "." + entry.first);
  }
  void walk(const ParameterCorrelation& pair, const std::string& place) {
    walk(std::get<double>(pair), place);
  }
  template <typename T>
  void walk(const std::optional<T>& value, const std::string& place) {
    if (value) walk(*value, place);
  }
  template <typename T>
  void walk(const std::vector<T>& values, const std::string& place) {
    for (std::size_t i = 0; i < values.size(); ++i)
      walk(values[i], place + "[" + std::to_string(i) + "]");
  }
  template <typename T>
  requires(!Recorded<T>) void walk(const T& /*no number*/, const std::string& /*place*/) {}

  Breaches& faults_;
};

void check_text(const std::string& what, const std::string& text, Breaches& faults) {
  static const std::regex kNoNumber(R"((^|[^\w"'.-])-?(nan|inf)([^\w"'.-]|$))");
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const bool is_to_paste = line.find("formula = \"") != std::string::npos;
    if (code_points(line) > kLineWidth && !is_to_paste)
      faults.push_back(what + ", a long line: " + line);
    if (std::regex_search(line, kNoNumber)) faults.push_back(what + ", no number: " + line);
  }
}

void check_read_back(const std::string& json, Breaches& faults) {
  if (json_report(parse_report(json, "json")) != json) faults.emplace_back("reads back otherwise");
}

}  // namespace

Answer answer_to(const ProblemFiles& files, const AnalysisOptions& options) {
  Answer out;
  const auto refused = [&](const std::exception& error) {
    out.refusal = error.what();
    require_line(out.refusal);
  };
  try {
    const Problem problem = read_problem(files.path());
    out.analysis = analyse(problem, read_profiles(problem), options);
  } catch (const UsageError& error) {
    refused(error);
  } catch (const DataError& error) {
    refused(error);
  }
  return out;
}

Breaches faults_of_outputs(const Analysis& analysis) {
  Breaches faults;
  const NamedReport report{"a", analysis};
  const std::vector<std::function<void()>> outputs{
      [&] { check_text("text", text_report(analysis), faults); },
      [&] { check_text("full text", text_report(analysis, {.full = true, .page = ""}), faults); },
      [&] { check_read_back(json_report(analysis), faults); },
      [&] { static_cast<void>(html_report(analysis)); },
      [&] { static_cast<void>(html_report(json_report(analysis), "json")); },
      [&] { static_cast<void>(svg_report(analysis)); },
      [&] { check_text("diff", comparison_text(report, report), faults); },
      [&] { static_cast<void>(comparison_json(report, report)); },
      [&] { static_cast<void>(residual_table(analysis, "drawn")); },
      [&] { static_cast<void>(calibration_certificate(analysis)); }};
  for (const auto& output : outputs) ends_well(output);
  for (const std::string& format : compensation_formats())
    ends_well([&] {
      const Compensation table = compensation(analysis);
      static_cast<void>(compensation_table(table, format, "drawn"));
      static_cast<void>(compensation_notes(table, format, "drawn"));
    });
  return faults;
}

Breaches faults_of(const Analysis& analysis) {
  Breaches faults = faults_of_outputs(analysis);
  NumberWalk(faults).walk(analysis, "report");
  return faults;
}

}  // namespace slideway
