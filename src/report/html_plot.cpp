#include "html_plot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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

[[noreturn]] void refuse_range() {
  throw DataError("a curve is beyond all measure; accepted: what --json of slideway writes");
}

std::string coordinate(double value) {
  if (!std::isfinite(value)) refuse_range();
  return fixed_point(value, 1);
}

Html straight(const std::string& style, double x1, double y1, double x2, double y2) {
  HtmlAttributes attributes{{"x1", coordinate(x1)},
                            {"x2", coordinate(x2)},
                            {"y1", coordinate(y1)},
                            {"y2", coordinate(y2)}};
  if (!style.empty()) attributes.emplace_back("class", style);
  return element("line", attributes);
}

Html text_at(double x, double y, const char* anchor, const std::string& text) {
  return element("text", {{"x", coordinate(x)}, {"y", coordinate(y)}, {"text-anchor", anchor}},
                 text);
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
    if (!std::isfinite(high - low)) refuse_range();
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

Plot& Plot::markers() {
  markers_ = true;
  return *this;
}

Plot& Plot::line(std::string name, std::string style, std::vector<double> x,
                 std::vector<double> y) {
  require_one_length(text_, x, y);
  Line line{std::move(name), std::move(style), {}, {}, {}};
  if (!x.empty())
    for (const std::size_t i : thinned({y}, kPoints)) {
      if (!std::isfinite(x[i]) || !std::isfinite(y[i])) continue;
      line.x.push_back(x[i]);
      line.y.push_back(y[i]);
    }
  if (!line.x.empty()) lines_.push_back(std::move(line));
  return *this;
}

Plot& Plot::band(std::string name, std::string style, const std::vector<double>& x,
                 const std::vector<double>& low, const std::vector<double>& high) {
  require_one_length(text_, x, low);
  require_one_length(text_, x, high);
  Line line{std::move(name), std::move(style), {}, {}, {}};
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(low[i]) || !std::isfinite(high[i])) continue;
    line.x.push_back(x[i]);
    line.y.push_back(low[i]);
    line.high.push_back(high[i]);
  }
  if (!line.x.empty()) lines_.push_back(std::move(line));
  return *this;
}

Plot& Plot::level(std::string name, std::string style, double y) {
  levels_.emplace_back(Line{std::move(name), std::move(style), {}, {}, {}}, y);
  return *this;
}

/// What the lines are called: rows of a sample and its name.
struct Plot::Legend {
  Html entries;
  double height = 0.0;
};

Plot::Legend Plot::legend() const {
  constexpr double kSample = 26.0, kSpace = 18.0, kLetter = 6.3;
  Legend out;
  double at = kLeft, row = 12.0;
  const auto add = [&](const Line& line) {
    if (line.name.empty()) return;
    const double length =
        kSample + 6.0 + kLetter * static_cast<double>(code_points(line.name)) + kSpace;
    if (!out.entries.empty() && at + length - kSpace > width_ - kRight) {
      at = kLeft;
      row += kLegendRow;
    }
    out.entries += line.high.empty() ? straight(line.style, at, row - 4.0, at + kSample, row - 4.0)
                                     : element("rect", {{"class", line.style},
                                                        {"x", coordinate(at)},
                                                        {"y", coordinate(row - 9.0)},
                                                        {"width", coordinate(kSample)},
                                                        {"height", "10"}});
    out.entries += element(
        "text", {{"class", "key"}, {"x", coordinate(at + kSample + 6.0)}, {"y", coordinate(row)}},
        line.name);
    at += length;
    out.height = row - 12.0 + kLegendRow;
  };
  for (const Line& line : lines_) add(line);
  for (const auto& [line, y] : levels_) add(line);
  return out;
}

Plot::Axis Plot::axis(bool horizontal, double top) const {
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
  out.from = horizontal ? kLeft : height_ - kBottom;
  out.to = horizontal ? width_ - kRight : top;
  out.settle(!horizontal);
  return out;
}

Html Plot::grid(const Axis& x, const Axis& y) const {
  Html lines;
  for (const auto& [value, text] : x.ticks) lines += straight("", x(value), y.from, x(value), y.to);
  for (const auto& [value, text] : y.ticks) lines += straight("", x.from, y(value), x.to, y(value));
  return element("g", {{"class", "grid"}}, lines);
}

Html Plot::ticks(const Axis& x, const Axis& y) const {
  Html texts;
  for (const auto& [value, text] : x.ticks)
    texts += text_at(x(value), y.from + 15.0, "middle", text);
  for (const auto& [value, text] : y.ticks)
    texts += text_at(x.from - 6.0, y(value) + 4.0, "end", text);
  texts += text_at((x.from + x.to) / 2.0, height_ - 6.0, "middle", text_.x);
  const std::string middle = coordinate((y.from + y.to) / 2.0);
  texts += element("text",
                   {{"x", "14"},
                    {"y", middle},
                    {"text-anchor", "middle"},
                    {"transform", "rotate(-90 14 " + middle + ")"}},
                   text_.y);
  return element("g", {{"class", "tick"}}, texts);
}

Html Plot::drawn(const Line& line, const Axis& x, const Axis& y) {
  std::string points;
  const auto add = [&](double px, double py) {
    points.append(coordinate(x(px))).append(",").append(coordinate(y(py))).append(" ");
  };
  for (std::size_t i = 0; i < line.x.size(); ++i) add(line.x[i], line.y[i]);
  for (std::size_t i = line.high.size(); i-- > 0;) add(line.x[i], line.high[i]);
  return element(line.high.empty() ? "polyline" : "polygon",
                 {{"class", line.style}, {"points", points}});
}

Html Plot::svg(const HtmlAttributes& more) const {
  const Legend names = legend();
  const Axis x = axis(true, 0.0), y = axis(false, 6.0 + names.height);
  Html content = grid(x, y) + ticks(x, y);
  for (const Line& line : lines_)
    if (!line.high.empty()) content += drawn(line, x, y);
  for (const auto& [line, value] : levels_)
    content += straight(line.style, x.from, y(value), x.to, y(value));
  for (const Line& line : lines_) {
    if (!line.high.empty()) continue;
    content += drawn(line, x, y);
    for (std::size_t i = 0; markers_ && i < line.x.size(); ++i)
      content += element("circle", {{"class", line.style},
                                    {"cx", coordinate(x(line.x[i]))},
                                    {"cy", coordinate(y(line.y[i]))},
                                    {"r", "2.2"}});
  }
  return svg_element(
      {text_.id, text_.title, text_.description, coordinate(width_), coordinate(height_)},
      content + names.entries, more);
}

}  // namespace slideway
