#include <algorithm>
#include <cmath>

#include "../linear_effect.hpp"
#include "../locus.hpp"
#include "../request.hpp"
#include "../variable_range.hpp"

namespace slideway {
namespace {

constexpr double kNarrowest = 2.0;     // stations: the half-width of what still has a form
constexpr double kWidest = 0.25;       // of the travel; a wider one is the straightness itself
constexpr double kWidthRatio = 2.0;    // from one width of the search to the next
constexpr double kNarrowestMm = 1e-3;  // of the problem file
constexpr double kWidestMm = 1e4;
constexpr double kFarthestMm = 1e9;

constexpr double kReach = 10.0;  // widths: exp(-50) is below the rounding of what lies beside it

// exp(-u²/2), exactly 0 far away.
Eigen::ArrayXd gaussian(const Eigen::ArrayXd& u) {
  return (u.abs() < kReach).select((-0.5 * u.square()).exp(), 0.0);
}

Description describe_local_form() {
  return {.name = "local_form",
          .plain_name = "local form",
          .standard_name = "E_ZX, local straightness error of X (ISO 230-1)",
          .formula = "A exp(-(x - x_0)²/(2 w²))",
          .source = "a deviation of the way at one place; Gaussian, so that it has no other end",
          .cause =
              "a joint, a worn zone, a dent or a clamp of the way; on a face also a hard spot "
              "or a pause of the cut",
          .typical = "0.1 to 5 µm over 5 to 100 mm of the way",
          .variable = IndependentVariable::slide,
          .confounded_with =
              "step if its flank alone is seen, slide_periodic over one period, "
              "edge_roll_off at the rim, the straightness polynomial if it is wide",
          .confounded_effects = {"step", "slide_periodic", "edge_roll_off", "straightness"},
          .separated_by =
              "the face cut at another place of the slide: a form of the way stays at "
              "its x; a reading along the slide itself"};
}

class LocalForm : public LinearEffect {
 public:
  LocalForm()
      : LinearEffect(describe_local_form(),
                     {{"amplitude_um", "A", "µm", 0.1},
                      {"position_mm", "x_0", "mm", 1.0, -kFarthestMm, kFarthestMm},
                      {"width_mm", "w", "mm", 1.0, kNarrowestMm, kWidestMm}},
                     diagonal_map(1, kMicrometre),
                     {{.parameter = 1}, {.parameter = 2, .logarithmic = true}}) {}

  [[nodiscard]] bool applies_to(const Setup& setup) const override { return sees_carriage(setup); }

  [[nodiscard]] std::pair<double, double> search_range(int shape,
                                                       const Stations& stations) const override {
    const VariableRange range = range_of(stations, slide_of);
    if (shape == 0) return {range.low + range.step, range.high - range.step};
    return within_bounds({kNarrowest * range.step, kWidest * range.extent()}, parameters()[2]);
  }

  [[nodiscard]] double resolution(int shape, double value,
                                  const Stations& stations) const override {
    return shape == 0 ? search_range(1, stations).first : (kWidthRatio - 1.0) * value;
  }

  void columns(const Stations& stations, std::span<const double> shape,
               Eigen::Ref<Eigen::MatrixXd> out) const override {
    const double place = shape[0], width = shape[1];
    const auto bump = [=](const Eigen::ArrayXd& x, Eigen::ArrayXXd& value, Eigen::ArrayXXd& slope) {
      const Eigen::ArrayXd u = (x - place) / width;
      value.col(0) = gaussian(u);
      slope.col(0) = -u / width * value.col(0);
    };
    fill_from_locus(stations, height_only(), bump, out);
  }

  void derivatives(const Stations& stations, std::span<const double> shape,
                   Eigen::Ref<Eigen::MatrixXd> out) const override {
    const double place = shape[0], width = shape[1];
    const auto change = [=](const Eigen::ArrayXd& x, Eigen::ArrayXXd& value,
                            Eigen::ArrayXXd& slope) {
      const Eigen::ArrayXd u = (x - place) / width, bump = gaussian(u);
      value << bump * u / width, bump * u.square() / width;
      slope << bump * (1.0 - u.square()) / (width * width),
          bump * u * (2.0 - u.square()) / (width * width);
    };
    fill_from_locus(stations, height_only(), change, out);
  }
};

}  // namespace

std::unique_ptr<Effect> make_local_form(const Request& request) {
  request.accept_only({});
  return std::make_unique<LocalForm>();
}

}  // namespace slideway
