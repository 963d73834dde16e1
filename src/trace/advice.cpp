#include "advice.hpp"

#include <algorithm>
#include <cmath>

#include "slideway/base/text.hpp"

namespace slideway {
namespace {

constexpr int kSteps = 20;  // of a rival's shape, on either side

struct Measurement {
  std::string what;
  Profile profile;
};

void mirror(Profile& profile) {
  const double center = profile.setup.center_mm;
  std::vector<double> positions;
  for (const double s : profile.positions)
    if (s > center) positions.push_back(s);
  const std::size_t half = positions.size();
  for (std::size_t i = 0; i < half; ++i) positions.push_back(2.0 * center - positions[i]);
  std::sort(positions.begin(), positions.end());
  profile.positions = std::move(positions);
  profile.setup.first_mm = profile.positions.front();
  profile.setup.last_mm = profile.positions.back();
}

/// The same stations once more, the last one first.
void read_back(Profile& profile) {
  ReadingTimes times = *profile.setup.reading_times;
  const double last = std::ranges::max(times.times_s);
  for (double& each : times.times_s) each = 2.0 * last - each;
  profile.setup.reading_times = std::make_shared<const ReadingTimes>(std::move(times));
}

/// What can be made of a face or a reading: each differs from it in one thing.
/// @param of_instrument  an error of the instrument is in question
std::vector<Measurement> measurements_like(const Profile& face, bool of_instrument) {
  std::vector<Measurement> out;
  const Setup& setup = face.setup;
  const std::string made = setup.kind == Kind::face ? "a cut" : "a pass";
  const auto add = [&](std::string what, auto&& change) {
    Profile profile = face;
    profile.name = "to come";
    profile.role = Role::fit;
    change(profile);
    profile.values.assign(profile.positions.size(), 0.0);
    out.push_back({std::move(what), std::move(profile)});
  };
  if (setup.feed_mm_per_min)
    for (const double factor : {0.25, 4.0})
      add(made + " at " + significant(factor * *setup.feed_mm_per_min, 3) + " mm/min",
          [&](Profile& p) { p.setup.feed_mm_per_min = factor * *setup.feed_mm_per_min; });
  if (setup.cut_direction) {
    const bool inward = *setup.cut_direction == CutDirection::inward;
    add(made + (inward ? " outward" : " inward"), [&](Profile& p) {
      p.setup.cut_direction = inward ? CutDirection::outward : CutDirection::inward;
    });
  }
  if (setup.spindle_rpm)
    add(made + " at " + significant(1.5 * *setup.spindle_rpm, 3) + " rev/min",
        [&](Profile& p) { p.setup.spindle_rpm = 1.5 * *setup.spindle_rpm; });
  if (setup.traverse_mm_per_s)
    add("a trace at " + significant(0.5 * *setup.traverse_mm_per_s, 3) + " mm/s",
        [&](Profile& p) { p.setup.traverse_mm_per_s = 0.5 * *setup.traverse_mm_per_s; });
  if (of_instrument && setup.reading_times) add("a reading back", [](Profile& p) { read_back(p); });
  if (of_instrument && setup.kind == Kind::slide)
    add(setup.reversed ? "a reading that is not reversed" : "a reading with reversed = true",
        [](Profile& p) { p.setup.reversed = !p.setup.reversed; });
  if (setup.kind == Kind::face && setup.first_mm >= setup.center_mm)
    add("a trace over the whole diameter", [](Profile& p) { mirror(p); });
  return out;
}

/// The problem with one more profile, at the fitted shapes.
struct Planned {
  std::vector<Profile> profiles;
  Model model;
  Linearisation linear;
};

Planned plan(const Problem& problem, const std::vector<Profile>& profiles, const Model& model,
             const Solution& fit, const Measurement& measurement) {
  Planned out{profiles, {model.machine, model.range, {}, {}}, {}};
  out.profiles.push_back(measurement.profile);
  for (std::size_t i = 0; i < profiles.size(); ++i)
    out.profiles[i].low_band = model.observations[i].low_band.options();
  Problem bare = problem;
  bare.effects.clear();
  out.model = build_model(bare, out.profiles);
  out.model.range = model.range;
  out.model.terms = model.terms;
  Estimate estimate = fit.estimate;
  estimate.nuisances.clear();
  for (const Observation* observation : fitted_observations(out.model))
    estimate.nuisances.emplace_back(Eigen::VectorXd::Zero(observation->nuisances.cols()));
  out.linear = linearise(out.model, estimate);
  return out;
}

/// A rival with a grid of its own around the shapes it was fitted at: a longer variable resolves
/// more than the grid of the search.
Candidate near_fitted(const Refined& rival, double reach) {
  const Effect& effect = *rival.candidate->term.effect;
  Candidate out;
  out.term = rival.candidate->term;
  if (rival.shape.empty()) return out;
  // As many points for several shapes as for one, about.
  const double points = std::pow(2 * kSteps + 1, 1.0 / static_cast<double>(rival.shape.size()));
  const int steps = std::max(1, static_cast<int>(std::lround(points) / 2));
  std::vector<std::vector<double>> axes;
  for (std::size_t s = 0; s < rival.shape.size(); ++s) {
    const auto index = static_cast<std::size_t>(effect.shapes()[s].parameter);
    const Parameter& parameter = effect.parameters()[index];
    const double step = reach / steps * rival.uncertainties[static_cast<Eigen::Index>(index)];
    std::vector<double>& axis = axes.emplace_back();
    for (int i = -steps; i <= steps; ++i) {
      const double shape = rival.shape[s] + i * step;
      const bool inside = shape > parameter.lower && shape < parameter.upper;
      if (i == 0 || (inside && step > 0.0)) axis.push_back(shape);
    }
  }
  out.grid = ShapeLattice(std::move(axes));
  return out;
}

double predicted_separation(const Planned& planned, const Whitened& data, const Refined& effect,
                            const Refined& rival) {
  std::vector<Noise> noise = data.noise();
  noise.push_back(noise.front());
  Linearisation linear = planned.linear;
  const Eigen::Index priors = linear.prior_rows.rows();
  const Eigen::VectorXd signal =
      stacked_columns(planned.model, effect.candidate->term, effect.shape, priors) *
      effect.projection.amplitudes;
  Eigen::Index row = 0;
  for (Eigen::VectorXd& residual : linear.residuals) {
    residual = signal.segment(row, residual.size());
    row += residual.size();
  }
  linear.prior_residuals.setZero();
  const Whitened white(linear, noise);
  const Candidate near = near_fitted(rival, planned.model.gates.rival_reach);
  Finding best{&near};
  for (Eigen::Index atom = 0; atom < near.atoms(); ++atom) {
    const double gain =
        project(white, stacked_columns(planned.model, near.term,
                                       near.grid.points()[static_cast<std::size_t>(atom)], priors))
            .gain;
    if (gain > best.gain) best.gain = gain, best.atom = atom;
  }
  const double most = refine(planned.model, white, best).projection.gain;
  return white.residual().squaredNorm() - most;
}

}  // namespace

std::string separating_measurement(const Problem& problem, const std::vector<Profile>& profiles,
                                   const Model& model, const Solution& fit, const Whitened& data,
                                   const Refined& effect, const Refined& rival) {
  // The other profiles differ from the first in the few things that are tried.
  const Observation& first = *fitted_observations(model).front();
  Profile like = *first.profile;
  like.low_band = first.low_band.options();
  double best = 0.0;
  std::string name;
  const auto is_of_instrument = [](const Refined& each) {
    return each.candidate->term.effect->description().of_instrument;
  };
  for (const Measurement& measurement :
       measurements_like(like, is_of_instrument(effect) || is_of_instrument(rival))) {
    const Planned planned = plan(problem, profiles, model, fit, measurement);
    const double separation = predicted_separation(planned, data, effect, rival);
    if (separation <= best) continue;
    best = separation;
    name = measurement.what + " (like " + like.name + ")";
  }
  const std::string pair = effect.candidate->name() + " and " + rival.candidate->name();
  if (best < model.gates.tie_bic)
    return pair + ": no cut or trace tried on paper tells them apart; " + effect.candidate->name() +
           " is separated by " + effect.candidate->term.effect->description().separated_by;
  return pair + ": " + name + " would tell them apart best; predicted difference in BIC " +
         significant(best, 2);
}

std::string finer_band_advice(const Linearisation& linear, const TestedCandidate& wave,
                              bool is_coarser) {
  const std::vector<std::string>& cuts = wave.refined.candidate->term.profiles;
  const auto observation = std::ranges::find_if(linear.observations, [&](const auto* each) {
    return wave.refined.candidate->term.acts_on(*each->profile);
  });
  const int level = (*observation)->low_band.options().level;
  const std::string what =
      is_coarser   ? "search more values (the gate search_values)"
      : level == 0 ? "read it with a smaller spacing"
                   : "take the low band at level " + std::to_string(level - 1) + " or lower";
  return what + ": a wave of " + (cuts.empty() ? "the profiles" : joined(cuts, " and ")) +
         " may be the image of a faster one";
}

}  // namespace slideway
