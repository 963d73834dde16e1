// make_data OUTDIR: writes the simulated CSV files of data/ into OUTDIR. Same program, same bytes.
// What each file is for stands in data/README.md; the process is in tests/support/turning.hpp.

#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "support/turning.hpp"

namespace {

using namespace slideway::turning;  // NOLINT(google-build-using-namespace): the whole program
using slideway::RandomStream;

constexpr double kMicrometre = 1e-3;  // mm

struct Column {
  std::string name;
  std::vector<double> values;
  int decimals = 4;
};

std::string fixed(double value, int decimals) {
  std::array<char, 64> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value,
                                 std::chars_format::fixed, decimals)
                       .ptr;
  return {text.data(), end};
}

void write_csv(const std::filesystem::path& path, const std::string& comment,
               const std::vector<Column>& columns) {
  std::string text = "# Simulated (data/make_data.cpp): " + comment + "\n";
  for (std::size_t c = 0; c < columns.size(); ++c) {
    text += (c == 0 ? "" : ",") + columns[c].name;
  }
  text += '\n';
  for (std::size_t i = 0; i < columns.front().values.size(); ++i) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      if (c > 0) text += ',';
      text += fixed(columns[c].values[i], columns[c].decimals);
    }
    text += '\n';
  }
  std::ofstream out(path, std::ios::binary);
  out << text;
  out.flush();
  if (!out) throw std::runtime_error(path.string() + ": cannot be written");
}

/// 0, 1/per_mm, 2/per_mm, ... mm, times `step`: exactly the decimals that get printed.
std::vector<double> grid(int samples, int step, int per_mm) {
  std::vector<double> positions;
  positions.reserve(samples);
  for (int i = 0; i < samples; ++i) positions.push_back(static_cast<double>(i) * step / per_mm);
  return positions;
}

/// Cuts a face, reads it, and writes positions in mm with heights in µm to 0.1 nm.
struct FaceFile {
  std::filesystem::path path;
  std::string comment;
  Cut cut;
  Error error;
  std::vector<double> positions;
  int position_decimals = 2;
  Stylus stylus;
};

void write_face(const FaceFile& file, std::uint64_t seed) {
  RandomStream random(seed, "stylus");
  std::vector<double> heights =
      trace(Face(file.cut, file.error), file.positions, file.stylus, random);
  for (double& height : heights) height /= kMicrometre;
  write_csv(file.path, file.comment,
            {{"x_mm", file.positions, file.position_decimals}, {"z_um", heights, 4}});
}

/// Straightness inside the rounding intervals of Eq. (17), 0.3 µm over 0 to 600 mm. A chosen set:
/// problems/paper-600mm/README.md.
const std::vector<double> kStraightness = {2.41e-4,    -5.19e-7,   2.2905e-8,
                                           -1.558e-10, 3.3908e-13, -2.343e-16};

/// The full travel at both feeds, with the pitch left out (lever "split", no overhang) and with
/// Eq. (16) at its word (lever "paper"). Tool and vibration are the same in all four.
void paper_600mm(const std::filesystem::path& directory) {
  const Carriage carriage{kStraightness, {}, 2.8e-6, 0.0, 0.0};
  const std::vector<std::pair<std::string, Error>> levers = {
      {"split", [=](const ToolPoint& tool) { return two_levers(carriage, tool); }},
      {"paper", [=](const ToolPoint& tool) { return one_lever(carriage, tool); }}};
  for (const auto& [lever, geometry] : levers) {
    for (const int feed : {2, 8}) {
      FaceFile file;
      file.path = directory / ("paper-600mm-" + lever + "-feed" + std::to_string(feed) + ".csv");
      file.comment = "face over the full travel, " + std::to_string(feed) +
                     " mm/min at 110 rpm, lever \"" + lever + "\"";
      file.cut.radius_mm = 600.0;
      file.cut.feed_mm_per_min = feed;
      file.cut.nose_radius_mm = 0.4;
      file.error = sum({geometry, forced_vibration(0.6 * kMicrometre, 183.05),
                        random_vibration(0.1 * kMicrometre, 0.0, 600 + feed)});
      file.positions = grid(20000, 3, 100);
      file.stylus.offset_mm = 0.5 * kMicrometre;
      file.stylus.noise = {
          .white = 0.02 * kMicrometre, .correlated = 0.01 * kMicrometre, .correlation_mm = 0.1};
      write_face(file, 600 + feed);
    }
  }
}

