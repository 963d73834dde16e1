#include <algorithm>
#include <array>
#include <cmath>

#include "append.hpp"
#include "registry.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/format/table.hpp"

namespace slideway {
namespace {

class TextFormat : public Format {
 public:
  [[nodiscard]] std::string_view name() const override { return "text"; }
  [[nodiscard]] std::span<const std::string_view> endings() const override {
    static constexpr std::array<std::string_view, 3> kEndings{".csv", ".txt", ".dat"};
    return kEndings;
  }
  [[nodiscard]] bool states_units() const override { return false; }

  [[nodiscard]] StatedUnits stated_units(std::string_view bytes,
                                         const TraceRequest& request) const override;

  [[nodiscard]] bool recognises(std::string_view bytes) const override {
    const auto all = formats();
    return std::none_of(all.begin(), all.end(), [&](const Format* format) {
      return format != this && format->recognises(bytes);
    });
  }

  [[nodiscard]] Trace read(std::string_view bytes, const TraceRequest& request) const override;
  [[nodiscard]] Trace read_in_parts(std::string_view bytes, const TraceRequest& request,
                                    const TakePoints& take) const override;
  [[nodiscard]] std::string write(const Trace& trace) const override;
};

TableRequest columns_of(const TraceRequest& request) {
  return {.columns = {request.position_column, request.value_column},
          .delimiter = request.delimiter,
          .decimal = request.decimal,
          .encoding = request.encoding,
          .header_lines = request.header_lines,
          .may_miss = true,
          .clocks = request.positions_are_times ? std::vector<std::size_t>{0}
                                                : std::vector<std::size_t>{}};
}

StatedUnits TextFormat::stated_units(std::string_view bytes, const TraceRequest& request) const {
  const TableHead head = parse_head(bytes, columns_of(request));
  return {!head.requested_units[0].empty(), !head.requested_units[1].empty()};
}

Trace TextFormat::read(std::string_view bytes, const TraceRequest& request) const {
  std::vector<double> positions, values, times;
  Trace trace = read_in_parts(bytes, request, [&](const TracePart& part) {
    append(part.positions, part.share, positions);
    append(part.values, part.share, values);
    append(part.times, part.share, times);
  });
  trace.positions = std::move(positions);
  trace.values = std::move(values);
  trace.times = std::move(times);
  return trace;
}

Trace TextFormat::read_in_parts(std::string_view bytes, const TraceRequest& request,
                                const TakePoints& take) const {
  if (!request.line.empty())
    throw UsageError("line = \"" + printable(request.line) +
                     "\" belongs to an areal file; delimited text has columns");
  TableRequest columns = columns_of(request);
  const bool timed = !request.time_column.empty();
  if (timed) {
    columns.clocks.push_back(columns.columns.size());
    columns.columns.push_back(request.time_column);
  }
  Table table = parse_table(bytes, columns, [&](const TablePart& part) {
    TracePart points{part.table.units[0], part.table.units[1], false,
                     part.columns[0],     part.columns[1],     part.share};
    if (timed) points.times = part.columns[2], points.time_unit = part.table.units[2];
    take(points);
  });
  return {{}, {}, std::move(table.units[0]), std::move(table.units[1]), std::move(table.decisions)};
}

std::string TextFormat::write(const Trace& trace) const {
  if (trace.positions.empty()) throw UsageError("a trace without points cannot be written");
  const auto name = [](const std::string& letter, const std::string& unit) {
    return unit.empty() ? letter : letter + "_" + unit;
  };
  std::string text = name("x", trace.position_unit) + "," + name("z", trace.value_unit) + "\n";
  text.reserve(trace.positions.size() * 32);
  for (std::size_t i = 0; i < trace.positions.size(); ++i) {
    if (!std::isfinite(trace.positions[i]) || std::isinf(trace.values[i]))
      throw UsageError("point " + std::to_string(i + 1) + " is no finite number");
    text += shortest(trace.positions[i]);
    text += ',';
    if (!std::isnan(trace.values[i])) text += shortest(trace.values[i]);
    text += '\n';
  }
  return text;
}

}  // namespace

const Format& text_format() {
  static const TextFormat kFormat;
  return kFormat;
}

}  // namespace slideway
