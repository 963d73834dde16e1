#include "off_axis.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "search.hpp"
#include "slideway/base/text.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/identify/left_out.hpp"
#include "slideway/identify/noise_model.hpp"

namespace slideway {
namespace {

constexpr int kEachWay = 24;           // centres that are tried on either side of center_mm
constexpr double kFarther = 2;         // than X0: what lies there may have moved it
constexpr std::size_t kMostNear = 64;  // values at the axis that neither noise nor step is taken of

/// What a trace shows of the face whose centre lies elsewhere along it.
std::unique_ptr<Effect> effect_of_face(const Model& model) {
  const std::vector<std::string>& names = effect_names();
  const auto name = std::ranges::find_if(names, [](const std::string& each) {
    const Description& about = specimen(each).description();
    return about.of_face && about.variable == IndependentVariable::trace;
  });
  return make_effect(*name, {}, model.machine, model.range);
}

/// Low band of the effect at one X0. No columns: the trace does not cross the axis.
Eigen::MatrixXd cone(const Effect& off_centre, const Observation& observation,
                     const Machine& machine, double offset_mm) {
  const Profile& profile = *observation.profile;
  if (!off_centre.applies_to(profile.setup)) return {observation.values.size(), 0};
  const Stations stations = profile.stations(machine);
  Eigen::MatrixXd column(stations.size(), 1);
  off_centre.columns(stations, {&offset_mm, 1}, column);
  return observation.low_band.apply(column);
}

/// Values of a diameter that may lie between two centres, rising: the nearest to center_mm.
ValueIndices near_axis(const Model& model, const Observation& observation) {
  const Profile& profile = *observation.profile;
  const std::vector<double> places = observation.low_band.positions(profile.positions);
  const double farthest = model.gates.most_lost * *profile.setup.cut_radius_mm;
  const auto radius = [&](Eigen::Index i) {
    return std::abs(places[static_cast<std::size_t>(i)] - profile.setup.center_mm);
  };
  const ValueIndices gone = left_out_values(observation);
  ValueIndices out;
  for (Eigen::Index i = 0; i < std::ssize(places); ++i)
    if (radius(i) <= farthest && !std::ranges::binary_search(gone, i)) out.push_back(i);
  std::ranges::stable_sort(out, {}, radius);
  out.resize(std::min(out.size(), kMostNear));
  std::ranges::sort(out);
  return out;
}

struct OffAxis {
  double offset_mm = 0.0;  // X0
  ValueIndices values;     // that no cone describes
};

/// @param far   the data without the values at the axis
/// @param step  cone() far from it
std::optional<OffAxis> off_axis(const Model& model, const Whitened& data, const Whitened& far,
                                std::size_t profile, const Observation& observation,
                                const Effect& off_centre, const Eigen::MatrixXd& step) {
  const Gates& gates = model.gates;
  const Projection of_step = project_in(far, profile, step);
  if (of_step.rank == 0 || of_step.gain < gates.size * gates.size) return std::nullopt;
  const std::vector<double> far_from_axis{0.0};
  OffAxis out{off_centre.parameter_values(of_step.amplitudes, far_from_axis)
                  .values[off_centre.shapes()[0].parameter],
              {}};
  if (std::abs(out.offset_mm) > gates.most_lost * *observation.profile->setup.cut_radius_mm)
    return std::nullopt;
  std::ranges::set_difference(values_at_axis(observation, model.machine, out.offset_mm),
                              left_out_values(observation), std::back_inserter(out.values));
  double of_best = 0.0;
  for (int k = -kEachWay; k <= kEachWay; ++k) {
    const double centre = kFarther * out.offset_mm * k / kEachWay;
    const Eigen::MatrixXd own = cone(off_centre, observation, model.machine, centre);
    of_best = std::max(of_best, project_in(data, profile, own).gain);
  }
  Eigen::MatrixXd columns(step.rows(), 1 + std::ssize(out.values));
  columns << step, unit_columns(out.values, step.rows());
  const double gain = project_in(data, profile, columns).gain - of_best;
  if (gain - penalty(data, std::ssize(out.values)) < gates.delta_bic) return std::nullopt;
  return out;
}

}  // namespace

std::string leave_out_off_axis(const FittedModel& fitted, Model& model) {
  const Linearisation& linear = fitted.fit.linear;
  if (!model.range.face_slope || model.range.face_slope->rms() == 0.0) return "";
  const std::unique_ptr<Effect> off_centre = effect_of_face(model);
  std::vector<Eigen::MatrixXd> steps, suspect;
  FreeValues near;
  for (const Observation* each : linear.observations) {
    steps.push_back(cone(*off_centre, *each, model.machine, 0.0));
    near.push_back(steps.back().cols() > 0 ? near_axis(model, *each) : ValueIndices());
    suspect.emplace_back(each->values.size(), steps.back().cols() + std::ssize(near.back()));
    suspect.back() << steps.back(), unit_columns(near.back(), each->values.size());
  }
  if (std::ranges::all_of(steps, [](const auto& step) { return step.cols() == 0; })) return "";
  const std::vector<Noise> noise = noise_beside(linear, model.gates, suspect);
  const Whitened data(linear, noise), far(linear, noise, near);
  std::vector<std::string> where;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i].cols() == 0) continue;
    const std::optional<OffAxis> found =
        off_axis(model, data, far, i, *linear.observations[i], *off_centre, steps[i]);
    if (!found) continue;
    const Profile* const profile = linear.observations[i]->profile;
    leave_out(*std::ranges::find(model.observations, profile, &Observation::profile),
              found->values);
    where.push_back("'" + profile->name + "' (" + significant(found->offset_mm, 2) + " mm)");
  }
  if (where.empty()) return "";
  return "the halves differ as where a trace passes the spindle axis beside center_mm: " +
         joined(where) + "; values up to there are left out; check center_mm";
}

}  // namespace slideway