/// The slide of these faces before an autocollimator: a mirror every 10 mm, read to 0.01 arcsec.
void paper_autocollimator(const std::filesystem::path& directory) {
  constexpr double kArcsec = 4.84813681109536e-6;  // rad
  const std::vector<double> positions = grid(61, 10, 1);
  Pass pass;
  pass.noise = {.white = 0.01 * kArcsec, .quantum = 0.01 * kArcsec};
  RandomStream random(61, "autocollimator");
  const Error slide = [](const ToolPoint& tool) { return polynomial(kStraightness, tool.x); };
  std::vector<double> slopes = slide_slopes(slide, positions, 10.0, pass, random);
  for (double& slope : slopes) slope /= kArcsec;
  write_csv(directory / "paper-autocollimator.csv",
            "slopes of the X slide on a base of 10 mm, 61 readings over 600 mm",
            {{"x_mm", positions, 0}, {"slope_arcsec", slopes, 2}});
}

/// The workpiece that was cut: 20 mm across, 2 µm of form at its rim, which takes a cone of 2e-4
/// rad.
void paper_face_10mm(const std::filesystem::path& directory) {
  const Carriage carriage{kStraightness, {}, 2.0e-4, 0.0, 0.0};
  for (const int feed : {2, 8}) {
    FaceFile file;
    file.path = directory / ("paper-face-10mm-feed" + std::to_string(feed) + ".csv");
    file.comment = "diameter trace of a 20 mm face, " + std::to_string(feed) + " mm/min at 110 rpm";
    file.cut.radius_mm = 10.0;
    file.cut.feed_mm_per_min = feed;
    file.cut.nose_radius_mm = 1.0;
    file.error = sum({[=](const ToolPoint& tool) { return two_levers(carriage, tool); },
                      forced_vibration(0.15 * kMicrometre, 183.05),
                      random_vibration(0.05 * kMicrometre, 0.0, 10 + feed)});
    file.positions = grid(20000, 1, 1000);
    file.position_decimals = 3;
    file.stylus.center_mm = 10.0;
    file.stylus.offset_mm = 0.9 * kMicrometre;
    file.stylus.tilt = 2.0e-6 * feed;
    file.stylus.noise = {
        .white = 0.003 * kMicrometre, .correlated = 0.01 * kMicrometre, .correlation_mm = 0.1};
    write_face(file, 10 + feed);
  }
}

/// One machine, six faces: three Z levels with one lever, and three faces with two overhangs.
void three_levels(const std::filesystem::path& directory) {
  struct Level {
    std::string name;
    double z_mm, overhang_mm;
    bool split;
  };
  const std::vector<Level> levels = {
      {"three-levels-z0", 0.0, 0.0, false},       {"three-levels-z50", 50.0, 0.0, false},
      {"three-levels-z100", 100.0, 0.0, false},   {"two-overhangs-50-z0", 0.0, 50.0, true},
      {"two-overhangs-150-z0", 0.0, 150.0, true}, {"two-overhangs-150-z100", 100.0, 150.0, true}};
  std::uint64_t seed = 400;
  for (const Level& level : levels) {
    ++seed;
    const Carriage carriage{{0.0, 0.0, 1.0e-7, -1.5e-9},
                            {0.0, 3.0e-6, 5.0e-8, -2.0e-10},
                            5.0e-6,
                            level.z_mm,
                            level.overhang_mm};
    const bool split = level.split;
    FaceFile file;
    file.path = directory / (level.name + ".csv");
    file.comment = "face of 50 mm radius at z = " + fixed(level.z_mm, 0) + " mm" +
                   (split ? ", overhang " + fixed(level.overhang_mm, 0) + " mm" : "");
    file.cut.radius_mm = 50.0;
    file.cut.feed_mm_per_min = 10.0;
    file.cut.spindle_rpm = 500.0;
    file.error = sum({[=](const ToolPoint& tool) {
                        return split ? two_levers(carriage, tool) : one_lever(carriage, tool);
                      },
                      random_vibration(0.005 * kMicrometre, 0.0, seed)});
    file.positions = grid(5000, 1, 100);
    file.stylus.offset_mm = (0.3 + 0.1 * static_cast<double>(seed % 7)) * kMicrometre;
    file.stylus.noise = {
        .white = 0.003 * kMicrometre, .correlated = 0.002 * kMicrometre, .correlation_mm = 0.5};
    write_face(file, seed);
  }
}

