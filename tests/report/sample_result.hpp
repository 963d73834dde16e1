#pragma once

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "slideway/trace/analysis.hpp"

namespace slideway {

/// What users see as one character; enough for Latin, Greek and the mathematical signs.
inline std::size_t columns_of(const std::string& line) {
  std::size_t count = 0;
  for (const char c : line) count += (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  return count;
}

inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// The first line that holds `what`, or "".
inline std::string line_with(const std::string& text, const std::string& what) {
  for (const std::string& line : lines_of(text))
    if (line.find(what) != std::string::npos) return line;
  return "";
}

inline FittedParameter fitted(const std::string& name, const std::string& symbol,
                              const std::string& unit, double value, double u) {
  FittedParameter p;
  p.name = name;
  p.symbol = symbol;
  p.unit = unit;
  p.value = value;
  p.standard_uncertainty = u;
  p.expanded_uncertainty = 2.0 * u;
  p.coverage_factor = 2.0;
  return p;
}

inline std::vector<InputSummary> sample_inputs() {
  InputSummary face;
  face.name = "feed2";
  face.file = "feed2.csv";
  face.sha256 = std::string(64, 'a');
  face.samples = 20000;
  face.missing = 1;
  face.left_out = 1;
  face.outlier_count = 1;
  face.outliers = {{120, 2.5, 0.5, MicroUnit::um, OutlierKind::spike}};
  face.position_max_mm = 10.0;
  face.rms_um = 0.5;
  face.pv_um = 2.0;
  face.notes = {"positions brought to a uniform grid for the wavelet: largest shift 0.2 µm"};
  InputSummary level = face;
  level.name = "the_level_on_the_front_way_third_run_of_three";
  level.kind = Kind::slide;
  level.quantity = Quantity::slope;
  level.role = Role::holdout;
  level.rms_um = level.pv_um = std::nullopt;
  level.rms_urad = 4.25;
  level.pv_urad = 12.5;
  return {face, level};
}

inline ClosureSummary sample_closure() {
  ClosureSummary closure;
  closure.lines = 8;
  closure.places = 9;
  closure.redundancy = 2;
  closure.verdict = ClosureVerdict::does_not_close;
  closure.false_alarm = 1e-3;
  closure.limit = 4.25;
  closure.tied = true;
  closure.readings = {{"feed2", 10.0, 20.5, 0.0, -2.5, 0.5},
                      {"feed2", 10.0, 0.0, std::nullopt, std::nullopt, std::nullopt}};
  closure.repeats = {
      {"feed2", "level", 17, 5.0, 0.25, 1.5, 0.125, 8.5, RepeatVerdict::do_not_agree}};
  closure.suspects = {"feed2"};
  closure.notes = {"8 lines meet at 9 places and do not close"};
  return closure;
}

inline RankingResult sample_ranking() {
  Ranking squareness{"squareness", "feed2", 0.83, 0.99, 0.5, 0.991, 12.5, 1e-9, {}};
  squareness.running = {{10, 20}, {5.0, 10.0}, {0.5, 0.83}, {5.0, 10.0}, {0.9, 0.99}};
  Ranking straightness{
      "vertical_straightness", sample_inputs()[1].name, -0.6, -0.97, -1.5, -0.98, 12.5, 0.02, {}};
  return {{squareness, straightness},
          {{"squareness", "straightness", "feed2", -0.2},
           {"squareness", "vertical_straightness", "feed2", 0.97}},
          {"constant profiles were passed over"}};
}

inline Identifiability sample_identifiability() {
  Identifiability what;
  what.parameters = 3;
  what.rank = 2;
  what.condition = 120.0;
  what.unidentifiable = {
      {{{"vertical_straightness.c1", std::sqrt(0.5)}, {"squareness.tilt", -std::sqrt(0.5)}},
       "Measure a reference straightedge along Z, or the run-out of Eq. (21)."}};
  DeterminedCombination sum{{2.5e-6, "rad", 1e-8, 2e-8, 2.0, {}}, {}};
  sum.combination = {{"vertical_straightness.c1", 1.0}, {"squareness.tilt", 1.0}};
  what.determined = {sum};
  return what;
}

inline Straightness sample_straightness() {
  Straightness out;
  StraightnessError error{{0.3, "um", 0.01, 0.02, 2.0, {}}, ReferenceLineKind::end_point};
  error.highest_um = 0.3;
  error.highest_at_mm = 5.0;
  out.errors = {error};
  out.end_point_um = error.value;
  out.expanded_uncertainty_um = error.expanded_uncertainty;
  out.curve = {{0.0, 5.0, 10.0}, {-0.1, 0.2, -0.1}, {0.01, 0.02, 0.01}};
  return out;
}

inline ModelResult sample_fit() {
  ModelResult fit;
  fit.effects = {"squareness", "straightness", "vertical_straightness"};
  fit.converged = true;
  fit.rms_um = 0.1;
  fit.observations = 1250;
  fit.effective_observations = 140.0;
  fit.parameters = {fitted("squareness.dbeta_xz", "Δβxz", "rad", 2.8e-6, 1.1e-9),
                    fitted("straightness.b2", "b_2", "mm^-1", -2.29e-8, 1e-10),
                    fitted("vertical_straightness.c1", "c_1", "", 777.5, 1e5)};
  fit.parameters[0].standard_name = "squareness of X to Z, E_B(0X)Z";
  fit.parameters[0].degrees_of_freedom = 130.0;
  fit.parameters[2].identifiable = false;
  static_cast<QuantityValue&>(fit.parameters[2]) = {};
  fit.straightness = sample_straightness();
  fit.nuisances = {fitted("feed2.offset", "", "um", 0.0125, 0.003)};
  fit.nuisances[0].at_bound = true;
  fit.correlations = {{"straightness.b2", "straightness.b3", -0.97}};
  fit.identifiability = sample_identifiability();
  fit.noise = {{"feed2", NoiseScaling::refuted, true, 4.5, 0.012, std::nullopt, 0.31, 140.0, 0.42},
               {sample_inputs()[1].name, NoiseScaling::declared, false, std::nullopt, std::nullopt,
                1.5, 0.0, 20.0, 0.5}};
  fit.contributions = {{"squareness", "feed2", 0.4, std::nullopt, 0.9},
                       {"straightness", sample_inputs()[1].name, std::nullopt, 1.25, 0.1}};
  fit.residuals = {{"feed2", Role::fit, 0.1, 0.45, {}, {}},
                   {sample_inputs()[1].name, Role::holdout, {}, {}, 1.5, 4.0}};
  fit.chi_square = 131.0;
  fit.degrees_of_freedom = 133.0;
  fit.neglected_um = 1.25e-9;
  fit.notes = {"uncertainties hold for correlated residuals: the noise is whitened before the fit"};
  return fit;
}

/// An identification with every field of Result in use.
inline Result sample_result() {
  Result result;
  result.title = "Face turned at two feeds";
  result.version = "0.2.0";
  result.assumed = {{"profile.feed2.free", R"(["offset", "tilt"])", "default"}};
  result.inputs = sample_inputs();
  result.closure = sample_closure();
  result.low_band = {{"feed2", "db1", 5, Boundary::symmetric, 1250},
                     {sample_inputs()[1].name, "db1", 0, Boundary::symmetric, 61}};
  result.ranking = sample_ranking();
  result.dominant = {"squareness", "squareness", true};
  result.declared = result.final = sample_fit();
  result.crosscheck.squareness = {2.8e-6, 2.2e-9, 2.75e-6, 2e-7, 0.25, Consistency::consistent,
                                  "",     600.0,  1.68,    1.65};
  return result;
}

}  // namespace slideway
