#include <array>
#include <optional>

#include "areal.hpp"
#include "numbers.hpp"
#include "registry.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"
#include "writable.hpp"

// PRF (text of Taylor Hobson, as NPL documents it): "1 2", name and type, the axes CX and CZ with
// count, unit and scale, EOR; the spacing and more, EOR; heights to be multiplied by the scale of
// CZ, EOR; EOF.
namespace slideway {
namespace {

constexpr std::array<std::array<std::string_view, 2>, 4> kUnits{
    {{"MM", "mm"}, {"UM", "um"}, {"NM", "nm"}, {"M", "m"}}};

struct PrfAxis {
  std::size_t count = 0;
  std::string unit;
  double scale = 0.0;
};

PrfAxis read_prf_axis(std::string_view line, const std::string& name) {
  const std::vector<std::string_view> fields = words(line.substr(0, 400));
  if (fields.size() < 6 || fields[0] != name || fields[1] != "M" || fields[5].size() != 1 ||
      fields[5].find_first_of("ILFD") != 0)
    throw DataError(name + ": '" + printable(line) + "'; accepted: " + name +
                    " M COUNT UNIT SCALE TYPE (I L F D)");
  PrfAxis axis{
      read_count(fields[2], name + ", count"), {}, read_positive(fields[4], name + ", scale")};
  for (const auto& [token, unit] : kUnits)
    if (token == fields[3]) axis.unit = unit;
  if (axis.unit.empty())
    throw DataError(name + ": the unit '" + printable(fields[3]) + "'; accepted: MM UM NM M");
  return axis;
}

// What stands before the next line EOR; the text then starts after that line.
std::string_view take_record(std::string_view& text, const std::string& place) {
  for (std::string_view left = text; !left.empty();) {
    const std::size_t size = text.size() - left.size();
    if (trimmed(take_line(left)) != "EOR") continue;
    const std::string_view record = text.substr(0, size);
    text = left;
    return record;
  }
  throw DataError(place + ": no line EOR behind it; is the file cut off?");
}

double read_spacing(std::string_view record) {
  while (!record.empty()) {
    const std::vector<std::string_view> fields = words(take_line(record).substr(0, 400));
    if (fields.size() >= 3 && fields[0] == "SPACING" && fields[1] == "CX")
      return read_positive(fields[2], "SPACING CX");
  }
  throw DataError("second record: SPACING CX is missing");
}

class Prf final : public Format {
 public:
  [[nodiscard]] std::string_view name() const override { return "PRF"; }
  [[nodiscard]] std::span<const std::string_view> endings() const override {
    static constexpr std::string_view kEndings[] = {".prf"};
    return kEndings;
  }
  [[nodiscard]] bool recognises(std::string_view bytes) const override {
    const auto first = words(take_line(bytes).substr(0, 16));
    const std::string_view second = trimmed(take_line(bytes));
    return first.size() == 2 && first[0] == "1" && first[1] == "2" && second.ends_with(" PRF");
  }
  [[nodiscard]] Trace read(std::string_view bytes, const TraceRequest& request) const override;
  [[nodiscard]] std::string write(const Trace& trace) const override;
};

Trace Prf::read(std::string_view bytes, const TraceRequest& request) const {
  refuse_line(request, name());
  if (!recognises(bytes))
    throw DataError("lines 1 and 2: accepted: '1 2', then a name, a number and PRF");
  std::string_view header = take_record(bytes, "header");
  take_line(header);
  take_line(header);
  const PrfAxis x = read_prf_axis(take_line(header), "CX");
  const PrfAxis z = read_prf_axis(take_line(header), "CZ");
  if (x.count != z.count)
    throw DataError("header: CX has " + std::to_string(x.count) + " points, CZ " +
                    std::to_string(z.count));
  if (x.scale != 1.0)
    throw DataError("CX, scale: " + shortest(x.scale) +
                    "; accepted: 1, the spacing is in its unit");
  const double spacing = read_spacing(take_record(bytes, "second record"));

  Trace trace;
  trace.position_unit = x.unit;
  trace.value_unit = z.unit;
  trace.values = read_numbers(take_record(bytes, "heights"), z.count, "heights");
  if (trimmed(bytes) != "EOF")
    throw DataError("behind the heights: no line EOF; is the file cut off?");
  multiply(trace.values, z.scale, "CZ, scale");
  trace.positions = even_positions(trace.values.size(), 0.0, spacing);
  return trace;
}

std::string Prf::write(const Trace& trace) const {
  check_lengths(trace, name());
  check_complete(trace, name());
  const auto token = [](const std::string& unit) -> std::string_view {
    for (const auto& [word, known] : kUnits)
      if (known == unit) return word;
    return "MM";  // of inches
  };
  const auto unit = [](const std::string& own) { return own == "inch" ? "mm" : own; };
  const std::string x_unit = unit(trace.position_unit);
  const std::string z_unit = unit(trace.value_unit);
  const std::string count = std::to_string(trace.values.size());
  const double spacing = spacing_from_zero(trace, name());
  std::string text = "1 2\r\nSLIDEWAY 0.000000e+000 PRF\r\n";
  for (const auto& [axis, own] : {std::array{"CX", x_unit.c_str()}, {"CZ", z_unit.c_str()}})
    text +=
        std::string(axis) + " M " + count + " " + std::string(token(own)) + " 1.000000e+000 D\r\n";
  text += "EOR\r\nSTYLUS_RADIUS 0.000000e+000 MM\r\nSPACING CX " +
          shortest(converted(spacing, trace.position_unit, x_unit)) +
          "\r\nMAP 1.000000e+000 CZ CZ 1.000000e+000 1.000000e+000\r\n"
          "MAP 2.000000e+000 CZ CX 1.000000e+000 0.000000e+000\r\nEOR\r\n";
  for (const double value : trace.values)
    text += shortest(converted(value, trace.value_unit, z_unit)) + "\r\n";
  return text + "EOR\r\nEOF";
}

}  // namespace

const Format& prf_format() {
  static const Prf kFormat;
  return kFormat;
}

}  // namespace slideway
