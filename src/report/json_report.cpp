#include "json_parts.hpp"
#include "json_writer.hpp"
#include "slideway/report/report.hpp"
#include "slideway/trace/analysis_fields.hpp"

namespace slideway {

/// The part of a report that is known before anything is fitted.
struct DataReport {
  std::string schema = "slideway.data/1";
  const Result* result = nullptr;
};

template <auto member>
inline constexpr auto kOfData = [](auto& data) -> auto& {
  return data.result->*member;
};

template <>
inline constexpr auto kRecord<DataReport> =
    record("DataReport", "What the profiles are.", field("schema", &DataReport::schema),
           field("version", kOfData<&Result::version>), field("title", kOfData<&Result::title>),
           field("about", kOfData<&Result::about>), field("assumed", kOfData<&Result::assumed>),
           field("inputs", kOfData<&Result::inputs>), field("low_band", kOfData<&Result::low_band>),
           field("closure", kOfData<&Result::closure>));

namespace {

template <Recorded T>
std::string written(const T& object, JsonWriter::Layout layout) {
  JsonWriter writer(layout);
  writer.write(object);
  return writer.take();
}

}  // namespace

std::string laid_out(const Json& document) {
  return document.dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string data_json(const Result& result) {
  return written(DataReport{.result = &result}, JsonWriter::Layout::indented) + "\n";
}

std::string json_report(const Analysis& analysis) {
  return written(analysis, JsonWriter::Layout::indented) + "\n";
}

std::string json_line(const Analysis& analysis) {
  return written(analysis, JsonWriter::Layout::one_line);
}

}  // namespace slideway
