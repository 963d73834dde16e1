#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "slideway/identify/identify.hpp"
#include "support/measured_data.hpp"

namespace slideway {

inline std::filesystem::path source_folder() { return SLIDEWAY_SOURCE_DIR; }

/// A problem of problems/, read.
inline Problem shipped_problem(const std::string& name) {
  return read_problem(source_folder() / "problems" / name, measured_data());
}

/// Runs 2 to 5 of the lathe bed with a polynomial.
inline Problem bed_as_polynomial(int degree) {
  Problem problem = shipped_problem("real/lathe-bed-curve.toml");
  problem.effects = shipped_problem("real/lathe-bed.toml").effects;
  problem.effects.front().options.degree = degree;
  return problem;
}

/// The result of a problem of problems/.
inline Result identify_shipped(const std::string& name) {
  const Problem problem = shipped_problem(name);
  return identify(problem, read_profiles(problem));
}

inline const Ranking& ranked(const Result& result, const std::string& effect,
                             const std::string& profile) {
  for (const Ranking& entry : result.ranking.entries)
    if (entry.effect == effect && entry.profile == profile) return entry;
  throw std::logic_error("no ranking of " + effect + " on " + profile);
}

/// Share of an effect in the low band, the mean over the fitted profiles.
inline double mean_share(const Result& result, const std::string& effect) {
  double sum = 0.0;
  int count = 0;
  for (const Contribution& contribution : result.final->contributions)
    if (contribution.effect == effect) sum += contribution.share, ++count;
  if (count == 0) throw std::logic_error("no contribution of " + effect);
  return sum / count;
}

inline double residual_rms(const Result& result, const std::string& profile) {
  for (const ResidualSummary& residual : result.final->residuals)
    if (residual.profile == profile)
      return residual.rms_um.value_or(residual.rms_urad.value_or(NAN));
  throw std::logic_error("no residual of " + profile);
}

/// A fitted parameter that the data determine.
inline const FittedParameter& determined(const Result& result, const std::string& name) {
  const FittedParameter* parameter = result.final->find(name);
  if (parameter == nullptr || !parameter->identifiable || !parameter->value)
    throw std::logic_error(name + " is not determined");
  return *parameter;
}

/// The estimate lies within its expanded uncertainty (95.45 %) of the truth. The data of a shipped
/// problem never change, so this is no draw: it holds or it does not.
inline void expect_recovered(const Result& result, const std::string& name, double truth) {
  const FittedParameter& parameter = determined(result, name);
  EXPECT_NEAR(*parameter.value, truth, *parameter.expanded_uncertainty) << name;
}

}  // namespace slideway