/// What a sensor in the spindle's housing shows, degC: two time constants of warming up, and
/// coolant from 250 to 480 s and from 700 s on.
double spindle_temperature(double t) {
  double out = 20.0 + 2.0 * (1.0 - std::exp(-t / 45.0)) + 3.0 * (1.0 - std::exp(-t / 400.0));
  for (const auto& [time, sign] :
       {std::pair(250.0, -1.0), std::pair(480.0, 1.0), std::pair(700.0, -1.0)})
    if (t > time) out += sign * 1.5 * (1.0 - std::exp(-(t - time) / 30.0));
  return out;
}

/// Three faces cut one after another while the spindle grows by 0.2 µm/degC, 15 s after the sensor.
void coolant(const std::filesystem::path& directory) {
  constexpr double kLast = 1000.0, kStep = 0.25, kLag = 15.0;  // s
  constexpr double kGrowth = 0.2 * kMicrometre;                // per degC
  std::vector<double> growth{0.0};                             // at 0, kStep, ...
  for (double t = 0.0; t < kLast; t += kStep) {
    const double due = kGrowth * (spindle_temperature(t + kStep / 2.0) - 20.0);
    growth.push_back(due + (growth.back() - due) * std::exp(-kStep / kLag));
  }
  const Error warm = [growth](const ToolPoint& tool) {
    return growth.at(static_cast<std::size_t>(std::max(tool.t, 0.0) / kStep));
  };
  const Carriage carriage{{0.0}, {}, 2.0e-5, 0.0, 0.0};
  const std::vector<Cut> cuts = {{.feed_mm_per_min = 2.0},
                                 {.feed_mm_per_min = 8.0, .start_s = 400.0},
                                 {.feed_mm_per_min = 2.0, .inward = false, .start_s = 600.0}};
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    FaceFile file;
    file.path = directory / ("coolant-cut" + std::to_string(i + 1) + ".csv");
    file.comment = "face of 10 mm radius, begun at " + fixed(cuts[i].start_s, 0) + " s";
    file.cut = cuts[i];
    file.cut.nose_radius_mm = 50.0;
    file.error = sum({[=](const ToolPoint& tool) { return two_levers(carriage, tool); }, warm});
    file.positions = grid(1001, 1, 100);
    file.stylus.offset_mm = 0.3 * kMicrometre;
    file.stylus.noise = {
        .white = 0.005 * kMicrometre, .correlated = 0.01 * kMicrometre, .correlation_mm = 0.1};
    write_face(file, 700 + i);
  }
  Column time{"t_s", {}, 0}, temperature{"T_degC", {}, 2};
  RandomStream random(700, "sensor");
  for (int t = 0; t <= static_cast<int>(kLast); t += 2) {
    time.values.push_back(t);
    temperature.values.push_back(spindle_temperature(t) + 0.02 * random.normal());
  }
  write_csv(directory / "coolant-log.csv", "sensor in the spindle's housing", {time, temperature});
}

/// Errors of the axes of a three-axis machine along a path of 500 mm and a signal they make: mostly
/// Y, a part of X, hardly Z (the order of Fig. 11). µm
void axis_ranking(const std::filesystem::path& directory) {
  const std::vector<double> positions = grid(2048, 1, 4);
  constexpr double kTurn = 6.283185307179586;
  Column x{"error_x", {}, 4}, y{"error_y", {}, 4}, z{"error_z", {}, 4};
  Column measured{"measured", {}, 4};
  RandomStream random(11, "axis-ranking");
  for (const double s : positions) {
    const double u = s / 512.0;
    x.values.push_back(1.5 * u - 0.4 * u * u + 0.2 * std::cos(kTurn * s / 90.0));
    y.values.push_back(polynomial(std::array{0.0, -2.0, 6.5, -2.0}, u) +
                       0.15 * std::cos(kTurn * s / 40.0));
    z.values.push_back(0.8 * std::cos(kTurn * 1.5 * u) + 0.3 * std::sin(kTurn * s / 25.0));
    measured.values.push_back(0.4 * x.values.back() + y.values.back() + 0.15 * z.values.back() +
                              0.4 * random.normal());
  }
  write_csv(directory / "axis-ranking.csv",
            "errors of three axes and a signal made of them, micrometres",
            {{"position_mm", positions, 2}, measured, x, y, z});
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: make_data OUTDIR\n";
    return 2;
  }
  try {
    const std::filesystem::path directory = argv[1];
    std::filesystem::create_directories(directory);
    paper_600mm(directory);
    paper_autocollimator(directory);
    paper_face_10mm(directory);
    three_levels(directory);
    axis_ranking(directory);
    coolant(directory);
  } catch (const std::exception& error) {
    std::cerr << "make_data: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
