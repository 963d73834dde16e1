#pragma once

#include <cstddef>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

/// The points of an X3P file (ISO 25178-72): what its axes are and how their values are stored.
namespace slideway {

struct X3pAxis {
  std::string place;  // "main.xml: Record1/Axes/CX"
  bool incremental = false;
  char type = 'D';                  // I int16, L int32, F float, D double
  std::optional<double> increment;  // m
  double offset = 0.0;              // m

  /// m that a stored value of 1 stands for; 1 on an absolute axis that gives no increment, or 0.
  /// @throws DataError if an incremental axis has no increment
  [[nodiscard]] double scale() const;
  /// Coordinate in m of a stored value, or of an index along an incremental axis.
  [[nodiscard]] double coordinate(double stored) const;
  [[nodiscard]] std::size_t bytes() const;
  [[nodiscard]] double stored(std::string_view bytes) const;
};

struct X3pAxes {
  X3pAxis x, y, z;

  /// Bytes of a point: of its z and of what is absolute.
  [[nodiscard]] std::size_t point_bytes() const;
};

/// Points as they are stored. Where an axis is incremental, x and y may be empty: they follow from
/// the place of the point.
struct X3pPoints {
  std::vector<double> x, y, z;  // m; NaN where missing
};

/// @throws DataError naming the element
X3pAxes read_axes(pugi::xml_node root);

/// Points in the elements Datum of a DataList.
X3pPoints read_data_list(pugi::xml_node list, const X3pAxes& axes, std::size_t count);

/// Points in binary; `valid` has a bit a point, the lowest first, or is empty.
X3pPoints read_binary(std::string_view bytes, std::string_view valid, const X3pAxes& axes,
                      std::size_t count);

}  // namespace slideway
