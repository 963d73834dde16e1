#include "identify/cases.hpp"
#include "identify/simulations.hpp"
#include "support/turning.hpp"

namespace slideway::simulations {
namespace {

const std::vector<double> kStraightness{0.0, 0.0, 2.3e-8, -1e-9, 2e-10, 1e-11};
constexpr double kSquareness = 2e-5;
constexpr double kRate = 0.01;  // µm/min

struct OneCut {
  double feed_mm_per_min = 2.0;
  bool inward = true;
  double z_mm = 0.0;
  double noise_mm = 5e-5;  // of one sample
};

struct Faces {
  std::string name;
  Lever lever = Lever::paper;
  int degree = 3;
  int level = 3;
  double radius_mm = 10.0, spindle_rpm = 110.0, overhang_mm = 0.0;
  std::vector<OneCut> cuts{{}};
  bool drift = false;                 // in the machine and in the model
  std::vector<double> c{};            // of the Z carriage, as well
  double noise_correlation_mm = 0.0;  // 0: white
  bool gaps = false;                  // samples missing: one of fifty, and a seventh of the radius
};

std::map<std::string, double> truth(const Faces& faces) {
  std::map<std::string, double> out{{"squareness.dbeta_xz", kSquareness},
                                    {"linear_drift.rate_um_per_min", kRate}};
  for (int k = 0; k <= faces.degree; ++k)
    out["straightness.b" + std::to_string(k)] = kStraightness[k];
  for (std::size_t k = 1; k < faces.c.size(); ++k)
    out["vertical_straightness.c" + std::to_string(k)] = faces.c[k];
  return out;
}

turning::Face cut(const Faces& faces, const OneCut& one) {
  turning::Carriage carriage;
  carriage.b.assign(kStraightness.begin(), kStraightness.begin() + faces.degree + 1);
  carriage.c = faces.c;
  carriage.squareness = kSquareness;
  carriage.z_mm = one.z_mm;
  carriage.overhang_mm = faces.overhang_mm;
  const auto error = [&](const turning::ToolPoint& tool) {
    const double drift = faces.drift ? kRate * 1e-3 * tool.t / 60.0 : 0.0;
    return drift + (faces.lever == Lever::paper ? turning::one_lever(carriage, tool)
                                                : turning::two_levers(carriage, tool));
  };
  turning::Cut out;
  out.radius_mm = faces.radius_mm;
  out.spindle_rpm = faces.spindle_rpm;
  out.feed_mm_per_min = one.feed_mm_per_min;
  out.inward = one.inward;
  return {out, error};
}

void lose_samples(double radius_mm, RandomStream& random, Profile& profile) {
  std::vector<double> positions, values;
  for (std::size_t i = 0; i < profile.positions.size(); ++i) {
    const double r = profile.positions[i] / radius_mm;
    const bool inside = i > 0 && i + 1 < profile.positions.size();
    if (inside && (random.uniform() < 0.02 || (r > 0.3 && r < 0.443))) continue;
    positions.push_back(profile.positions[i]);
    values.push_back(profile.values[i]);
  }
  profile.positions = std::move(positions);
  profile.values = std::move(values);
}

std::vector<Profile> measure(const Faces& faces, const std::vector<turning::Face>& surfaces,
                             RandomStream& random) {
  const std::vector<double> positions = cases::spaced(0.0, faces.radius_mm, 4000);
  std::vector<Profile> out;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const OneCut& one = faces.cuts[i];
    turning::Stylus stylus;
    stylus.offset_mm = 1e-3;
    const bool correlated = faces.noise_correlation_mm > 0.0;
    (correlated ? stylus.noise.correlated : stylus.noise.white) = one.noise_mm;
    stylus.noise.correlation_mm = faces.noise_correlation_mm;
    out.push_back(cases::face("face" + std::to_string(i), one.feed_mm_per_min, positions,
                              turning::trace(surfaces[i], positions, stylus, random)));
    if (faces.gaps) lose_samples(faces.radius_mm, random, out.back());
    Setup& setup = out.back().setup;
    setup.spindle_rpm = faces.spindle_rpm;
    setup.overhang_mm = faces.overhang_mm;
    setup.z_mm = one.z_mm;
    setup.cut_direction = one.inward ? CutDirection::inward : CutDirection::outward;
  }
  return out;
}

Problem declared(const Faces& faces) {
  std::vector<DeclaredEffect> effects{cases::effect("squareness"),
                                      cases::effect("straightness", faces.degree)};
  if (faces.drift) effects.push_back(cases::effect("linear_drift"));
  if (!faces.c.empty())
    effects.push_back(cases::effect("vertical_straightness", static_cast<int>(faces.c.size()) - 1));
  return cases::problem(faces.lever, faces.level, std::move(effects));
}

Simulation simulation(const Faces& faces) {
  return {.name = faces.name,
          .problem = declared(faces),
          .truth = truth(faces),
          .correlated = faces.noise_correlation_mm > 0.0,
          .determined = static_cast<std::size_t>(faces.degree),
          .prepare = [faces]() -> Measure {
            std::vector<turning::Face> surfaces;
            for (const OneCut& one : faces.cuts) surfaces.push_back(cut(faces, one));
            return [faces, surfaces](RandomStream& random) {
              return measure(faces, surfaces, random);
            };
          }};
}

}  // namespace

