#include "x3p_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "numbers.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "xml.hpp"

namespace slideway {
namespace {

constexpr double kMissingPoint = std::numeric_limits<double>::quiet_NaN();

X3pAxis read_axis(pugi::xml_node root, const std::string& name) {
  X3pAxis axis;
  const std::string path = "Record1/Axes/" + name;
  const pugi::xml_node node = element(root, path.c_str(), "main.xml");
  axis.place = "main.xml: " + path;

  const std::string_view kind = text_of(element(node, "AxisType", axis.place));
  if (kind != "I" && kind != "A")
    throw DataError(axis.place + "/AxisType: '" + printable(kind) +
                    "'; accepted: I (incremental), A (absolute)");
  axis.incremental = kind == "I";

  if (const pugi::xml_node type = node.child("DataType")) {
    const std::string_view letter = text_of(type);
    if (letter.size() != 1 || std::string_view("ILFD").find(letter) == std::string_view::npos)
      throw DataError(axis.place + "/DataType: '" + printable(letter) +
                      "'; accepted: I (int16), L (int32), F (float), D (double)");
    axis.type = letter[0];
  }
  if (const pugi::xml_node increment = node.child("Increment"))
    axis.increment = read_number(text_of(increment), axis.place + "/Increment");
  if (const pugi::xml_node offset = node.child("Offset"))
    axis.offset = read_number(text_of(offset), axis.place + "/Offset");
  return axis;
}

void append_point(X3pPoints& points, const X3pAxes& axes,
                  std::array<std::optional<double>, 3> point) {
  if (point[0]) points.x.push_back(axes.x.coordinate(*point[0]));
  if (point[1]) points.y.push_back(axes.y.coordinate(*point[1]));
  points.z.push_back(axes.z.coordinate(point[2].value()));
}

// Which of the axes a Datum of so many fields holds.
std::array<bool, 3> stored_axes(const X3pAxes& axes, std::size_t fields, const std::string& place) {
  const std::array<bool, 3> least{!axes.x.incremental, !axes.y.incremental, true};
  const std::size_t needed = least[0] + least[1] + 1U;
  if (fields == needed) return least;
  if (fields == 3) return {true, true, true};
  throw DataError(place + ": " + std::to_string(fields) + " numbers; accepted: " +
                  std::to_string(needed) + " (the absolute axes) or 3, separated by ';'");
}

std::array<std::optional<double>, 3> read_datum(std::string_view text, const X3pAxes& axes,
                                                const std::string& place) {
  std::vector<std::string_view> fields;
  for (std::size_t begin = 0; begin <= text.size() && fields.size() < 4;) {
    const std::size_t end = std::min(text.find(';', begin), text.size());
    fields.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  std::array<std::optional<double>, 3> point;
  const std::array<bool, 3> stored = stored_axes(axes, fields.size(), place);
  std::size_t field = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!stored[axis]) continue;
    const std::string_view number = trimmed(fields[field++]);
    point[axis] = axis == 2 && (number == "NaN" || number == "nan") ? kMissingPoint
                                                                    : read_number(number, place);
  }
  return point;
}

bool is_valid(std::string_view valid, std::size_t i) {
  return valid.empty() || ((static_cast<unsigned char>(valid[i / 8]) >> (i % 8)) & 1U) != 0;
}

}  // namespace

double X3pAxis::scale() const {
  if (incremental && !increment) throw DataError(place + ": the element Increment is missing");
  return incremental || increment.value_or(0.0) != 0.0 ? *increment : 1.0;
}

double X3pAxis::coordinate(double stored) const { return stored * scale() + offset; }

std::size_t X3pAxis::bytes() const { return type == 'I' ? 2 : type == 'D' ? 8 : 4; }

double X3pAxis::stored(std::string_view bytes) const {
  switch (type) {
    case 'I':
      return little_endian<std::int16_t>(bytes);
    case 'L':
      return little_endian<std::int32_t>(bytes);
    case 'F':
      return static_cast<double>(little_endian<float>(bytes));
    default:
      return little_endian<double>(bytes);
  }
}

std::size_t X3pAxes::point_bytes() const {
  return (x.incremental ? 0 : x.bytes()) + (y.incremental ? 0 : y.bytes()) + z.bytes();
}

X3pAxes read_axes(pugi::xml_node root) {
  return {read_axis(root, "CX"), read_axis(root, "CY"), read_axis(root, "CZ")};
}

X3pPoints read_data_list(pugi::xml_node list, const X3pAxes& axes, std::size_t count) {
  X3pPoints points;
  for (const pugi::xml_node datum : list.children("Datum")) {
    const std::string place =
        "main.xml: Record3/DataList/Datum " + std::to_string(points.z.size() + 1);
    if (points.z.size() == count)
      throw DataError(place + ": only " + std::to_string(count) + " are declared");
    const std::string_view text = text_of(datum);
    const auto unless_given = [](const X3pAxis& axis) {
      return axis.incremental ? std::nullopt : std::optional(kMissingPoint);
    };
    append_point(points, axes,
                 text.empty()
                     ? std::array<std::optional<double>, 3>{unless_given(axes.x),
                                                            unless_given(axes.y), kMissingPoint}
                     : read_datum(text, axes, place));
    const auto consistent = [&](const std::vector<double>& stored) {
      return stored.empty() || stored.size() == points.z.size();
    };
    if (!consistent(points.x) || !consistent(points.y))
      throw DataError(place + ": has other axes than those before");
  }
  if (points.z.size() < count)
    throw DataError("main.xml: Record3/DataList: " + std::to_string(points.z.size()) +
                    " Datum where " + std::to_string(count) + " are declared");
  return points;
}

X3pPoints read_binary(std::string_view bytes, std::string_view valid, const X3pAxes& axes,
                      std::size_t count) {
  X3pPoints points;
  for (std::size_t i = 0; i < count; ++i) {
    std::array<std::optional<double>, 3> point;
    const auto take = [&](const X3pAxis& axis) {
      const double value = axis.stored(bytes);
      bytes.remove_prefix(axis.bytes());
      if (std::isinf(value))
        throw DataError("the binary data, point " + std::to_string(i + 1) +
                        ": infinite; a missing point is NaN");
      return value;
    };
    if (!axes.x.incremental) point[0] = take(axes.x);
    if (!axes.y.incremental) point[1] = take(axes.y);
    point[2] = take(axes.z);
    if (!is_valid(valid, i)) point[2] = kMissingPoint;
    append_point(points, axes, point);
  }
  return points;
}

}  // namespace slideway
