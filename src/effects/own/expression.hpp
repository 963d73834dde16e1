#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "slideway/effects/formula.hpp"

namespace slideway {

// An arithmetic expression of named numbers, parsed once, or a function of them. Any number of
// threads may evaluate it.
class Expression {
 public:
  // Throws UsageError "column 5: what is wrong; accepted: ...".
  Expression(const std::string& text, const std::vector<std::string>& names);

  // The function of a formula. The first names are variables, the others its parameters.
  Expression(const Formula& formula, const std::vector<std::string>& names);

  [[nodiscard]] bool uses(std::size_t name) const;

  struct Parsed;

  // A parser of one thread's own for a while.
  class Evaluation {
   public:
    explicit Evaluation(const Expression& expression);
    ~Evaluation();
    Evaluation(const Evaluation&) = delete;
    Evaluation& operator=(const Evaluation&) = delete;

    [[nodiscard]] std::span<double> values();  // of the names, to be set
    [[nodiscard]] double result();             // may be infinite, or NaN
    // As many results at once, for variables[v][i] in place of the values of the first names.
    void results(std::span<const std::vector<double>> variables, std::span<double> out);

   private:
    const Expression* expression_;
    std::unique_ptr<Parsed> parsed_;
  };

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

// Whether a function or a constant of expressions has this name.
bool is_word_of_expressions(const std::string& name);

}  // namespace slideway
