#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <sstream>

#include "drawn_lines.hpp"
#include "slideway/signal/dwt.hpp"

namespace slideway {

std::uint8_t Draw::byte() {
  if (left_.empty()) return 0;
  const std::uint8_t first = left_.front();
  left_ = left_.subspan(1);
  return first;
}

std::size_t Draw::below(std::size_t n) {
  std::size_t number = byte();
  if (n > 256) number = number << 8 | byte();
  return number % n;
}

double Draw::between(double low, double high) {
  return low + (high - low) * static_cast<double>(below(65536)) / 65535.0;
}

const std::string& hostile_value(Draw& draw) {
  static const Words kValues{"0",
                             "-1",
                             "1e-300",
                             "1e300",
                             "-1e300",
                             "nan",
                             "inf",
                             "-inf",
                             "1e9",
                             "-1e9",
                             "1e-9",
                             "1e18",
                             "2",
                             "0.5",
                             "2147483647",
                             "-2147483648",
                             "9223372036854775807",
                             "\"\"",
                             "[]",
                             "true",
                             "{}",
                             "\"p0\"",
                             "[0, 1]",
                             "[1e9, 1e9]",
                             "\"\\u202e\""};
  return draw.one_of(kValues);
}

namespace {

Words boundaries() {
  std::istringstream names{std::string(kBoundaries)};
  return {std::istream_iterator<std::string>(names), {}};
}

std::vector<double> drawn_positions(Draw& draw, Intent intent, std::size_t count) {
  constexpr std::array<double, 6> kLengths{40.0, 200.0, 600.0, 5.0, 0.5, 2000.0};
  constexpr std::array<double, 4> kStarts{0.0, -0.5, 0.05, 3.0};
  const double length = draw.one_of(kLengths), first = draw.one_of(kStarts) * length;
  const double uneven = draw.once_in(4) ? 0.4 : 0.0;
  std::vector<double> out;
  for (std::size_t i = 0; i < count; ++i) {
    const double step = length / static_cast<double>(std::max<std::size_t>(count - 1, 1));
    const double shift = uneven * std::sin(7.0 * static_cast<double>(i * i));
    out.push_back(first + step * (static_cast<double>(i) + shift));
  }
  if (intent == Intent::hostile && draw.once_in(40)) out[draw.below(count)] = out[0];
  if (draw.once_in(10)) std::ranges::reverse(out);
  return out;
}

/// Cone, bow, wave, step, creep, noise: what a person would call a profile.
std::vector<double> drawn_values(Draw& draw, const std::vector<double>& positions) {
  constexpr std::array<double, 6> kSizes{1.0, 0.1, 10.0, 0.0, 1e-3, 1e3};
  const double cone = draw.one_of(kSizes) * draw.between(-1, 1);
  const double bow = draw.one_of(kSizes) * draw.between(-1, 1);
  const double wave = draw.one_of(kSizes) * draw.between(-0.3, 0.3);
  const double cycles = draw.between(0.5, 20.0);
  const double step = draw.once_in(3) ? draw.between(-1, 1) : 0.0, at = draw.between(0, 1);
  const double creep = draw.once_in(3) ? draw.between(-1, 1) : 0.0, tau = draw.between(0.05, 1);
  const double noise = draw.one_of(std::array{0.02, 0.2, 0.002, 0.0, 2.0});
  const double grain = draw.once_in(8) ? 0.1 : 0.0, spike = draw.once_in(8) ? 50.0 : 0.0;
  const auto [low, high] = std::ranges::minmax_element(positions);
  std::uint64_t state = draw.below(65536);
  std::vector<double> out;
  for (const double position : positions) {
    const double u = *high > *low ? (position - *low) / (*high - *low) : 0.0;
    state = state * 6364136223846793005U + 1442695040888963407U;
    const double random = static_cast<double>(state >> 11) * 0x1p-53 - 0.5;
    double value = cone * u + bow * u * u + wave * std::cos(2 * std::numbers::pi * cycles * u) +
                   (u < at ? step : 0.0) + creep * std::exp(-u / tau) + 3.5 * noise * random;
    if (spike > 0.0 && out.size() == positions.size() / 3) value += spike;
    out.push_back(grain > 0.0 ? grain * std::round(value / grain) : value);
  }
  return out;
}

void drawn_cut(Draw& draw, Lines& lines, bool is_face) {
  if (!draw.once_in(5)) lines.number("feed_mm_per_min", 1.0, 200.0);
  if (!draw.once_in(5)) lines.number("spindle_rpm", 20.0, 3000.0);
  if (!draw.once_in(5)) lines.word("cut_direction", {"inward", "outward"});
  if (lines.maybe()) lines.number("start_s", 0.0, 3600.0);
  if (!draw.once_in(3)) lines.number("traverse_mm_per_s", 0.05, 5.0);
  if (lines.maybe()) lines.number("z_mm", -100.0, 300.0);
  if (!is_face) return;
  if (lines.maybe(8)) lines.number("center_mm", -5.0, 5.0);
  if (lines.maybe()) lines.number("cut_radius_mm", 1.0, 700.0);
  if (lines.maybe(8)) lines.number("nose_radius_mm", 0.1, 3.0);
  if (lines.maybe()) lines.number("azimuth_deg", -360.0, 360.0);
}

void drawn_treatment(Draw& draw, Lines& lines, bool is_face) {
  if (lines.maybe(3)) lines.put("level", std::to_string(draw.below(6)));
  if (lines.maybe(6)) lines.put("wavelet", "\"db" + std::to_string(1 + draw.below(19)) + '"');
  if (lines.maybe(8)) lines.word("boundary", boundaries());
  if (!draw.once_in(4))
    lines.put("free",
              draw.one_of(Words{"[\"offset\"]", "[]", "[\"offset\", \"tilt\"]", "[\"tilt\"]"}));
  if (lines.maybe(8)) lines.word("loss", {"huber", "cauchy", "none"});
  if (lines.maybe(6)) lines.put("leave_out", draw.one_of(Words{"\"spikes\"", "[1]", "[3, 4]"}));
  if (lines.maybe(6)) lines.word("surface", {"a", "b"});
  if (lines.maybe(6)) lines.word("instrument", {"probe", "level"});
  if (!is_face && lines.maybe(6)) lines.put("reversed", "true");
}

}  // namespace

DrawnProfile drawn_profile(Draw& draw, Intent intent, const Outline& outline, std::size_t index) {
  DrawnProfile out;
  out.name = "p" + std::to_string(index);
  const std::size_t kind = draw.below(4);
  const bool is_face = kind < 2;
  out.is_slope = kind == 3;
  const std::size_t least = intent == Intent::hostile ? 1 : 16;
  const std::size_t count = least + draw.below(draw.once_in(3) ? 285 : 60);
  out.positions_mm = drawn_positions(draw, intent, count);
  out.values = drawn_values(draw, out.positions_mm);
  Lines lines(draw, intent);
  lines.put("kind", is_face ? "\"face\"" : "\"slide\"");
  lines.put("quantity", out.is_slope ? "\"slope\"" : "\"height\"");
  drawn_cut(draw, lines, is_face);
  drawn_treatment(draw, lines, is_face);
  if (out.is_slope && lines.maybe(2)) lines.number("base_mm", 0.1, 60.0);
  if (outline.is_split && lines.maybe()) lines.number("overhang_mm", -50.0, 200.0);
  if (index > 0 && lines.maybe(6)) lines.put("role", "\"holdout\"");
  if (outline.has_times)
    for (std::size_t i = 0; i < count; ++i)
      out.times_s.push_back(60.0 + 4.0 * static_cast<double>(i));
  if (lines.maybe(6)) out.standard_uncertainty = draw.between(0.001, 1.0);
  out.keys = lines.take();
  return out;
}

DrawnLog drawn_log(Draw& draw, Intent intent) {
  Lines lines(draw, intent);
  const bool of_slide = draw.once_in(4);
  lines.put("time_unit", of_slide ? "\"mm\"" : "\"s\"");
  lines.put("clock", of_slide ? "\"x\"" : draw.one_of(Words{"\"t\"", "\"m\"", "\"t_read\""}));
  DrawnLog out{"log0", lines.take(), {}, {}};
  const std::size_t count = 3 + draw.below(200);
  const double last = draw.between(10.0, 20000.0);
  for (std::size_t i = 0; i < count; ++i)
    out.at.push_back(last * static_cast<double>(i) / static_cast<double>(count - 1));
  out.values = drawn_values(draw, out.at);
  return out;
}

}  // namespace slideway
