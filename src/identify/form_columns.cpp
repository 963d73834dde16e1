#include "form_columns.hpp"

#include <utility>

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

}  // namespace slideway
