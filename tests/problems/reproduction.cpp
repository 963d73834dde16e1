#include "problems/reproduction.hpp"

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "problems/shipped.hpp"
#include "slideway/base/text.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/identify/ranking.hpp"
#include "slideway/report/number.hpp"

namespace slideway {
namespace {

using Numbers = std::map<std::string, std::string>;

constexpr double kTravel = 600.0;
constexpr double kSquareness = 2.8e-6;
// b0 to b5: Eq. (17) as printed, half a unit of each last digit, and the set the data are made
// with.
const Eigen::VectorXd kPrinted{{2.41e-4, -5.19e-7, 2.29e-8, -1.558e-10, 3.4e-13, -2.3e-16}};
const Eigen::VectorXd kHalf{{0.005e-4, 0.005e-7, 0.005e-8, 0.0005e-10, 0.05e-13, 0.05e-16}};
const Eigen::VectorXd kChosen{{2.41e-4, -5.19e-7, 2.2905e-8, -1.558e-10, 3.3908e-13, -2.343e-16}};

std::string fixed(double value, int decimals) { return fixed_point(value, decimals); }

/// What an effect of the catalogue does to a face, mm, at r = first, first + 0.1 mm, ... last.
Eigen::VectorXd on_face(const std::string& name, const Eigen::VectorXd& parameters, Lever lever,
                        double first, double last) {
  const Machine machine(Machine::paper_lathe(), lever);
  EffectOptions options;
  if (name == "straightness") options.degree = static_cast<int>(parameters.size()) - 1;
  const auto effect = make_effect(name, options, machine, {0.0, kTravel});
  std::vector<double> positions;
  for (int i = 0; i <= std::lround(10.0 * (last - first)); ++i)
    positions.push_back(first + i / 10.0);
  Setup setup;
  setup.first_mm = first;
  setup.last_mm = last;
  const Stations stations(positions, setup, machine);
  Eigen::MatrixXd columns(stations.size(), effect->amplitudes());
  effect->columns(stations, {}, columns);
  return columns * effect->from_parameters(parameters);
}

Eigen::VectorXd straightness(const Eigen::VectorXd& b, double first = 0.0, double last = kTravel) {
  return on_face("straightness", b, Lever::split, first, last);
}

double range(const Eigen::VectorXd& values) { return values.maxCoeff() - values.minCoeff(); }

double rms(const Eigen::VectorXd& values) {
  const Eigen::ArrayXd deviation = values.array() - values.mean();
  return std::sqrt(deviation.square().mean());
}

void add_equation_17(Numbers& out) {
  const double arcsecond_um = kArcsecond / kMicrometre;  // over 1 mm
  out["accuracy_rad"] = significant(0.5 * kArcsecond, 2);
  out["resolution_rad"] = significant(0.01 * kArcsecond, 2);
  out["accuracy_um"] = fixed(0.5 * 10.0 * arcsecond_um, 3);
  out["eq17_range"] = fixed(range(straightness(kPrinted)) / kMicrometre, 2);
  out["chosen_range"] = fixed(range(straightness(kChosen)) / kMicrometre, 2);
  const auto at = [](const Eigen::VectorXd& b, double x) { return straightness(b, x, x)[0]; };
  out["eq17_100"] = fixed(at(kPrinted, 100.0) * 1e4, 2);
  out["half_100"] = fixed(at(kHalf, 100.0) * 1e4, 2);
  out["eq17_360"] = fixed(at(kPrinted, 360.0) * 1e5, 1);
  out["half_360"] = fixed(at(kHalf, 360.0) * 1e5, 1);
  out["chosen_360"] = fixed(at(kChosen, 360.0) * 1e5, 1);
  out["eq17_600"] = fixed(at(kPrinted, 600.0) * 1e3, 1);
  out["half_600"] = fixed(at(kHalf, 600.0) * 1e3, 1);
  for (const auto& [name, b] :
       {std::pair{"eq17_max", kPrinted}, std::pair{"chosen_max", kChosen}}) {
    Eigen::Index where = 0;
    out[name] = fixed(straightness(b, 0.0, 300.0).maxCoeff(&where) * 1e4, 2);
    out[std::string(name) + "_at"] = fixed(static_cast<double>(where) / 10.0, 0);
  }
  out["eq17_min"] = fixed(straightness(kPrinted).minCoeff() * 1e5, 1);
  out["fit_error"] = fixed((2e-5 - -4.5e-5) / kMicrometre, 3);
  out["eq17_10mm"] = fixed(range(straightness(kPrinted, 0.0, 10.0)) / kMicrometre * 1e3, 1);
}

void add_levers(Numbers& out) {
  for (const auto& [name, b] :
       {std::pair{"pitch_pv", kChosen}, std::pair{"pitch_pv_printed", kPrinted}})
    out[name] = fixed(range(on_face("straightness", b, Lever::paper, 0.0, kTravel) -
                            on_face("straightness", b, Lever::split, 0.0, kTravel)) /
                          kMicrometre,
                      2);
  const Eigen::VectorXd cone =
      on_face("squareness", Eigen::VectorXd::Constant(1, kSquareness), Lever::split, 0.0, kTravel);
  out["squareness_pv"] = fixed(range(cone) / kMicrometre, 2);
  out["squareness_rms"] = fixed(rms(cone) / kMicrometre, 2);
  out["split_straightness_rms"] = fixed(rms(straightness(kChosen)) / kMicrometre, 2);
  out["paper_straightness_rms"] =
      fixed(rms(on_face("straightness", kChosen, Lever::paper, 0.0, kTravel)) / kMicrometre, 2);
  out["fig6_rad"] = fixed(1.8e-3 / kTravel * 1e6, 1);
  out["fig6_ratio"] = fixed(1.8e-3 / range(cone), 2);
}

std::string microradians(double value, double expanded) {
  return with_uncertainty(value * 1e6, expanded * 1e6);
}

std::string squareness_of(const Result& result) {
  const FittedParameter& parameter = determined(result, "squareness.dbeta_xz");
  return microradians(*parameter.value, *parameter.expanded_uncertainty);
}

void add_correlations(Numbers& out, const std::string& lever, const Result& result) {
  for (const auto& [symbol, effect] :
       {std::pair{"_sq", "squareness"}, std::pair{"_st", "straightness"}})
    for (const std::string feed : {"2", "8"}) {
      const Ranking& entry = ranked(result, effect, "feed" + feed);
      out[lever + symbol + feed + "_raw"] = fixed(entry.raw, 2);
      out[lever + symbol + feed + "_low"] = fixed(entry.low_band, 2);
    }
  out[lever + "_share"] = fixed(100.0 * mean_share(result, "squareness"), 0);
  out[lever + "_dbeta"] = squareness_of(result);
}

void add_full_travel(Numbers& out) {
  const Result split = identify_shipped("paper-600mm/problem.toml");
  add_correlations(out, "split", split);
  add_correlations(out, "paper", identify_shipped("paper-600mm/paper.toml"));
  const auto coefficient = [&](const char* effect, const char* feed) {
    return ranked(split, effect, feed).raw;
  };
  out["gap2"] = fixed(coefficient("squareness", "feed2") - coefficient("straightness", "feed2"), 2);
  out["gap8"] = fixed(coefficient("squareness", "feed8") - coefficient("straightness", "feed8"), 2);
  const Ranking& line = ranked(split, "squareness", "feed2");
  const Ranking& curve = ranked(split, "straightness", "feed2");
  out["ratio2"] = fixed(curve.raw / line.raw, 2);
  out["ratio_low"] = fixed(curve.low_band / line.low_band, 2);
  out["neff"] = fixed(line.effective_observations, 1);
  out["p_value"] = fixed(line.p_value, 3);
  out["values"] = std::to_string(split.low_band[0].values);
  out["split_rms2"] = fixed(*split.inputs[0].rms_um, 2);
  out["split_rms8"] = fixed(*split.inputs[1].rms_um, 2);
  out["split_res2"] = fixed(residual_rms(split, "feed2"), 3);
  out["split_res8"] = fixed(residual_rms(split, "feed8"), 3);
  const SquarenessCheck& check = *split.crosscheck.squareness;
  out["indirect"] = microradians(*check.indirect_rad, *check.indirect_U_rad);
  out["En"] = fixed(*check.En, 2);
  out["split_verdict"] = text_of(check.verdict);
  out["split_amplitude"] = fixed(*check.fit_amplitude_um, 2);

  Problem level1 = shipped_problem("paper-600mm/problem.toml");
  level1.low_band.level = 1;
  const Result shallow = identify(level1, read_profiles(level1), Scope::rank);
  out["level1_sq2"] = fixed(ranked(shallow, "squareness", "feed2").low_band, 2);
  out["level1_sq8"] = fixed(ranked(shallow, "squareness", "feed8").low_band, 2);
  const Runout& runout = *level1.runout;
  out["p_share"] = fixed(100.0 * runout.p_um / (runout.r_um + runout.p_um), 0);
  out["indirect_least"] =
      fixed((runout.p_um - runout.r_um) * kMicrometre / runout.diameter_mm * 1e6, 1);
}

void add_experiment(Numbers& out) {
  const Result joint = identify_shipped("paper-experiment/problem.toml");
  out["joint_dbeta"] = squareness_of(joint);
  out["joint_En"] = fixed(*joint.crosscheck.squareness->En, 2);
  out["joint_verdict"] = text_of(joint.crosscheck.squareness->verdict);
}

void add_face(Numbers& out) {
  const Problem problem = shipped_problem("paper-face-10mm/problem.toml");
  const Result face = identify_shipped("paper-face-10mm/problem.toml");
  for (std::size_t i = 0; i < 2; ++i) {
    const Setup& setup = problem.profiles[i].profile.setup;
    const double groove = *setup.feed_mm_per_min / *setup.spindle_rpm;  // mm
    const std::string feed = i == 0 ? "2" : "8";
    out["groove" + feed] = fixed(groove / kMicrometre, 1);
    out["turns" + feed] = fixed(*setup.cut_radius_mm / groove, 1);
    out["face_pv" + feed] = fixed(*face.inputs[i].pv_um, 1);
  }
  const SquarenessCheck& check = *face.crosscheck.squareness;
  out["face_cone"] = fixed(*check.fit_amplitude_um, 1);
  out["face_indirect_um"] = fixed(*check.indirect_amplitude_um, 3);
  out["face_ratio"] = fixed(*check.fit_rad / *check.indirect_rad, 0);
  out["face_dbeta"] = squareness_of(face);
  out["face_verdict"] = text_of(check.verdict);
  out["face_En"] = fixed(*check.En, 0);
}

void add_axes(Numbers& out) {
  LowBandOptions raw;
  raw.level = 0;
  for (const ColumnRanking& axis : rank_columns(source_folder() / "data/axis-ranking.csv",
                                                "measured", {"error_x", "error_y", "error_z"}, raw))
    out["axis_" + axis.candidate.substr(6)] = fixed(axis.raw, 2);
}

}  // namespace

std::map<std::string, std::string> reproduced_numbers() {
  Numbers out;
  add_equation_17(out);
  add_levers(out);
  add_full_travel(out);
  add_experiment(out);
  add_face(out);
  add_axes(out);
  return out;
}

}  // namespace slideway
