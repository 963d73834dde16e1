#include "form_columns.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "slideway/identify/curve_prior.hpp"
#include "slideway/identify/solve.hpp"

namespace slideway {

Setup on_slide() {
  Setup setup;
  setup.kind = Kind::slide;
  return setup;
}

namespace {

/// Fills columns at the slide coordinates x.
using Fill = void (Effect::*)(const Stations&, std::span<const double>,
                              Eigen::Ref<Eigen::MatrixXd>) const;

Eigen::MatrixXd filled(Fill fill, Eigen::Index columns, const Model& model, const ModelTerm& term,
                       std::span<const double> shapes, Setup setup, const Eigen::VectorXd& x) {
  Eigen::MatrixXd out(x.size(), columns);
  if (columns == 0) return out;
  const Eigen::VectorXd positions =
      setup.kind == Kind::face ? Eigen::VectorXd(x.array() - setup.spindle_position_mm) : x;
  setup.center_mm = 0.0;
  setup.first_mm = positions[0];
  setup.last_mm = positions[positions.size() - 1];
  ((*term.effect).*fill)(
      {{positions.data(), static_cast<std::size_t>(positions.size())}, setup, model.machine},
      shapes, out);
  return out;
}

}  // namespace

Eigen::MatrixXd form_columns(const Model& model, const ModelTerm& term,
                             std::span<const double> shapes, Setup setup,
                             const Eigen::VectorXd& x) {
  return filled(&Effect::columns, term.effect->amplitudes(), model, term, shapes, std::move(setup),
                x);
}

Eigen::MatrixXd form_derivatives(const Model& model, const ModelTerm& term,
                                 std::span<const double> shapes, Setup setup,
                                 const Eigen::VectorXd& x) {
  return filled(&Effect::derivatives, term.effect->amplitudes() * std::ssize(shapes), model, term,
                shapes, std::move(setup), x);
}

Eigen::VectorXd station_positions(const Model& model, const ModelTerm& term) {
  std::vector<double> x;
  for (const Observation* observation : fitted_observations(model)) {
    const Profile& profile = *observation->profile;
    if (profile.setup.kind != Kind::slide || !term.acts_on(profile)) continue;
    const Stations stations = profile.stations(model.machine);
    const double foot = profile.setup.base_mm.value_or(0.0) / 2.0;
    for (Eigen::Index i = 0; i < stations.size(); ++i)
      for (const double at : {stations.slide(i) - foot, stations.slide(i) + foot}) x.push_back(at);
  }
  if (x.empty()) return {};
  std::ranges::sort(x);
  const double same = 1e-3 * (x.back() - x.front()) / static_cast<double>(x.size());
  x.erase(std::unique(x.begin(), x.end(), [&](double a, double b) { return b - a <= same; }),
          x.end());
  return Eigen::Map<const Eigen::VectorXd>(x.data(), std::ssize(x));
}

bool is_of_slides(const Model& model, const ModelTerm& term) {
  return std::ranges::none_of(fitted_observations(model), [&](const Observation* each) {
    return each->profile->setup.kind != Kind::slide && term.acts_on(*each->profile);
  });
}

bool has_few_stations(const Model& model, const ModelTerm& term) {
  if (&term == curve_term(model) || !is_of_slides(model, term)) return false;
  const double cycles = 0.5 * (term.effect->amplitudes() - 1);  // a polynomial of degree n: n / 2
  return static_cast<double>(station_positions(model, term).size()) <
         model.gates.values_per_cycle * cycles;
}

}  // namespace slideway
