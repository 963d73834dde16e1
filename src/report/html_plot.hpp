#pragma once

#include <string>
#include <vector>

#include "html.hpp"

namespace slideway {

/// A picture with axes as inline SVG, readable without scripts and by a screen reader.
///
/// Styles are classes of the page: "before", "after", "raw", "low", "limit", "e0" ... "e7"; each
/// has a colour of Okabe and Ito and a dash of its own.
class Plot {
 public:
  struct Text {
    std::string id, title, description;  // plain text
    std::string x, y;                    // axis labels, plain text
  };
  explicit Plot(Text text) : text_(std::move(text)) {}

  Plot& size(double width, double height);
  Plot& log_x();
  Plot& log_y();
  /// Lines are drawn with a marker at every point: of few readings.
  Plot& markers();
  /// Points that are not finite are left out. @throws DataError  x and y differ in length
  Plot& line(std::string name, std::string style, std::vector<double> x, std::vector<double> y);
  Plot& band(std::string name, std::string style, const std::vector<double>& x,
             const std::vector<double>& low, const std::vector<double>& high);
  Plot& level(std::string name, std::string style, double y);

  [[nodiscard]] bool empty() const { return lines_.empty(); }
  /// @param more  attributes of the svg element
  /// @throws DataError  the range of an axis is beyond what a number holds
  [[nodiscard]] Html svg(const HtmlAttributes& more = {}) const;

 private:
  struct Line {
    std::string name, style;
    std::vector<double> x, y, high;  // high: of a band
  };
  struct Axis;

  struct Legend;

  [[nodiscard]] Axis axis(bool horizontal, double top) const;
  [[nodiscard]] Html grid(const Axis& x, const Axis& y) const;
  [[nodiscard]] Html ticks(const Axis& x, const Axis& y) const;
  [[nodiscard]] static Html drawn(const Line& line, const Axis& x, const Axis& y);
  [[nodiscard]] Legend legend() const;

  Text text_;
  double width_ = 720.0, height_ = 300.0;
  bool log_x_ = false, log_y_ = false, markers_ = false;
  std::vector<Line> lines_;
  std::vector<std::pair<Line, double>> levels_;
};

}  // namespace slideway
