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
bool are_finite(std::span<const double> values) {
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
         request.value_column != nothing.value_column || !request.time_column.empty();
}

// `before` points came before these.
void check(std::span<const double> positions, std::span<const double> values, std::size_t before) {
  if (positions.size() != values.size())
    throw std::logic_error("a format gave " + std::to_string(positions.size()) + " positions and " +
                           std::to_string(values.size()) + " values");
  if (are_finite(positions) && are_finite(values)) return;
  const auto refuse = [&](std::size_t point, const char* what) {
    throw DataError("point " + std::to_string(before + point + 1) + what);
  };
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!std::isfinite(positions[i])) refuse(i, ": the position is no finite number");
    if (std::isinf(values[i])) refuse(i, ": the value is infinite");
  }
}

// Checks the points of a part, passes them on, and releases the pages of the file behind them.
class Passage {
 public:
  Passage(const FileBytes& bytes, const TakePoints& take) : bytes_(&bytes), take_(&take) {}

  void operator()(const TracePart& part) {
    constexpr std::size_t kForgotten = 1 << 23;  // bytes at a time
    check(part.positions, part.values, points_);
    (*take_)(part);
    points_ += part.positions.size();
    const double size = static_cast<double>(bytes_->text().size());
    const auto read = static_cast<std::size_t>(part.share * size);
    if (read < forgotten_ + kForgotten) return;
    bytes_->forget(forgotten_, read);
    forgotten_ = read;
  }

 private:
  const FileBytes* bytes_;
  const TakePoints* take_;
  std::size_t points_ = 0, forgotten_ = 0;
};

}  // namespace

const Format& recognised_format(std::string_view bytes) {
  const auto all = formats();
  return **std::find_if(all.begin(), all.end() - 1,
                        [&](const Format* format) { return format->recognises(bytes); });
}

StatedUnits Format::stated_units(std::string_view /*bytes*/,
                                 const TraceRequest& /*request*/) const {
  return {states_units(), states_units()};
}

StatedUnits stated_units(const std::filesystem::path& path, const TraceRequest& request) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return {};
  try {
    const FileBytes bytes = FileBytes::of_regular_file(path);
    return recognised_format(bytes.text()).stated_units(bytes.text(), request);
  } catch (const DataError&) {
    return {true, true};
  } catch (const UsageError&) {
    return {true, true};
  }
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

Trace Format::read_in_parts(std::string_view bytes, const TraceRequest& request,
                            const TakePoints& take) const {
  Trace trace = read(bytes, request);
  take({trace.position_unit, trace.value_unit, states_units(), trace.positions, trace.values, 1.0});
  trace.positions.clear();
  trace.values.clear();
  return trace;
}

TraceFile read_trace(const std::filesystem::path& path, const TraceRequest& request,
                     const TakePoints& take) {
  const FileBytes bytes = FileBytes::of_regular_file(path);
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
        file.trace = take ? format.read_in_parts(bytes.text(), request, Passage(bytes, take))
                          : format.read(bytes.text(), request);
      else
        file.sha256 = sha256(bytes);
    };
    if (bytes.text().size() < kLarge)
      work(0), work(1);
    else
      parallel_for(2, work);
    check(file.trace.positions, file.trace.values, 0);
    return file;
  } catch (const DataError& error) {
    throw DataError(path.string() + ": " + error.what());
  } catch (const UsageError& error) {
    throw UsageError(path.string() + ": " + error.what());
  }
}

}  // namespace slideway
