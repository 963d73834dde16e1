#include <algorithm>
#include <cmath>

#include "../locus.hpp"
#include "../periodic_effect.hpp"
#include "../request.hpp"

namespace slideway {
namespace {

std::pair<double, double> slide_periodic_search(const Stations& stations) {
  const VariableRange range = range_of(stations, slide_of);
  return {std::max(4.0 * range.step, 0.1), range.extent()};
}

// A height shows the wave itself, a slope what the locus does under its base.
class SlidePeriodic : public PeriodicEffect {
 public:
  using PeriodicEffect::PeriodicEffect;

  void columns(const Stations& stations, std::span<const double> shape,
               Eigen::Ref<Eigen::MatrixXd> out) const override {
    if (is_height(stations.setup())) return PeriodicEffect::columns(stations, shape, out);
    const double wave = 2.0 * kPi / shape[0];
    const auto line = [wave](const Eigen::ArrayXd& x, Eigen::ArrayXXd& value,
                             Eigen::ArrayXXd& slope) {
      const Eigen::ArrayXd cosine = (wave * x).cos(), sine = (wave * x).sin();
      value << cosine, sine;
      slope << -wave * sine, wave * cosine;
    };
    fill_from_locus(stations, height_only(), line, out);
  }

  void columns_of_shapes(const Stations& stations, std::span<const std::vector<double>> shapes,
                         Eigen::Ref<Eigen::MatrixXd> out) const override {
    if (is_height(stations.setup()))
      return PeriodicEffect::columns_of_shapes(stations, shapes, out);
    for (std::size_t s = 0; s < shapes.size(); ++s)
      columns(stations, shapes[s], out.middleCols(static_cast<Eigen::Index>(2 * s), 2));
  }

  void derivatives(const Stations& stations, std::span<const double> shape,
                   Eigen::Ref<Eigen::MatrixXd> out) const override {
    if (is_height(stations.setup())) return PeriodicEffect::derivatives(stations, shape, out);
    const double wave = 2.0 * kPi / shape[0];
    const double change = -wave / shape[0];  // d wave / d period
    const auto line = [=](const Eigen::ArrayXd& x, Eigen::ArrayXXd& value, Eigen::ArrayXXd& slope) {
      const Eigen::ArrayXd cosine = (wave * x).cos(), sine = (wave * x).sin();
      value << -change * x * sine, change * x * cosine;
      slope << -change * (sine + wave * x * cosine), change * (cosine - wave * x * sine);
    };
    fill_from_locus(stations, height_only(), line, out);
  }
};

}  // namespace

std::unique_ptr<Effect> make_slide_periodic(const Request& request) {
  request.accept_only({});
  return std::make_unique<SlidePeriodic>(PeriodicSpec{
      .description = {.name = "slide_periodic",
                      .plain_name = "wave along the slide",
                      .standard_name = "E_ZX, periodic straightness error motion of X (ISO 230-1)",
                      .formula = "A cos(2πx/λ + φ)",
                      .source = "effect of the guideway, periodic in the slide coordinate",
                      .cause =
                          "waviness of the rail, orifice or bolt pitch of an air bearing, pitch "
                          "of the feed screw through the force of its nut",
                      .typical = "5 to 50 nm; λ is 20 to 60 mm for bolts and orifices, 2 to 10 mm "
                                 "for a screw",
                      .variable = IndependentVariable::slide,
                      .confounded_with =
                          "the straightness polynomial when λ is longer than most of "
                          "the travel; revolution_periodic, time_periodic and "
                          "traverse_periodic at one feed and one traverse speed",
                      .confounded_effects = {"straightness", "revolution_periodic", "time_periodic",
                                             "traverse_periodic"},
                      .separated_by = "a second feed or spindle speed: λ stays as it is in mm; a "
                                      "data-sheet pitch",
                      .axisymmetric = true},
      .rate = {"period_mm", "λ", "mm", 1.0, 1e-3, 1e5},
      .rate_is_period = true,
      .reading = slide_of,
      .range = slide_periodic_search,
      .applies_to = sees_carriage});
}

}  // namespace slideway
