#include "slideway/effects/formula.hpp"

#include <algorithm>
#include <cmath>

#include "../linear_effect.hpp"
#include "formula_parts.hpp"
#include "numeric_derivative.hpp"
#include "slideway/base/text.hpp"

namespace slideway {
namespace {

constexpr double kStep = 0.02;      // of a shape or of its range: the first of a derivative
constexpr double kVisible = 0.5;    // of the columns: a change that a search grid must not skip
constexpr double kFinest = 1e-4;    // of the range of a shape: a search looks no closer
constexpr double kSearched = 40.0;  // steps over the range, at least

/// The independent variable that says most: what a turn, a distance or a time needs to be known.
IndependentVariable leading(const std::vector<const FormulaVariable*>& variables) {
  using enum IndependentVariable;
  for (const IndependentVariable each :
       {distance, revolution, time, reading_time, measuring_time, trace, slide, radius})
    for (const FormulaVariable* variable : variables)
      if (variable->needs == each) return each;
  return radius;
}

Description describe(const FormulaParts& parts) {
  const Formula& formula = parts.formula();
  const auto or_else = [](const std::string& text, const char* otherwise) {
    return text.empty() ? otherwise : text;
  };
  return {.name = formula.name,
          .plain_name = in_words(formula.name),
          .standard_name = or_else(formula.standard_name, "an effect of the user's own"),
          .formula = formula.text,
          .source = or_else(formula.source, "the problem file"),
          .cause = or_else(formula.cause, "not given"),
          .typical = or_else(formula.typical, "not given"),
          .variable = leading(parts.variables()),
          .confounded_with = formula.confounded_with,
          .separated_by = formula.separated_by};
}

std::vector<Shape> shapes_of(const FormulaParts& parts) {
  std::vector<Shape> out;
  for (std::size_t s = 0; s < parts.shapes(); ++s) {
    const std::size_t place = parts.amplitudes() + s;
    const Parameter& parameter = parts.parameters()[place];
    out.push_back({.parameter = static_cast<int>(place),
                   .logarithmic = is_logarithmic(parameter.lower, parameter.upper)});
  }
  return out;
}

double unit_of(const FormulaParts& parts) {
  return parts.quantity() == Quantity::slope ? kMicroradian : kMicrometre;
}

class FormulaEffect : public LinearEffect {
 public:
  explicit FormulaEffect(std::shared_ptr<const FormulaParts> parts)
      : LinearEffect(describe(*parts), parts->parameters(),
                     diagonal_map(static_cast<Eigen::Index>(parts->amplitudes()), unit_of(*parts)),
                     shapes_of(*parts)),
        parts_(std::move(parts)) {}

  [[nodiscard]] bool applies_to(const Setup& setup) const override {
    return setup.quantity == parts_->quantity() &&
           (setup.kind == Kind::face ||
            std::ranges::none_of(parts_->variables(),
                                 [](const FormulaVariable* each) { return each->of_faces; }));
  }

  [[nodiscard]] std::vector<std::string> lacking(const Setup& setup) const override {
    std::vector<std::string> keys;
    const auto add = [&](const std::string& key) {
      if (std::ranges::count(keys, key) == 0) keys.push_back(key);
    };
    for (const FormulaVariable* variable : parts_->variables()) {
      if (variable->needs)
        for (const std::string& key : missing_for(*variable->needs, setup)) add(key);
      if (variable->is_known && !variable->is_known(setup)) add(variable->key);
    }
    return keys;
  }

  [[nodiscard]] double resolution(int shape, double value, const Stations& stations) const override;
  [[nodiscard]] std::string fault(const Stations& stations) const override {
    return fault_of(*parts_, stations);
  }
  void columns(const Stations& stations, std::span<const double> shape,
               Eigen::Ref<Eigen::MatrixXd> out) const override;
  void derivatives(const Stations& stations, std::span<const double> shape,
                   Eigen::Ref<Eigen::MatrixXd> out) const override;

 private:
  /// Of the columns by one shape.
  [[nodiscard]] Eigen::MatrixXd derivative(const Stations& stations, std::span<const double> shape,
                                           int which) const;
  [[nodiscard]] double range_of_shape(int shape) const {
    const Parameter& parameter = parameters()[shapes()[shape].parameter];
    return parameter.upper - parameter.lower;
  }

  std::shared_ptr<const FormulaParts> parts_;
};

void FormulaEffect::columns(const Stations& stations, std::span<const double> shape,
                            Eigen::Ref<Eigen::MatrixXd> out) const {
  if (!applies_to(stations.setup())) return void(out.setZero());
  Expression::Evaluation evaluation(parts_->expression());
  parts_->set_shapes(shape, evaluation.values());
  const std::vector<std::vector<double>> readings = parts_->readings(stations);
  std::vector<double> results(static_cast<std::size_t>(stations.size()));
  for (std::size_t j = 0; j < parts_->amplitudes(); ++j) {
    parts_->set_amplitude(j, evaluation.values());
    evaluation.results(readings, results);
    out.col(static_cast<Eigen::Index>(j)) =
        Eigen::Map<const Eigen::VectorXd>(results.data(), stations.size());
  }
}

Eigen::MatrixXd FormulaEffect::derivative(const Stations& stations, std::span<const double> shape,
                                          int which) const {
  std::vector<double> moved(shape.begin(), shape.end());
  const auto at = [&](double value) {
    moved[which] = value;
    Eigen::MatrixXd result(stations.size(), amplitudes());
    columns(stations, moved, result);
    return result;
  };
  const Parameter& parameter = parameters()[shapes()[which].parameter];
  const double step = kStep * (shapes()[which].logarithmic ? shape[which] : range_of_shape(which));
  return numeric_derivative(at, shape[which], step, parameter.lower, parameter.upper).value;
}

void FormulaEffect::derivatives(const Stations& stations, std::span<const double> shape,
                                Eigen::Ref<Eigen::MatrixXd> out) const {
  if (!applies_to(stations.setup())) return void(out.setZero());
  for (int s = 0; s < static_cast<int>(shape.size()); ++s)
    out.middleCols(s * amplitudes(), amplitudes()) = derivative(stations, shape, s);
}

double FormulaEffect::resolution(int shape, double value, const Stations& stations) const {
  std::vector<double> middle;
  for (const Shape& each : shapes()) {
    const Parameter& parameter = parameters()[each.parameter];
    middle.push_back(each.outer(0.5 * (each.inner(parameter.lower) + each.inner(parameter.upper))));
  }
  middle[shape] = value;
  Eigen::MatrixXd here(stations.size(), amplitudes());
  columns(stations, middle, here);
  Eigen::MatrixXd change = derivative(stations, middle, shape);
  here.rowwise() -= here.colwise().mean().eval();
  change.rowwise() -= change.colwise().mean().eval();
  const double coarsest = shapes()[shape].logarithmic ? Effect::resolution(shape, value, stations)
                                                      : range_of_shape(shape) / kSearched;
  const double visible = kVisible * here.norm() / change.norm();  // NaN: not seen at all
  return visible < coarsest ? std::max(visible, kFinest * range_of_shape(shape)) : coarsest;
}

}  // namespace

EffectFactory formula_effect(const Formula& formula) {
  auto parts = std::make_shared<const FormulaParts>(formula);
  return [parts = std::move(parts)](const Machine&, const TravelRange&) {
    return std::make_unique<FormulaEffect>(parts);
  };
}

}  // namespace slideway
