#pragma once

#include <optional>
#include <string>
#include <vector>

#include "expression.hpp"
#include "formula_units.hpp"
#include "slideway/effects/formula.hpp"

namespace slideway {

// A variable of a formula.
struct FormulaVariable {
  const char* name;
  double (*read)(const Stations&, Eigen::Index);
  const char* unit;
  std::optional<IndependentVariable> needs;  // whose metadata it needs
  bool of_faces = false;
  const char* key = nullptr;  // of the problem file, that it is, where that may be left out
  bool (*is_known)(const Setup&) = nullptr;
};

const std::vector<FormulaVariable>& formula_variables();

// A formula taken to pieces: which of its names are amplitudes, which shapes.
class FormulaParts {
 public:
  // Throws as formula_effect().
  explicit FormulaParts(const Formula& formula);

  [[nodiscard]] const Formula& formula() const { return formula_; }
  [[nodiscard]] const Expression& expression() const { return expression_; }
  // Amplitudes first.
  [[nodiscard]] const std::vector<Parameter>& parameters() const { return parameters_; }
  [[nodiscard]] std::size_t amplitudes() const { return amplitudes_.size(); }
  [[nodiscard]] std::size_t shapes() const { return shapes_.size(); }
  [[nodiscard]] Quantity quantity() const { return quantity_; }
  // Of the variables it uses; at least one.
  [[nodiscard]] std::vector<const FormulaVariable*> variables() const;

  // Of each variable at every station; empty: it does not use it.
  [[nodiscard]] std::vector<std::vector<double>> readings(const Stations& stations) const;
  // Sets the variables it uses to what they are at a station.
  void set_station(const Stations& stations, Eigen::Index i, std::span<double> values) const;
  // Sets the amplitudes to 0 but for one, which is 1.
  void set_amplitude(std::size_t one, std::span<double> values) const;
  void set_shapes(std::span<const double> shape, std::span<double> values) const;

 private:
  void sort_parameters();
  [[nodiscard]] UnitPowers powers_in(const FormulaParameter& parameter) const;
  void check_sizes();
  void check_units();
  void describe_parameters();
  [[noreturn]] void refuse(const std::string& name, const std::string& what) const;

  Formula formula_;
  Expression expression_;
  std::vector<std::size_t> amplitudes_, shapes_;  // places among the values of the expression
  std::vector<Parameter> parameters_;
  Quantity quantity_ = Quantity::height;
};

// Whether a shape is searched on a logarithmic scale.
bool is_logarithmic(double lower, double upper);

// What makes a formula useless on a profile: not finite, or a pole between two stations or two
// shapes in range; with the column of what goes to infinity and the place. "": nothing.
std::string fault_of(const FormulaParts& parts, const Stations& stations);

}  // namespace slideway
