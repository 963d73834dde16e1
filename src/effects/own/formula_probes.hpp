#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "expression.hpp"
#include "slideway/effects/formula.hpp"

namespace slideway {

// A formula tried at ordinary places of ordinary cuts, with ordinary parameters: which of its
// parameters enter linearly, all together, and which move a jump.
class FormulaProbes {
 public:
  FormulaProbes(const Formula& formula, const Expression& expression);

  // How many of the places gave a finite number.
  [[nodiscard]] std::size_t finite() const { return places_.size(); }

  // g(λu + μv) = λ g(u) + μ g(v), g(u) = f(u) - f(0), in these parameters, all others fixed.
  [[nodiscard]] bool are_linear(const std::vector<std::size_t>& parameters);

  // f does not change with the parameter but where it jumps.
  [[nodiscard]] bool moves_a_jump(std::size_t parameter);

  // p where f(λ^e_1 v_1, λ^e_2 v_2, ...) = λ^p f(v_1, v_2, ...) of all names, those of all sizes
  // but one being 0; none: it is no power.
  [[nodiscard]] std::optional<double> degree(const std::vector<double>& exponents,
                                             std::span<const std::size_t> sizes, std::size_t of);

  // 0 where all of these are 0.
  [[nodiscard]] bool vanishes_without(const std::vector<std::size_t>& parameters);

 private:
  [[nodiscard]] double value(const std::vector<double>& place);

  std::vector<FormulaParameter> parameters_;
  Expression::Evaluation evaluation_;
  std::size_t first_ = 0;                             // of the parameters, among the values
  std::vector<std::vector<double>> places_, others_;  // values of all names
};

}  // namespace slideway
