// An effect of one's own: the teeth of a rack, h = A (x/p - floor(x/p) - 1/2) with the pitch p of
// this lathe. The loop is asked for it in faces to which it has been added.
#include <cmath>
#include <iostream>

#include "slideway/trace/analysis.hpp"

namespace {

constexpr double kPitch = 12.0;  // mm

double tooth(double x) { return x / kPitch - std::floor(x / kPitch) - 0.5; }

class RackTeeth : public slideway::Effect {
 public:
  const slideway::Description& description() const override { return description_; }
  const std::vector<slideway::Parameter>& parameters() const override { return parameters_; }
  int amplitudes() const override { return 1; }
  const std::vector<slideway::Shape>& shapes() const override { return shapes_; }

  bool applies_to(const slideway::Setup& setup) const override {
    return setup.quantity == slideway::Quantity::height;
  }

  // mm of height for each mm of amplitude.
  void columns(const slideway::Stations& stations, std::span<const double>,
               Eigen::Ref<Eigen::MatrixXd> out) const override {
    for (Eigen::Index i = 0; i < stations.size(); ++i) out(i, 0) = tooth(stations.slide(i));
  }

  // µm outside, mm inside.
  slideway::ParameterValues parameter_values(const Eigen::VectorXd& amplitudes,
                                             std::span<const double>) const override {
    return {amplitudes / slideway::kMicrometre,
            Eigen::MatrixXd::Constant(1, 1, 1.0 / slideway::kMicrometre)};
  }
  Eigen::VectorXd from_parameters(const Eigen::VectorXd& values) const override {
    return values * slideway::kMicrometre;
  }

 private:
  slideway::Description description_{.name = "rack_teeth",
                                     .standard_name = "E_ZX, periodic part (ISO 230-1)",
                                     .formula = "A (x/p - floor(x/p) - 1/2), p = 12 mm",
                                     .source = "drawing of the rack",
                                     .cause = "the pinion climbs and drops once a tooth",
                                     .typical = "0.1 to 0.5 µm",
                                     .variable = slideway::IndependentVariable::slide};
  std::vector<slideway::Parameter> parameters_{{"amplitude_um", "A", "µm", 0.1}};
  std::vector<slideway::Shape> shapes_;
};

}  // namespace

int main(int, char** argv) try {
  slideway::Problem problem = slideway::read_problem(argv[1]);
  look_for({"rack_teeth",
            {.own = [](const slideway::Machine&,
                       const slideway::TravelRange&) { return std::make_unique<RackTeeth>(); }},
            {}},
           problem);

  std::vector<slideway::Profile> profiles = slideway::read_profiles(problem);
  for (slideway::Profile& profile : profiles)  // 0.5 µm of it, for the example
    for (std::size_t i = 0; i < profile.values.size(); ++i)
      profile.values[i] += 0.5e-3 * tooth(std::abs(profile.positions[i]));

  const slideway::Analysis analysis = slideway::analyse(problem, profiles);
  for (const slideway::TraceRound& round : analysis.trace->rounds)
    for (const slideway::FittedParameter& p : round.parameters)
      std::cout << p.name << " = " << *p.value << " ± " << *p.expanded_uncertainty << " " << p.unit
                << "\n";
} catch (const std::exception& error) {
  std::cerr << error.what() << "\n";
  return 1;
}
