#include "../groove.hpp"
#include "../linear_effect.hpp"
#include "../request.hpp"
#include "../variable_range.hpp"

namespace slideway {
namespace {

Description describe() {
  return {.name = "feed_marks",
          .standard_name = "kinematic roughness, scallop height f²/(8 r_ε)",
          .formula =
              "A (f/f_max)² (4u² - 1/3), u in [-1/2, 1/2] across each groove of width f; f_max the "
              "coarsest feed per turn of the problem",
          .source = "A = f²/(8 r_ε) for nose radius r_ε and feed per turn f",
          .cause = "the nose of the tool leaves one groove per turn",
          .typical =
              "8 to 83 nm at 18 µm per turn, 0.1 to 1.3 µm at 73 µm per turn (nose "
              "radius 5 to 0.5 mm)",
          .variable = IndependentVariable::revolution,
          .confounded_with =
              "nothing if the grooves are resolved; averaged over blocks "
              "of a similar width it returns as a long alias",
          .separated_by =
              "its period is exactly the feed per turn and its height goes "
              "with the square of the feed"};
}

// Parabola of the tool nose in each groove, mean zero.
double scallop(const Stations& stations, Eigen::Index i) {
  const double u = groove_at(stations, i).across;
  return 4.0 * u * u - 1.0 / 3.0;
}

class FeedMarks : public LinearEffect {
 public:
  explicit FeedMarks(double coarsest_feed_mm)
      : LinearEffect(describe(), {{"amplitude_um", "A", "µm", 0.1}}, diagonal_map(1, kMicrometre)),
        coarsest_feed_mm_(coarsest_feed_mm) {}

  [[nodiscard]] bool applies_to(const Setup& setup) const override { return is_face_height(setup); }

  void columns(const Stations& stations, std::span<const double> /*shape*/,
               Eigen::Ref<Eigen::MatrixXd> out) const override {
    if (!applies_to(stations.setup())) return void(out.setZero());
    const Setup& setup = stations.setup();
    const double feed = *setup.feed_mm_per_min / *setup.spindle_rpm;
    const double part = coarsest_feed_mm_ > 0.0 ? feed / coarsest_feed_mm_ : 1.0;
    for (Eigen::Index i = 0; i < stations.size(); ++i)
      out(i, 0) = part * part * scallop(stations, i);
  }

 private:
  double coarsest_feed_mm_;
};

}  // namespace

std::unique_ptr<Effect> make_feed_marks(const Request& request) {
  request.accept_only({});
  return std::make_unique<FeedMarks>(request.range.coarsest_feed_mm);
}

}  // namespace slideway
