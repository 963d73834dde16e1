#pragma once

#include <memory>
#include <string>
#include <vector>

#include "slideway/effects/catalogue.hpp"

namespace slideway::testing_support {

inline std::vector<double> spaced(double first, double last, int count) {
  std::vector<double> positions;
  for (int i = 0; i < count; ++i) positions.push_back(first + (last - first) * i / (count - 1));
  return positions;
}

inline Setup setup_of(Kind kind, Quantity quantity, double first, double last) {
  Setup setup;
  setup.kind = kind;
  setup.quantity = quantity;
  setup.spindle_position_mm = kind == Kind::face ? 360.0 : 0.0;
  setup.z_mm = 80.0;
  setup.overhang_mm = 25.0;
  setup.feed_mm_per_min = 2.0;
  setup.spindle_rpm = 110.0;
  setup.cut_direction = CutDirection::inward;
  if (kind == Kind::face) setup.cut_radius_mm = 10.0;
  setup.traverse_mm_per_s = 0.5;
  // Read from the far end, faster and faster, on a clock that ran before.
  ReadingTimes times;
  for (int i = 0; i <= 4; ++i) {
    times.positions_mm.push_back(first + (last - first) * i / 4.0);
    times.times_s.push_back(1000.0 - 50.0 * i - 5.0 * i * i);
  }
  setup.reading_times = std::make_shared<const ReadingTimes>(std::move(times));
  setup.first_mm = first;
  setup.last_mm = last;
  return setup;
}

// A profile with everything an effect may ask for.
struct Case {
  std::string name;
  Setup setup;
  std::vector<double> positions;
};

inline std::vector<Case> all_cases() {
  std::vector<Case> cases;
  // 53 stations: the spacing shares no factor with grooves or periods, r = 0 and the rim included.
  cases.push_back(
      {"face inward", setup_of(Kind::face, Quantity::height, 0, 10), spaced(0, 10, 53)});
  cases.push_back(cases[0]);
  cases[1].name = "face outward";
  cases[1].setup.cut_direction = CutDirection::outward;
  cases.push_back(
      {"diameter", setup_of(Kind::face, Quantity::height, -10, 10), spaced(-10, 10, 53)});
  cases.push_back(
      {"slide height", setup_of(Kind::slide, Quantity::height, 0, 600), spaced(0, 600, 53)});
  cases.push_back(
      {"slide slope", setup_of(Kind::slide, Quantity::slope, 0, 600), spaced(0, 600, 53)});
  cases.push_back(cases.back());
  cases.back().name = "slide slope over a base";
  cases.back().setup.base_mm = 10.0;
  cases.push_back(cases.back());
  cases.back().name = "slide slope over a base, reversed";
  cases.back().setup.reversed = true;
  return cases;
}

inline const Machine& lathe(Lever lever = Lever::paper) {
  static const Machine kPaper(Machine::paper_lathe(), Lever::paper);
  static const Machine kSplit(Machine::paper_lathe(), Lever::split);
  return lever == Lever::paper ? kPaper : kSplit;
}

inline const TravelRange kTravel{.slide_min = 0.0, .slide_max = 600.0, .z_min = 0.0, .z_max = 80.0};

// The effect with the options it needs, and no others.
inline std::unique_ptr<Effect> make(const std::string& name, const TravelRange& range = kTravel,
                                    Lever lever = Lever::paper, int degree = 5) {
  EffectOptions options;
  if (name == "straightness" || name == "vertical_straightness" || name == "artefact_form")
    options.degree = degree;
  if (name == "gantry_sag") options.span_mm = 700.0;
  return make_effect(name, options, lathe(lever), range);
}

inline Eigen::MatrixXd columns(const Effect& effect, const Case& profile,
                               std::span<const double> shape = {}, Lever lever = Lever::paper) {
  const Stations stations(profile.positions, profile.setup, lathe(lever));
  Eigen::MatrixXd out(stations.size(), effect.amplitudes());
  effect.columns(stations, shape, out);
  return out;
}

// Height (or slope) of an effect whose parameters have these values.
inline Eigen::VectorXd signal(const Effect& effect, const Case& profile,
                              const Eigen::VectorXd& values, Lever lever = Lever::paper) {
  const Eigen::VectorXd inner = effect.from_parameters(values);
  const Eigen::Index linear = effect.amplitudes();
  const std::vector<double> shape(inner.data() + linear, inner.data() + inner.size());
  return columns(effect, profile, shape, lever) * inner.head(linear);
}

}  // namespace slideway::testing_support
