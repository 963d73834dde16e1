#pragma once

#include <gmock/gmock.h>

#include <optional>
#include <string>
#include <vector>

#include "slideway/trace/analysis.hpp"
#include "support/hidden_effect.hpp"

/// Faces with one effect more than the model declares, for the tests of the closed loop.
namespace slideway::faces {

inline constexpr double kBlunt = 50.0;  // mm, nose radius whose marks sink below the noise
inline constexpr double kSharp = 2.0;

/// The low band of every fourth sample: as many values as the fifth level of them all has.
inline constexpr int kQuarterLevel = 3;

/// Faces read at every fourth place, which is as good and takes a quarter of the time.
inline std::vector<Profile> quarter_faces(const turning::Hidden& hidden, int cuts,
                                          double nose_radius_mm, std::uint64_t seed) {
  std::vector<Profile> out = turning::make_faces(hidden, cuts, nose_radius_mm, seed);
  for (Profile& profile : out) {
    const std::size_t count = profile.positions.size() / 4;
    for (std::size_t i = 0; i < count; ++i) {
      profile.positions[i] = profile.positions[4 * i];
      profile.values[i] = profile.values[4 * i];
    }
    profile.positions.resize(count);
    profile.values.resize(count);
    profile.setup.last_mm = profile.positions.back();
  }
  return out;
}

/// Another direction in the problem file than that of the cut.
inline void swap_direction(Profile& profile) {
  std::optional<CutDirection>& direction = profile.setup.cut_direction;
  direction = *direction == CutDirection::inward ? CutDirection::outward : CutDirection::inward;
}

inline Problem problem_of(std::vector<std::string> candidates = {}) {
  Problem problem = turning::face_problem();
  problem.low_band.level = kQuarterLevel;
  if (!candidates.empty()) problem.trace.candidates = std::move(candidates);
  return problem;
}

/// A closed loop with the models it began and ended with.
struct Closed : TraceResult {
  ModelResult declared, final;
};
inline Closed closed(const Problem& problem, const std::vector<Profile>& profiles) {
  Analysis analysis = analyse(problem, profiles);
  return {*std::move(analysis.trace), *std::move(analysis.result.declared),
          *std::move(analysis.result.final)};
}

/// Names in the order they were accepted, feed marks left out: the process does make them.
inline std::vector<std::string> named(const TraceResult& result) {
  std::vector<std::string> out;
  for (const TraceRound& round : result.rounds)
    if (round.accepted != "feed_marks") out.push_back(round.accepted);
  return out;
}

inline const TraceRound* round_of(const TraceResult& result, const std::string& effect) {
  for (const TraceRound& round : result.rounds)
    if (round.accepted == effect) return &round;
  return nullptr;
}

inline const FittedParameter* find(const std::vector<FittedParameter>& parameters,
                                   const std::string& name) {
  for (const FittedParameter& parameter : parameters)
    if (parameter.name == name) return parameter.value ? &parameter : nullptr;
  return nullptr;
}

/// |value - truth| <= 4 u: 6e-5 of correct results fail, and the seeds are fixed.
inline void expect_within_4u(const std::vector<FittedParameter>& parameters,
                             const std::string& name, double truth) {
  const FittedParameter* parameter = find(parameters, name);
  ASSERT_NE(parameter, nullptr) << name;
  ASSERT_TRUE(parameter->standard_uncertainty) << name;
  EXPECT_NEAR(*parameter->value, truth, 4.0 * *parameter->standard_uncertainty) << name;
}

/// What a failing test shows.
inline std::string story(const TraceResult& result) {
  std::string out = "verdict " + std::string(text_of(result.verdict));
  for (const TraceRound& round : result.rounds) {
    out += "\n  accepted " + round.accepted;
    for (const std::string& rival : round.ambiguous_with) out += " | " + rival;
    for (const FittedParameter& p : round.parameters)
      if (p.value)
        out += "\n    " + p.name + " = " + std::to_string(*p.value) + " +- " +
               std::to_string(p.standard_uncertainty.value_or(-1.0));
  }
  for (const TriedEffect& tried : result.refused)
    out += "\n  refused " + tried.effect + " dBIC " + std::to_string(tried.delta_bic) + ": " +
           tried.refused.value_or("");
  for (const auto& [effect, reason] : result.left) out += "\n  left " + effect + ": " + reason;
  for (const auto& [effect, same] : result.not_separable)
    out += "\n  not separable " + effect + ": " + same;
  for (const std::string& text : result.advice) out += "\n  advice " + text;
  for (const std::string& text : result.notes) out += "\n  note " + text;
  if (result.unnamed)
    out += "\n  unnamed " +
           std::to_string(result.unnamed->rms_um.value_or(result.unnamed->rms_urad.value_or(0.0))) +
           " on clock " + result.unnamed->clock;
  return out + "\n  lack of fit p " + std::to_string(result.lack_of_fit_p);
}

}  // namespace slideway::faces
