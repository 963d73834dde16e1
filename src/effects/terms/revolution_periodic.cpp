#include <algorithm>
#include <cmath>

#include "../groove.hpp"
#include "../periodic_effect.hpp"
#include "../request.hpp"

namespace slideway {
namespace {

// Four values a period, as of the other laws that make lines.
double most_cycles(const Stations& stations) {
  return 0.25 / range_of(stations, revolution_of).step;
}

// One groove per turn samples a radius: above half a cycle per turn everything is an alias. A
// diameter has two, so what turns its sign from one half to the other lies below one cycle per
// turn; with fewer than two periods it would be any form of that sign.
std::pair<double, double> revolution_periodic_search(const Stations& stations) {
  const VariableRange range = range_of(stations, revolution_of);
  const double least = 0.5 / range.extent();
  if (stations.setup().kind != Kind::face) return {least, 0.5 / range.step};
  if (crosses_the_axis(stations.setup())) return {least, 1.0 - 4.0 * least};
  return {least, std::min(most_cycles(stations), 0.5)};
}

// Along a slide the lines of the first orders of a turn are its run-out (spindle_runout): a motion
// that keeps to the turn is none that does not.
bool is_of_run_out(const Stations& stations, double cycles) {
  constexpr double kOrders = 2.0, kNear = 1.0;  // cycles over the reading
  const double order = std::round(cycles);
  return stations.setup().kind == Kind::slide && order >= 1.0 && order <= kOrders &&
         std::abs(cycles - order) * range_of(stations, revolution_of).extent() < kNear;
}

class RevolutionPeriodic final : public PeriodicEffect {
 public:
  using PeriodicEffect::PeriodicEffect;

  void columns(const Stations& stations, std::span<const double> shape,
               Eigen::Ref<Eigen::MatrixXd> out) const override {
    if (is_of_run_out(stations, shape[0])) return void(out.setZero());
    PeriodicEffect::columns(stations, shape, out);
  }

  void columns_of_shapes(const Stations& stations, std::span<const std::vector<double>> shapes,
                         Eigen::Ref<Eigen::MatrixXd> out) const override {
    PeriodicEffect::columns_of_shapes(stations, shapes, out);
    for (std::size_t s = 0; s < shapes.size(); ++s)
      if (is_of_run_out(stations, shapes[s][0]))
        out.middleCols(static_cast<Eigen::Index>(2 * s), 2).setZero();
  }

  void derivatives(const Stations& stations, std::span<const double> shape,
                   Eigen::Ref<Eigen::MatrixXd> out) const override {
    if (is_of_run_out(stations, shape[0])) return void(out.setZero());
    PeriodicEffect::derivatives(stations, shape, out);
  }

  // Between the slow lines of both signs the readings of a face resolve none.
  [[nodiscard]] double resolution(int shape, double value,
                                  const Stations& stations) const override {
    const double step = PeriodicEffect::resolution(shape, value, stations);
    if (stations.setup().kind != Kind::face) return step;
    const double most = most_cycles(stations);
    const bool resolved = value + step <= most || value >= 1.0 - most;
    return resolved ? step : std::max(step, 1.0 - most - value);
  }

  [[nodiscard]] std::vector<LineBand> lines(const Stations& stations,
                                            std::span<const double> shape) const override {
    if (stations.setup().kind != Kind::face) return PeriodicEffect::lines(stations, shape);
    const double seen = std::abs(shape[0] - std::round(shape[0]));
    return PeriodicEffect::lines(stations, {&seen, 1});
  }
};

}  // namespace

std::unique_ptr<Effect> make_revolution_periodic(const Request& request) {
  request.accept_only({});
  return std::make_unique<RevolutionPeriodic>(PeriodicSpec{
      .description =
          {.name = "revolution_periodic",
           .plain_name = "axial spindle motion",
           .standard_name = "asynchronous axial error motion of the spindle (ISO 230-7)",
           .formula = "A cos(2πνk + φ), k = t rpm/60",
           .source = "ISO 230-7",
           .cause = "asynchronous motion of the spindle or vibration of the structure, "
                    "sampled once per turn by the groove",
           .typical = "5 to 30 nm",
           .variable = IndependentVariable::revolution,
           .confounded_with = "slide_periodic, time_periodic and traverse_periodic at one "
                              "feed and one traverse speed; on a radius ν stands for all its "
                              "aliases ν + 1, ν + 2, ..., on a diameter for 2 - ν, ν + 2, ...",
           .confounded_effects = {"slide_periodic", "time_periodic", "traverse_periodic"},
           .separated_by = "a second feed (the wavelength on the face is the feed per turn "
                           "over ν) and a change of spindle speed by 1 % (the alias jumps)"},
      .rate = {"cycles_per_revolution", "ν", "1", 0.1, 0.0, 1e4},
      .rate_is_period = false,
      .reading = cutting_revolution_of,
      .range = revolution_periodic_search,
      .applies_to = is_height});
}

}  // namespace slideway
