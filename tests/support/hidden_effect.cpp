#include "support/hidden_effect.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "slideway/effects/catalogue.hpp"

namespace slideway::turning {
namespace {

constexpr double kRadius = 10.0;  // mm
constexpr double kRpm = 110.0;
constexpr double kTraverse = 0.5;  // mm/s

double between(RandomStream& random, double low, double high) {
  return low + (high - low) * random.uniform();
}

double log_between(RandomStream& random, double low, double high) {
  return low * std::pow(high / low, random.uniform());
}

struct Design {
  double feed;
  bool inward;
};

constexpr std::array<Design, 3> kDesigns{{{2.0, true}, {8.0, true}, {2.0, false}}};

}  // namespace

Hidden make_hidden(const std::string& name, double A, RandomStream& random) {
  const double phase = between(random, -kPi, kPi);
  if (name == "linear_drift") return {name, [=](const ToolPoint& p) { return A * p.t / 300.0; }};
  if (name == "thermal_drift") {
    const double tau = log_between(random, 20.0, 200.0);
    return {name, [=](const ToolPoint& p) { return A * (1.0 - std::exp(-p.t / tau)); }, nullptr,
            tau};
  }
  if (name == "time_periodic") {
    const double period = log_between(random, 5.0, 80.0);
    return {name,
            [=](const ToolPoint& p) { return A * std::cos(2.0 * kPi * p.t / period + phase); },
            nullptr, period};
  }
  if (name == "tool_wear") return {name, [=](const ToolPoint& p) { return A * p.s / 17.3e3; }};
  if (name == "tool_running_in") {
    const double distance = log_between(random, 0.5e3, 8e3);
    return {name, [=](const ToolPoint& p) { return A * (1.0 - std::exp(-p.s / distance)); },
            nullptr, distance / 1e3};
  }
  if (name == "slide_periodic") {
    const double length = log_between(random, 0.5, 6.0);
    return {name,
            [=](const ToolPoint& p) { return A * std::cos(2.0 * kPi * p.x / length + phase); },
            nullptr, length};
  }
  if (name == "revolution_periodic") {
    const double cycles = log_between(random, 0.02, 0.3);
    return {name,
            [=](const ToolPoint& p) { return A * std::cos(2.0 * kPi * cycles * p.k + phase); },
            nullptr, cycles};
  }
  if (name == "step") {
    const double place = between(random, 1.0, 9.0);
    return {name, [=](const ToolPoint& p) { return p.r < place ? A : 0.0; }, nullptr, place};
  }
  if (name == "centre_height") {
    const double h = log_between(random, 0.1, 1.0);
    return {name, [=](const ToolPoint& p) { return A * (std::hypot(p.r, h) - std::abs(p.r)) / h; },
            nullptr, h};
  }
  if (name == "speed_effect") {
    const double m = between(random, 0.1, 0.5);
    return {name,
            [=](const ToolPoint& p) {
              return A * (std::pow(std::max(std::abs(p.r), 0.02) / kRadius, -m) - 1.0);
            },
            nullptr, m};
  }
  if (name == "edge_roll_off") {
    const double w = log_between(random, 0.1, 0.5);
    return {name, [=](const ToolPoint& p) { return A * std::exp((p.r - kRadius) / w); }, nullptr,
            w};
  }
  if (name == "cup")
    return {name, [=](const ToolPoint& p) { return A * p.r * p.r / (kRadius * kRadius); }};
  if (name == "traverse_datum")
    return {name, nullptr, [=](double X, double) {
              const double u = X / kRadius;
              return A * (u * u * u - 0.6 * u);
            }};
  if (name == "centre_step")
    return {name, nullptr, [=](double X, double) { return X < 0.0 ? -A : A; }};
  if (name == "traverse_periodic") {
    const double hz = log_between(random, 0.2, 3.0);
    return {name, nullptr,
            [=](double, double m) { return A * std::cos(2.0 * kPi * hz * m + phase); }, hz};
  }
  // Shapes in no catalogue.
  if (name == "stretched_exponential")
    return {name, [=](const ToolPoint& p) { return A * (1.0 - std::exp(-std::sqrt(p.t / 40.0))); }};
  if (name == "chirp")
    return {name, [=](const ToolPoint& p) {
              const double u = p.x / kRadius;
              return A * std::cos(2.0 * kPi * (1.5 * u + 2.0 * u * u) + phase);
            }};
  if (name == "double_bump")
    return {name, [=](const ToolPoint& p) {
              const auto bump = [&](double at) {
                return std::exp(-0.5 * std::pow((p.r - at) / 0.7, 2));
              };
              return A * (bump(3.2) - 0.7 * bump(6.9));
            }};
  if (name == "switched_drift")
    return {name, [=](const ToolPoint& p) { return A * std::max(0.0, p.t - 20.0) / 55.0; }};
  return {name};
}

Problem face_problem() {
  Problem problem;
  problem.bodies = Machine::paper_lathe();
  problem.lever = Lever::paper;
  problem.effects = {{"squareness", {}, {}}, {"straightness", {std::nullopt, 3, std::nullopt}, {}}};
  problem.trace.candidates = effect_names();
  return problem;
}

std::vector<Profile> make_faces(const Hidden& hidden, int cuts, double nose_radius_mm,
                                std::uint64_t seed) {
  std::vector<Profile> out;
  for (int c = 0; c < cuts; ++c) {
    const Design& design = kDesigns[static_cast<std::size_t>(c)];
    Cut cut;
    cut.radius_mm = kRadius;
    cut.feed_mm_per_min = design.feed;
    cut.spindle_rpm = kRpm;
    cut.inward = design.inward;
    cut.nose_radius_mm = nose_radius_mm;
    const Carriage carriage{{0.0, 0.0, 2e-7, -6e-9}, {}, kFaceSquareness, 0.0, 0.0};
    std::vector<Error> errors{[=](const ToolPoint& p) { return one_lever(carriage, p); }};
    if (hidden.tool) errors.push_back(hidden.tool);
    RandomStream random(seed, "stylus" + std::to_string(c));
    Stylus stylus;
    stylus.center_mm = kRadius;
    stylus.traverse_mm_per_s = kTraverse;
    stylus.offset_mm = 1e-3 * between(random, -1.0, 1.0);
    stylus.tilt = 1e-5 * between(random, -1.0, 1.0);
    stylus.datum = hidden.datum;
    stylus.noise = {.white = kFaceWhiteNoise, .correlated = kFaceNoise, .correlation_mm = 0.1};
    Profile profile;
    profile.name = "cut" + std::to_string(c + 1);
    for (int i = 0; i < 20000; ++i) profile.positions.push_back(0.001 * i);
    profile.values = trace(Face(cut, sum(errors)), profile.positions, stylus, random);
    Setup& setup = profile.setup;
    setup.center_mm = kRadius;
    setup.feed_mm_per_min = design.feed;
    setup.spindle_rpm = kRpm;
    setup.cut_direction = design.inward ? CutDirection::inward : CutDirection::outward;
    setup.cut_radius_mm = kRadius;
    setup.traverse_mm_per_s = kTraverse;
    setup.first_mm = profile.positions.front();
    setup.last_mm = profile.positions.back();
    out.push_back(std::move(profile));
  }
  return out;
}

}  // namespace slideway::turning
