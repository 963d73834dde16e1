#include "face_slope.hpp"

#include <algorithm>

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

}  // namespace

std::shared_ptr<const FaceSlope> face_slope(const Model& model, const Estimate& estimate) {
  const auto shown = std::ranges::find_if(
      model.observations, [](const Observation& each) { return may_go_with_face(*each.profile); });
  if (shown == model.observations.end()) return nullptr;
  const Setup& setup = shown->profile->setup;
  const double farthest =
      std::max(setup.last_mm - setup.center_mm, setup.center_mm - setup.first_mm);
  auto out = std::make_shared<FaceSlope>();
  out->spacing_mm = farthest / static_cast<double>(kPlaces);
  std::vector<double> middles;
  for (Eigen::Index i = 0; i < kPlaces; ++i)
    middles.push_back(setup.center_mm + (static_cast<double>(i) + 0.5) * out->spacing_mm);
  const Stations stations(middles, setup, model.machine);
  Eigen::VectorXd height = Eigen::VectorXd::Zero(stations.size());
  for (const ModelTerm& term : model.terms) {
    if (!term.effect->is_carriage()) continue;
    const Eigen::Index count = term.effect->amplitudes();
    Eigen::MatrixXd columns(stations.size(), count);
    term.effect->columns(stations, shapes_of(term, estimate.shapes), columns);
    height += columns * estimate.amplitudes.segment(term.first_amplitude, count);
  }
  std::vector<double>& slopes = out->values;
  for (Eigen::Index i = 1; i < kPlaces; ++i)
    slopes.push_back((height[i] - height[i - 1]) / out->spacing_mm);
  slopes.insert(slopes.begin(), 2.0 * slopes[0] - slopes[1]);
  slopes.push_back(2.0 * slopes.back() - slopes[slopes.size() - 2]);
  return out;
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
