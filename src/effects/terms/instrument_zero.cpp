#include "../linear_effect.hpp"
#include "../request.hpp"
#include "../variable_range.hpp"

namespace slideway {
namespace {

Description describe_instrument_zero() {
  return {.name = "instrument_zero",
          .plain_name = "zero of the instrument",
          .standard_name = "zero error of the instrument (VIM 4.28)",
          .formula = "±z_0, - where the reading is reversed",
          .source = "ISO 230-1, reversal of a level by 180°",
          .cause =
              "the level reads this much where it stands level; one zero for all lines of a "
              "session",
          .typical = "5 to 100 µrad (levels)",
          .variable = IndependentVariable::trace,
          .confounded_with =
              "without a reversal b_1 of straightness; the zero that each profile "
              "has for itself unless free = []",
          .confounded_effects = {"straightness"},
          .separated_by =
              "a line read again with the level turned by 180° (reversed = true), and "
              "free = [] in all lines of the session",
          .of_instrument = true};
}

class InstrumentZero : public LinearEffect {
 public:
  InstrumentZero()
      : LinearEffect(describe_instrument_zero(), {{"zero", "z_0", "µm, slope: µrad", 1.0}},
                     diagonal_map(1, 1.0)) {}

  [[nodiscard]] bool applies_to(const Setup& setup) const override {
    return setup.kind == Kind::slide;
  }

  [[nodiscard]] std::vector<std::string> lacking_together(
      const std::vector<const Setup*>& setups) const override {
    return lacking_of_reversal(setups);
  }

  void columns(const Stations& stations, std::span<const double> /*shape*/,
               Eigen::Ref<Eigen::MatrixXd> out) const override {
    const Setup& setup = stations.setup();
    if (!applies_to(setup)) return void(out.setZero());
    out.setConstant(sign_of_instrument(setup) * (is_height(setup) ? kMicrometre : kMicroradian));
  }
};

}  // namespace

std::unique_ptr<Effect> make_instrument_zero(const Request& request) {
  request.accept_only({});
  return std::make_unique<InstrumentZero>();
}

}  // namespace slideway