// Low-band values lie 20 µm (radius 10 mm, level 3), 80 µm (level 5) or 200 µm (radius 50 mm, level
// 4) apart: the correlated noise reaches over four of them. A groove is 18 µm wide at 110 rpm, 4 to
// 16 µm at 500 rpm: no wider than what is averaged.
std::vector<Simulation> of_faces() {
  std::vector<Simulation> out;
  for (const Faces& faces :
       {Faces{.name = "OneLeverCorrelated", .degree = 5, .noise_correlation_mm = 0.08},
        Faces{.name = "FewValuesCorrelated", .level = 5, .noise_correlation_mm = 0.32},
        Faces{.name = "OneLeverWhite", .degree = 4},
        Faces{.name = "GapsCorrelated", .degree = 4, .noise_correlation_mm = 0.08, .gaps = true},
        Faces{.name = "SplitLeverCorrelated",
        .lever = Lever::split,
        .overhang_mm = 50.0,
        .noise_correlation_mm = 0.08},
        Faces{.name = "TwoFeedsCorrelated",
        .degree = 4,
        .level = 4,
        .radius_mm = 50.0,
        .spindle_rpm = 500.0,
        .cuts = {{.feed_mm_per_min = 2.0}, {.feed_mm_per_min = 8.0}},
        .drift = true,
        .noise_correlation_mm = 0.8},
        Faces{.name = "ThreeFeedsWhite",
        .spindle_rpm = 500.0,
        .cuts = {{.feed_mm_per_min = 2.0}, {.feed_mm_per_min = 4.0}, {.feed_mm_per_min = 8.0}},
        .drift = true},
        Faces{.name = "BothDirectionsWhite",
        .degree = 4,
        .spindle_rpm = 500.0,
        .cuts = {{.inward = true}, {.inward = false}},
        .drift = true},
        Faces{.name = "ThreeLevelsOfZ",
        .spindle_rpm = 500.0,
        .cuts = {{.z_mm = 0.0}, {.z_mm = 40.0}, {.z_mm = 80.0}},
        .c = {0.0, 1e-6, 3e-8}},
        Faces{.name = "OneCutThreeTimesAsNoisy",
        .degree = 4,
        .spindle_rpm = 500.0,
        .cuts = {{.feed_mm_per_min = 2.0, .noise_mm = 15e-5}, {.feed_mm_per_min = 4.0}},
        .drift = true}})
    out.push_back(simulation(faces));
  return out;
}

}  // namespace slideway::simulations
