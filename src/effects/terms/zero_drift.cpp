#include "../linear_effect.hpp"
#include "../request.hpp"
#include "../variable_range.hpp"

namespace slideway {
namespace {

Description describe_zero_drift() {
  return {.name = "zero_drift",
          .plain_name = "drift of the instrument's zero",
          .standard_name = "drift of the instrument's zero (VIM 4.21, instrumental drift)",
          .formula = "±a t_read, - where the reading is reversed",
          .source = "VIM 4.21; ISO 230-1, repeated and reversed readings",
          .cause =
              "the level, the autocollimator or the gauge warms, its stand creeps, its "
              "electronics settle while station after station is read",
          .typical = "0.01 to 1 µrad/min (levels, autocollimators), 1 to 50 nm/min (gauges)",
          .variable = IndependentVariable::reading_time,
          .confounded_with =
              "read at an even pace in one direction: the tilt of a height, b_2 of "
              "straightness of a slope (both exactly)",
          .confounded_effects = {"straightness"},
          .separated_by =
              "reading there and back: the form repeats, the drift goes on; reading "
              "the first station again at the end",
          .of_instrument = true};
}

class ZeroDrift : public LinearEffect {
 public:
  explicit ZeroDrift(const TravelRange& range)
      : LinearEffect(describe_zero_drift(),
                     {{"rate_per_min", "a", "µm/min, slope: µrad/min", 0.01}},
                     diagonal_map(1, 1.0)),
        start_s_(range.read_from_s) {}

  [[nodiscard]] bool applies_to(const Setup& /*setup*/) const override { return true; }

  void columns(const Stations& stations, std::span<const double> /*shape*/,
               Eigen::Ref<Eigen::MatrixXd> out) const override {
    const Setup& setup = stations.setup();
    const double unit =
        sign_of_instrument(setup) * (is_height(setup) ? kMicrometre : kMicroradian) / kMinute;
    for (Eigen::Index i = 0; i < stations.size(); ++i)
      out(i, 0) = unit * (stations.reading_time(i) - start_s_);
  }

 private:
  double start_s_;
};

}  // namespace

std::unique_ptr<Effect> make_zero_drift(const Request& request) {
  request.accept_only({});
  return std::make_unique<ZeroDrift>(request.range);
}

}  // namespace slideway
