#include "slideway/format/format.hpp"

#include <algorithm>
#include <cmath>

#include "registry.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/file.hpp"
#include "slideway/base/text.hpp"

namespace slideway {
namespace {

bool speaks_of_text(const TraceRequest& request) {
  const TraceRequest nothing;
  return !request.delimiter.empty() || !request.decimal.empty() || !request.encoding.empty() ||
         request.header_lines || request.position_column != nothing.position_column ||
         request.value_column != nothing.value_column;
}

void check(const Trace& trace) {
  if (trace.positions.size() != trace.values.size())
    throw std::logic_error("a format gave " + std::to_string(trace.positions.size()) +
                           " positions and " + std::to_string(trace.values.size()) + " values");
  const auto is_number = [](double position) { return std::isfinite(position); };
  const auto odd = std::find_if_not(trace.positions.begin(), trace.positions.end(), is_number);
  if (odd != trace.positions.end())
    throw DataError("point " + std::to_string(odd - trace.positions.begin() + 1) +
                    ": the position is no finite number");
  const auto infinite = std::find_if(trace.values.begin(), trace.values.end(),
                                     [](double value) { return std::isinf(value); });
  if (infinite != trace.values.end())
    throw DataError("point " + std::to_string(infinite - trace.values.begin() + 1) +
                    ": the value is infinite");
}

}  // namespace

const Format& recognised_format(std::string_view bytes) {
  const auto all = formats();
  return **std::find_if(all.begin(), all.end() - 1,
                        [&](const Format* format) { return format->recognises(bytes); });
}

const Format& format_to_write(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  for (char& c : ending)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  std::vector<std::string> accepted;
  for (const Format* format : formats()) {
    if (!format->is_writable()) continue;
    for (const std::string_view known : format->endings()) {
      if (known == ending) return *format;
      accepted.emplace_back(known);
    }
  }
  throw UsageError(path.string() + ": the ending '" + printable(ending) +
                   "' is of no format that can be written; accepted: " + joined(accepted, " "));
}

TraceFile read_trace(const std::filesystem::path& path, const TraceRequest& request) {
  const FileBytes bytes(path);
  try {
    if (bytes.text().empty()) throw DataError("is empty");
    const Format& format = recognised_format(bytes.text());
    if (&format != &text_format() && speaks_of_text(request))
      throw UsageError("is " + std::string(format.name()) +
                       "; columns, delimiter, decimal, encoding and header_lines belong to "
                       "delimited text");
    TraceFile file{std::string(format.name()), format.states_units(), sha256(bytes.text()),
                   format.read(bytes.text(), request)};
    check(file.trace);
    return file;
  } catch (const DataError& error) {
    throw DataError(path.string() + ": " + error.what());
  } catch (const UsageError& error) {
    throw UsageError(path.string() + ": " + error.what());
  }
}

}  // namespace slideway
