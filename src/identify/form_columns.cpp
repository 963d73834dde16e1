#include "form_columns.hpp"

namespace slideway {

Setup on_slide() {
  Setup setup;
  setup.kind = Kind::slide;
  return setup;
}

Eigen::MatrixXd form_columns(const Model& model, const ModelTerm& term,
                             std::span<const double> shapes, Setup setup,
                             const Eigen::VectorXd& x) {
  const Eigen::VectorXd positions =
      setup.kind == Kind::face ? Eigen::VectorXd(x.array() - setup.spindle_position_mm) : x;
  setup.center_mm = 0.0;
  setup.first_mm = positions[0];
  setup.last_mm = positions[positions.size() - 1];
  Eigen::MatrixXd out(x.size(), term.effect->amplitudes());
  term.effect->columns(
      {{positions.data(), static_cast<std::size_t>(positions.size())}, setup, model.machine},
      shapes, out);
  return out;
}

}  // namespace slideway
