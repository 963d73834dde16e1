#pragma once

#include <string>
#include <vector>

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
  /// @throws DataError  x and y differ in length
  Plot& line(std::string name, std::string style, std::vector<double> x, std::vector<double> y);
  Plot& band(std::string name, std::string style, std::vector<double> x, std::vector<double> low,
             std::vector<double> high);
  Plot& level(std::string name, std::string style, double y);

  [[nodiscard]] bool empty() const { return lines_.empty(); }
  /// @throws DataError  a number is beyond all measure
  [[nodiscard]] std::string svg() const;

 private:
  struct Line {
    std::string name, style;
    std::vector<double> x, y, high;  // high: of a band
  };
  struct Axis;

  [[nodiscard]] Axis axis(bool horizontal) const;
  [[nodiscard]] std::string grid(const Axis& x, const Axis& y) const;
  [[nodiscard]] std::string drawn(const Line& line, const Axis& x, const Axis& y) const;
  [[nodiscard]] std::string legend() const;

  Text text_;
  double width_ = 720.0, height_ = 300.0;
  bool log_x_ = false, log_y_ = false;
  std::vector<Line> lines_;
  std::vector<std::pair<Line, double>> levels_;
};

}  // namespace slideway
