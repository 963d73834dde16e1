#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "slideway/base/minimum.hpp"
#include "slideway/identify/fit.hpp"
#include "slideway/identify/linear_algebra.hpp"
#include "slideway/identify/shape_grid.hpp"

namespace slideway {
namespace {

constexpr std::size_t kMostPlaces = 64;  // of a shape: its likelihood is smoother than its grid

/// The best fit with the shapes held where they are.
struct HeldFit {
  double chi_square = 0.0;
  Eigen::VectorXd amplitudes;
};

/// @param moved  the term whose shapes are other ones than those of the fit
HeldFit held_at(const Model& model, const Solution& fit, const ModelTerm& moved,
                const Eigen::VectorXd& shapes) {
  Estimate at = fit.estimate;
  at.shapes = shapes;
  Linearisation linear = fit.linear;
  for (std::size_t i = 0; i < linear.columns.size(); ++i)
    linear.columns[i].middleCols(moved.first_amplitude, moved.effect->amplitudes()) =
        low_band_columns(model, moved, *linear.observations[i], shapes_of(moved, shapes));
  set_residuals(model, at, linear);
  const Eigen::Index count = model.amplitudes();
  // In the place of the shapes the residual: what is left of it stands on the diagonal.
  const auto hold = [&](Eigen::MatrixXd& columns, const Eigen::VectorXd& residual) {
    columns.rightCols(model.shapes()).setZero();
    columns.col(count) = residual;
  };
  for (std::size_t i = 0; i < linear.columns.size(); ++i)
    hold(linear.columns[i], linear.residuals[i]);
  hold(linear.prior_rows, linear.prior_residuals);
  const Eigen::MatrixXd triangle = compress(linear, fit.noise).triangle;
  const double left = triangle(count, count);
  return {left * left, at.amplitudes + least_squares(triangle.topLeftCorner(count, count),
                                                     triangle.col(count).head(count))
                                           .values};
}

std::vector<double> places_of(const Model& model, const ModelTerm& term, int shape) {
  const std::vector<double> grid = shape_grid(model, term, shape);
  return every(1 + (grid.size() - 1) / kMostPlaces, grid);
}

/// What (amplitudes, shapes) change to get to a shape that a fit allows as well.
struct OtherPlace {
  OtherShape shape;
  Eigen::VectorXd change;
};

/// Looks along one shape for values that the fit allows.
class Profiled {
 public:
  Profiled(const Model& model, const Solution& fit, const ModelTerm& term, int shape)
      : model_(model),
        fit_(fit),
        term_(term),
        best_(held_at(model, fit, term, fit.estimate.shapes)),
        index_(term.first_shape + shape),
        parameter_(term.first_parameter +
                   term.effect->shapes()[static_cast<std::size_t>(shape)].parameter),
        places_(places_of(model, term, shape)) {}

  /// The farthest one beyond U.
  [[nodiscard]] std::optional<OtherPlace> farthest() const {
    const Spread spread = fit_.uncertainty.of(fit_.parameters.jacobian.row(parameter_));
    const double factor = coverage_factor(spread.degrees_of_freedom);
    const double allowed = factor * factor * fit_.uncertainty.inflation;
    double reach = factor * spread.standard_uncertainty;
    std::vector<double> more;
    for (const double place : places_) more.push_back(away(place) > reach ? more_at(place) : 0.0);
    std::optional<double> found;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      double value = places_[i], least = more[i];
      const bool is_minimum = i > 0 && i + 1 < places_.size() && least > allowed &&
                              least <= more[i - 1] && least <= more[i + 1];
      if (is_minimum) {
        value = place_of_minimum([this](double at) { return more_at(at); }, places_[i - 1],
                                 places_[i + 1]);
        least = more_at(value);
      }
      if (!(least <= allowed) || !(away(value) > reach)) continue;
      found = value;
      reach = away(value);
    }
    if (!found) return std::nullopt;
    const HeldFit held = held_at(model_, fit_, term_, shapes_at(*found));
    Eigen::VectorXd change(held.amplitudes.size() + fit_.estimate.shapes.size());
    change << held.amplitudes - best_.amplitudes, shapes_at(*found) - fit_.estimate.shapes;
    return OtherPlace{{parameter_, *found, std::max(held.chi_square - best_.chi_square, 0.0)},
                      std::move(change)};
  }

 private:
  [[nodiscard]] double away(double value) const {
    return std::abs(value - fit_.estimate.shapes[index_]);
  }
  [[nodiscard]] Eigen::VectorXd shapes_at(double value) const {
    Eigen::VectorXd out = fit_.estimate.shapes;
    out[index_] = value;
    return out;
  }
  [[nodiscard]] double more_at(double value) const {
    return held_at(model_, fit_, term_, shapes_at(value)).chi_square - best_.chi_square;
  }

  const Model& model_;
  const Solution& fit_;
  const ModelTerm& term_;
  HeldFit best_;
  Eigen::Index index_, parameter_;
  std::vector<double> places_;  // rising
};

/// Whether it is a formula of the user's own: a regression, whose U is that of its linear model.
bool is_regression(const DeclaredEffect& declared, const ModelTerm& term) {
  return declared.options.own && !term.effect->description().measured;
}

}  // namespace

void allow_for_other_shapes(const Problem& problem, FittedModel& fitted) {
  Solution& fit = fitted.fit;
  const Model& model = fitted.model;
  const bool has_loss = std::ranges::any_of(fit.linear.observations, [](const Observation* each) {
    return each->profile->loss != Loss::none;
  });
  if (model.shapes() == 0 || has_loss || !fit.converged) return;
  std::vector<OtherPlace> all;
  for (std::size_t e = 0; e < problem.effects.size(); ++e) {  // the first terms, in their order
    const ModelTerm& term = model.terms[e];
    for (std::size_t s = 0; s < term.effect->shapes().size(); ++s) {
      const Shape& kind = term.effect->shapes()[s];
      if (kind.stepwise || kind.higher_order ||
          !fit.null.identifiable[static_cast<std::size_t>(term.first_parameter) +
                                 static_cast<std::size_t>(kind.parameter)])
        continue;
      auto found = Profiled(model, fit, term, static_cast<int>(s)).farthest();
      if (!found) continue;
      found->shape.in_uncertainty = !is_regression(problem.effects[e], term);
      all.push_back(*std::move(found));
    }
  }
  if (all.empty()) return;
  const Compressed compressed = compress(fit.linear, fit.noise);
  for (const OtherPlace& each : all) {
    if (each.shape.in_uncertainty)
      fit.uncertainty.add(each.change * each.change.transpose() / 3.0, compressed);
    fit.other_shapes.push_back(each.shape);
  }
}

}  // namespace slideway
