#include "slideway/report/document.hpp"

#include <algorithm>

#include "json_reader.hpp"
#include "slideway/base/file.hpp"
#include "slideway/trace/analysis_fields.hpp"

namespace slideway {

namespace {

constexpr int kDeepest = 32;  // levels of brackets; a report has 8
constexpr const char* kAccepted = "a report of slideway (--json FILE)";

}  // namespace

Json parse_document(std::string_view text, std::initializer_list<std::string_view> schemas) {
  const auto shallow = [](int depth, Json::parse_event_t, const Json&) {
    if (depth > kDeepest)
      throw DataError("brackets more than " + std::to_string(kDeepest) +
                      " deep; accepted: " + kAccepted);
    return true;
  };
  Json json = [&] {
    try {
      return Json::parse(text, shallow);
    } catch (const Json::exception& error) {
      throw DataError("is no JSON (" + printable(error.what(), 120) + "); accepted: " + kAccepted);
    }
  }();
  std::vector<std::string> accepted;
  for (const std::string_view each : schemas) accepted.push_back('"' + std::string(each) + '"');
  const std::string known = joined(accepted, " or ") + ", as --json FILE of slideway writes it";
  const Node schema = Node(json)["schema"];
  if (schema.is_null()) schema.fail(known);
  if (std::ranges::find(schemas, schema.verbatim()) == schemas.end())
    throw DataError("schema: is \"" + printable(schema.verbatim(), 40) + "\"; accepted: " + known);
  return json;
}

Analysis parse_report(std::string_view text, const std::string& name) {
  return read_document(text, name, {kReportSchema}, [](const Node& report) {
    Analysis out;
    read(report, out);
    return out;
  });
}

Analysis read_report(const std::filesystem::path& path) {
  return parse_report(FileBytes::of_file_or_stdin(path).text(), path.string());
}

}  // namespace slideway
