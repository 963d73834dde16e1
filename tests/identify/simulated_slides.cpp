#include <cmath>
#include <numbers>

#include "identify/cases.hpp"
#include "identify/simulations.hpp"
#include "slideway/effects/formula.hpp"
#include "support/turning.hpp"

namespace slideway::simulations {
namespace {

constexpr double kLength = 400.0;  // mm
constexpr double kTurn = 2.0 * std::numbers::pi;
const std::vector<double> kStraightness{0.0, 0.0, 5e-8, -2e-10, 1e-12, -4e-15};

/// One reading of the slide.
struct Reading {
  std::size_t stations = 201;
  double base_mm = 0.0;  // 0: heights
  double feed_mm_per_min = 600.0;
  bool outward = true;
  double noise = 1e-4;          // mm; µrad * 1e-6 of slopes
  double correlation_mm = 0.0;  // 0: white
  bool declared = false;        // its uncertainty
  double spindle_rpm = 0.0;
};

/// A slide with a straightness and one more effect or none.
struct Slide {
  std::string name;
  int degree = 3;
  std::vector<Reading> readings{{}};
  std::optional<DeclaredEffect> more{};
  std::map<std::string, double> parameters{};  // of that effect
  turning::Error error{};                      // what it does, mm
};

std::vector<Profile> measure(const Slide& slide, RandomStream& random) {
  const std::vector<double> b(kStraightness.begin(), kStraightness.begin() + slide.degree + 1);
  const turning::Error error = [&](const turning::ToolPoint& tool) {
    return turning::polynomial(b, tool.x) + (slide.error ? slide.error(tool) : 0.0);
  };
  std::vector<Profile> out;
  for (const Reading& reading : slide.readings) {
    turning::Pass pass;
    pass.feed_mm_per_min = reading.feed_mm_per_min;
    pass.outward = reading.outward;
    pass.spindle_rpm = reading.spindle_rpm;
    pass.zero = 2e-5;
    pass.noise.correlation_mm = reading.correlation_mm;
    (reading.correlation_mm > 0.0 ? pass.noise.correlated : pass.noise.white) = reading.noise;
    const double half = 0.5 * reading.base_mm;
    const std::vector<double> positions = cases::spaced(half, kLength - half, reading.stations);
    const bool slopes = reading.base_mm > 0.0;
    Profile profile = cases::profile(
        "reading" + std::to_string(out.size()), Kind::slide, positions,
        slopes ? turning::slide_slopes(error, positions, reading.base_mm, pass, random)
               : turning::slide_heights(error, positions, pass, random));
    Setup& setup = profile.setup;
    setup.feed_mm_per_min = reading.feed_mm_per_min;
    setup.cut_direction = reading.outward ? CutDirection::outward : CutDirection::inward;
    if (reading.spindle_rpm > 0.0) setup.spindle_rpm = reading.spindle_rpm;
    if (slopes) {
      setup.quantity = Quantity::slope;
      setup.base_mm = reading.base_mm;
      setup.first_mm = 0.0;
      setup.last_mm = kLength;
    }
    profile.free_tilt = false;
    if (reading.declared) profile.standard_uncertainty = reading.noise;
    out.push_back(std::move(profile));
  }
  return out;
}

Simulation simulation(const Slide& slide) {
  Simulation out;
  out.name = slide.name;
  std::vector<DeclaredEffect> effects{cases::effect("straightness", slide.degree)};
  if (slide.more) effects.push_back(*slide.more);
  out.problem = cases::problem(Lever::paper, 0, std::move(effects));
  for (int k = 0; k <= slide.degree; ++k)
    out.truth["straightness.b" + std::to_string(k)] = kStraightness[k];
  for (const auto& [name, value] : slide.parameters)
    out.truth[slide.more->name + '.' + name] = value;
  // Heights leave b0 open, slopes b1 as well.
  const std::size_t open = slide.readings.front().base_mm > 0.0 ? 2 : 1;
  out.determined = static_cast<std::size_t>(slide.degree) + 1 - open + slide.parameters.size();
  for (const Reading& reading : slide.readings)
    out.correlated = out.correlated || reading.correlation_mm > 0.0;
  out.prepare = [slide]() -> Measure {
    return [slide](RandomStream& random) { return measure(slide, random); };
  };
  return out;
}

DeclaredEffect bump() {
  DeclaredEffect out = cases::effect("bump");
  out.options.own = formula_effect(
      {.name = "bump",
       .text = "a * exp(-((x - x0) / w)^2)",
       .parameters = {{"a", "um", {}, {}}, {"x0", "mm", 20.0, 380.0}, {"w", "mm", 10.0, 100.0}}});
  return out;
}

}  // namespace

std::vector<Simulation> of_slides() {
  const std::vector<Slide> slides{
      {.name = "HeightsWhite", .degree = 5},
      {.name = "HeightsCorrelated", .readings = {{.correlation_mm = 6.0}}},
      // Ten places, three coefficients and the zero of the instrument.
      {.name = "TenStations", .readings = {{.stations = 10}}},
      {.name = "OfTwoDeclaredPrecisions",
       .readings = {{.declared = true}, {.noise = 4e-4, .declared = true}}},
      {.name = "LevelOnABase",
       .degree = 4,
       .readings = {{.stations = 41, .base_mm = 50.0, .noise = 2e-6}}},
      {.name = "LevelThreeTimes",
       .degree = 4,
       .readings = {{.stations = 31, .base_mm = 100.0, .noise = 2e-6},
                    {.stations = 31, .base_mm = 100.0, .noise = 2e-6},
                    {.stations = 31, .base_mm = 100.0, .noise = 2e-6}}},
      {.name = "WaveAlongTheSlide",
       .readings = {{}, {}},
       .more = cases::effect("slide_periodic"),
       .parameters = {{"amplitude_um", 0.4}, {"period_mm", 60.0}, {"phase_rad", 0.7}},
       .error =
           [](const turning::ToolPoint& tool) {
             return 4e-4 * std::cos(kTurn * tool.x / 60.0 + 0.7);
           }},
      {.name = "WarmUpThereAndBack",
       .readings = {{.feed_mm_per_min = 100.0}, {.feed_mm_per_min = 100.0, .outward = false}},
       .more = cases::effect("thermal_drift"),
       .parameters = {{"amplitude_um", 2.0}, {"time_constant_s", 60.0}},
       .error = [](const turning::ToolPoint& tool) { return 2e-3 * -std::expm1(-tool.t / 60.0); }},
      {.name = "DriftAtTwoFeeds",
       .readings = {{.feed_mm_per_min = 100.0}, {.feed_mm_per_min = 400.0}},
       .more = cases::effect("linear_drift"),
       .parameters = {{"rate_um_per_min", 0.2}},
       .error = [](const turning::ToolPoint& tool) { return 0.2e-3 * tool.t / 60.0; }},
      {.name = "BumpOfAFormula",
       .readings = {{}, {}},
       .more = bump(),
       .parameters = {{"a", 1.0}, {"x0", 150.0}, {"w", 30.0}},
       .error = [](const turning::ToolPoint& tool) {
         return 1e-3 * std::exp(-std::pow((tool.x - 150.0) / 30.0, 2));
       }}};
  std::vector<Simulation> out;
  for (const Slide& slide : slides) out.push_back(simulation(slide));
  return out;
}

}  // namespace slideway::simulations
