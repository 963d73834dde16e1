#include "slideway/format/format.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "registry.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/file.hpp"
#include "slideway/base/parallel.hpp"
#include "slideway/base/text.hpp"

namespace slideway {
namespace {

constexpr std::size_t kLarge = 1 << 20;  // bytes that are worth a second thread

// Whether none of the numbers is NaN or infinite: their exponent is not all ones.
bool are_finite(const std::vector<double>& values) {
  constexpr std::uint64_t kExponent = 0x7ff0000000000000U, kLeast = 0x0010000000000000U;
  std::uint64_t carried = 0;
  for (const double value : values)
    carried |= (std::bit_cast<std::uint64_t>(value) & kExponent) + kLeast;
  return carried >> 63U == 0;
}

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
  if (are_finite(trace.positions) && are_finite(trace.values)) return;
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
    TraceFile file{std::string(format.name()), format.states_units(), {}, {}};
    const auto work = [&](std::size_t part) {
      if (part == 0)
        file.trace = format.read(bytes.text(), request);
      else
        file.sha256 = sha256(bytes.text());
    };
    if (bytes.text().size() < kLarge)
      work(0), work(1);
    else
      parallel_for(2, work);
    check(file.trace);
    return file;
  } catch (const DataError& error) {
    throw DataError(path.string() + ": " + error.what());
  } catch (const UsageError& error) {
    throw UsageError(path.string() + ": " + error.what());
  }
}

}  // namespace slideway
