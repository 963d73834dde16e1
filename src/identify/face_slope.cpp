#include "face_slope.hpp"

#include <algorithm>
#include <optional>

#include "slideway/effects/catalogue.hpp"

namespace slideway {
namespace {

constexpr Eigen::Index kPlaces = 256;  // a polynomial of degree 20 is straight between them

bool may_go_with_face(const Profile& profile) {
  return profile.role == Role::fit &&
         std::ranges::any_of(effect_names(), [&](const std::string& name) {
           const Effect& effect = specimen(name);
           return effect.description().of_face && effect.applies_to(profile.setup);
         });
}

/// Slopes of the face by radius: they are linear in the amplitudes of the model.
struct LinearSlope {
  double spacing_mm = 1.0;
  Eigen::MatrixXd by_amplitude;  // one row a radius, as FaceSlope has them
};

std::optional<LinearSlope> linear_slope(const Model& model, const Estimate& estimate) {
  const auto shown = std::ranges::find_if(
      model.observations, [](const Observation& each) { return may_go_with_face(*each.profile); });
  if (shown == model.observations.end()) return std::nullopt;
  const Setup& setup = shown->profile->setup;
  const double farthest =
      std::max(setup.last_mm - setup.center_mm, setup.center_mm - setup.first_mm);
  LinearSlope out{farthest / static_cast<double>(kPlaces),
                  Eigen::MatrixXd(kPlaces + 1, model.amplitudes())};
  std::vector<double> middles;
  for (Eigen::Index i = 0; i < kPlaces; ++i)
    middles.push_back(setup.center_mm + (static_cast<double>(i) + 0.5) * out.spacing_mm);
  const Stations stations(middles, setup, model.machine);
  Eigen::MatrixXd height = Eigen::MatrixXd::Zero(kPlaces, model.amplitudes());
  for (const ModelTerm& term : model.terms)
    if (term.effect->is_carriage())
      term.effect->columns(stations, shapes_of(term, estimate.shapes),
                           height.middleCols(term.first_amplitude, term.effect->amplitudes()));
  auto& slopes = out.by_amplitude;
  slopes.middleRows(1, kPlaces - 1) =
      (height.bottomRows(kPlaces - 1) - height.topRows(kPlaces - 1)) / out.spacing_mm;
  slopes.row(0) = 2.0 * slopes.row(1) - slopes.row(2);
  slopes.row(kPlaces) = 2.0 * slopes.row(kPlaces - 1) - slopes.row(kPlaces - 2);
  return out;
}

FaceSlope slope_of(const LinearSlope& linear, const Estimate& estimate) {
  const Eigen::VectorXd values = linear.by_amplitude * estimate.amplitudes;
  return {linear.spacing_mm, {values.begin(), values.end()}};
}

}  // namespace

std::shared_ptr<const FaceSlope> face_slope(const Model& model, const Estimate& estimate) {
  const std::optional<LinearSlope> linear = linear_slope(model, estimate);
  return linear ? std::make_shared<FaceSlope>(slope_of(*linear, estimate)) : nullptr;
}

Eigen::RowVectorXd rms_slope_by_amplitude(const Model& model, const Estimate& estimate) {
  const std::optional<LinearSlope> linear = linear_slope(model, estimate);
  if (!linear) return Eigen::RowVectorXd::Zero(model.amplitudes());
  const FaceSlope slope = slope_of(*linear, estimate);
  // Of a flat face the root grows alike in every direction.
  if (!(slope.rms() > 0.0)) return Eigen::RowVectorXd::Zero(model.amplitudes());
  const Eigen::Map<const Eigen::RowVectorXd> values(slope.values.data(), std::ssize(slope.values));
  return values * linear->by_amplitude / (slope.rms() * static_cast<double>(values.size()));
}

bool follow_face(Model& model) {
  bool any = false;
  for (const ModelTerm& term : model.terms) {
    if (!term.effect->description().of_face) continue;
    remake_term(model, term.name, {.profiles = term.profiles});
    any = true;
  }
  return any;
}

}  // namespace slideway
