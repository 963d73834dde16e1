#include "html_plot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "html_parts.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/report/layout.hpp"
#include "slideway/report/number.hpp"
#include "slideway/signal/thin.hpp"

namespace slideway {
namespace {

constexpr double kLeft = 62.0, kRight = 22.0, kBottom = 40.0, kLegendRow = 16.0;
constexpr std::size_t kPoints = 800;  // of a line: more than the picture has columns
constexpr double kMostDecades = 5.0;  // of a logarithmic axis, below its largest

std::string coordinate(double value) { return fixed_point(finite(value), 1); }

std::string attribute(const char* name, double value) {
  return std::string(" ") + name + "=\"" + coordinate(value) + "\"";
}

/// 1, 2 or 5 times a power of ten.
double nice_step(double range, double count) {
  const double power = std::pow(10.0, std::floor(std::log10(range / count)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (range / (factor * power) <= count) return factor * power;
  return 10.0 * power;
}

/// "-5e-05" as "−5·10⁻⁵", in characters: a picture has no markup for powers.
std::string in_powers(const std::string& text) {
  constexpr const char* kRaised[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  const std::size_t e = text.find('e');
  std::string out = text.substr(0, e);
  if (out.front() == '-') out.replace(0, 1, "−");
  if (e == std::string::npos) return out;
  out += "·10";
  const int power = std::stoi(text.substr(e + 1));
  if (power < 0) out += "⁻";
  for (const char digit : std::to_string(std::abs(power))) out += kRaised[digit - '0'];
  return out;
}

std::string tick_text(double value, double step) {
  if (std::abs(value) < 1e-9 * step) return "0";
  const double size = std::max(std::abs(value), step);
  if (size >= 1e5 || step < 1e-4) return in_powers(significant(value, 3));
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
  return in_powers(fixed_point(value, decimals));
}

void require_one_length(const Plot::Text& plot, const std::vector<double>& positions,
                        const std::vector<double>& values) {
  if (positions.size() != values.size())
    throw DataError(printable(plot.title, 80) + ": a curve has " +
                    counted(positions.size(), "position") + " and " +
                    counted(values.size(), "value") + "; accepted: as many of both");
}

}  // namespace

struct Plot::Axis {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  double from = 0.0, to = 1.0;  // on the page
  bool logarithmic = false;
  std::vector<std::pair<double, std::string>> ticks;

  void include(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  [[nodiscard]] double operator()(double value) const {
    if (!logarithmic) return from + (to - from) * (value - low) / (high - low);
    const double at = std::log(std::max(value, low) / low) / std::log(high / low);
    return from + (to - from) * at;
  }
  void settle(bool padded) {
    finite(high - low);
    if (logarithmic) return settle_logarithmic();
    if (!(high > low)) {
      const double margin = std::max(std::abs(low) * 0.1, 1e-12);
      low -= margin;
      high += margin;
    }
    if (padded) {
      const double margin = 0.04 * (high - low);
      low -= margin;
      high += margin;
    }
    constexpr double kMost = 12.0;  // divisions: a scale needs two ticks, not all
    double count = std::max(2.0, std::abs(to - from) / (padded ? 40.0 : 65.0));
    do divide(nice_step(high - low, count));
    while (ticks.size() < 2 && ++count < kMost);
  }
  void divide(double step) {
    ticks.clear();
    for (double k = std::ceil(low / step);
         k * step <= high * (1.0 + 1e-12 * (high > 0 ? 1 : -1)) && ticks.size() < 50; ++k)
      ticks.emplace_back(k * step, tick_text(k * step, step));
  }
  void settle_logarithmic() {
    high = std::max(high, 1e-300);
    low = std::clamp(low, high * std::pow(10.0, -kMostDecades), high * 0.5);
    const int first = static_cast<int>(std::ceil(std::log10(low)));
    const int last = static_cast<int>(std::floor(std::log10(high)));
    const bool few = last - first < 2;
    for (int decade = first - 1; decade <= last; ++decade)
      for (const double factor : {1.0, 2.0, 5.0}) {
        const double value = factor * std::pow(10.0, decade);
        if (value < low * (1.0 - 1e-9) || value > high * (1.0 + 1e-9) || (!few && factor > 1.0))
          continue;
        ticks.emplace_back(value, tick_text(value, value));
      }
  }
};

Plot& Plot::size(double width, double height) {
  width_ = width;
  height_ = height;
  return *this;
}

Plot& Plot::log_x() {
  log_x_ = true;
  return *this;
}

Plot& Plot::log_y() {
  log_y_ = true;
  return *this;
}

Plot& Plot::line(std::string name, std::string style, std::vector<double> x,
                 std::vector<double> y) {
  require_one_length(text_, x, y);
  if (x.empty()) return *this;
  Line line{std::move(name), std::move(style), {}, {}, {}};
  for (const std::size_t i : thinned({y}, kPoints)) {
    line.x.push_back(x[i]);
    line.y.push_back(y[i]);
  }
  lines_.push_back(std::move(line));
  return *this;
}

Plot& Plot::band(std::string name, std::string style, std::vector<double> x,
                 std::vector<double> low, std::vector<double> high) {
  require_one_length(text_, x, low);
  require_one_length(text_, x, high);
  if (!x.empty())
    lines_.push_back(
        {std::move(name), std::move(style), std::move(x), std::move(low), std::move(high)});
  return *this;
}

Plot& Plot::level(std::string name, std::string style, double y) {
  levels_.emplace_back(Line{std::move(name), std::move(style), {}, {}, {}}, y);
  return *this;
}

Plot::Axis Plot::axis(bool horizontal) const {
  Axis out;
  out.logarithmic = horizontal ? log_x_ : log_y_;
  for (const Line& line : lines_)
    for (const std::vector<double>* values : {horizontal ? &line.x : &line.y, &line.high}) {
      if (horizontal && values == &line.high) continue;
      for (const double value : *values)
        if (!out.logarithmic || value > 0.0) out.include(value);
    }
  if (!horizontal)
    for (const auto& [line, y] : levels_) out.include(y);
  if (!(out.low <= out.high)) out.include(1.0);
  const std::string entries = legend();
  const auto rows = static_cast<double>(std::count(entries.begin(), entries.end(), '\n'));
  const double top = 6.0 + kLegendRow * rows;
  out.from = horizontal ? kLeft : height_ - kBottom;
  out.to = horizontal ? width_ - kRight : top;
  out.settle(!horizontal);
  return out;
}

std::string Plot::grid(const Axis& x, const Axis& y) const {
  std::string out = "<g class=\"grid\">";
  for (const auto& [value, text] : x.ticks)
    out += "<line" + attribute("x1", x(value)) + attribute("x2", x(value)) +
           attribute("y1", y.from) + attribute("y2", y.to) + "/>";
  for (const auto& [value, text] : y.ticks)
    out += "<line" + attribute("x1", x.from) + attribute("x2", x.to) + attribute("y1", y(value)) +
           attribute("y2", y(value)) + "/>";
  out += "</g><g class=\"tick\">";
  for (const auto& [value, text] : x.ticks)
    out += "<text" + attribute("x", x(value)) + attribute("y", y.from + 15.0) +
           " text-anchor=\"middle\">" + text + "</text>";
  for (const auto& [value, text] : y.ticks)
    out += "<text" + attribute("x", x.from - 6.0) + attribute("y", y(value) + 4.0) +
           " text-anchor=\"end\">" + text + "</text>";
  out += "<text" + attribute("x", (x.from + x.to) / 2.0) + attribute("y", height_ - 6.0) +
         " text-anchor=\"middle\">" + escaped(text_.x) + "</text>";
  const std::string middle = coordinate((y.from + y.to) / 2.0);
  out += "<text x=\"14\" y=\"" + middle + "\" text-anchor=\"middle\" transform=\"rotate(-90 14 " +
         middle + ")\">" + escaped(text_.y) + "</text></g>\n";
  return out;
}

std::string Plot::drawn(const Line& line, const Axis& x, const Axis& y) const {
  std::string points;
  const auto add = [&](double px, double py) {
    points.append(coordinate(x(px))).append(",").append(coordinate(y(py))).append(" ");
  };
  for (std::size_t i = 0; i < line.x.size(); ++i) add(line.x[i], line.y[i]);
  for (std::size_t i = line.high.size(); i-- > 0;) add(line.x[i], line.high[i]);
  const std::string tag = line.high.empty() ? "polyline" : "polygon";
  return "<" + tag + " class=\"" + line.style + "\" points=\"" + points + "\"/>\n";
}

/// One row of entries a line of text.
std::string Plot::legend() const {
  constexpr double kSample = 26.0, kGap = 18.0, kLetter = 6.3;
  std::string out;
  double at = kLeft, row = 12.0;
  const auto add = [&](const Line& line) {
    if (line.name.empty()) return;
    const double length =
        kSample + 6.0 + kLetter * static_cast<double>(code_points(line.name)) + kGap;
    if (out.empty()) {
      out = "\n";
    } else if (at + length - kGap > width_ - kRight) {
      at = kLeft;
      row += kLegendRow;
      out += "\n";
    }
    if (line.high.empty())
      out += "<line class=\"" + line.style + "\"" + attribute("x1", at) +
             attribute("x2", at + kSample) + attribute("y1", row - 4.0) +
             attribute("y2", row - 4.0) + "/>";
    else
      out += "<rect class=\"" + line.style + "\"" + attribute("x", at) + attribute("y", row - 9.0) +
             attribute("width", kSample) + " height=\"10\"/>";
    out += "<text class=\"key\"" + attribute("x", at + kSample + 6.0) + attribute("y", row) + ">" +
           escaped(line.name) + "</text>";
    at += length;
  };
  for (const Line& line : lines_) add(line);
  for (const auto& [line, y] : levels_) add(line);
  return out;
}

std::string Plot::svg() const {
  const Axis x = axis(true), y = axis(false);
  std::string out = "<svg role=\"img\" aria-labelledby=\"" + text_.id + "-t " + text_.id +
                    "-d\" viewBox=\"0 0 " + coordinate(width_) + " " + coordinate(height_) +
                    "\"><title id=\"" + text_.id + "-t\">" + escaped(text_.title) +
                    "</title><desc id=\"" + text_.id + "-d\">" + escaped(text_.description) +
                    "</desc>\n" + grid(x, y);
  for (const Line& line : lines_)
    if (!line.high.empty()) out += drawn(line, x, y);
  for (const auto& [line, value] : levels_)
    out += "<line class=\"" + line.style + "\"" + attribute("x1", x.from) + attribute("x2", x.to) +
           attribute("y1", y(value)) + attribute("y2", y(value)) + "/>\n";
  for (const Line& line : lines_)
    if (line.high.empty()) out += drawn(line, x, y);
  return out + legend() + "</svg>\n";
}

}  // namespace slideway
