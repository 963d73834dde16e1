#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "slideway/effects/effect.hpp"

namespace slideway {

/// A parameter of a formula as its author declares it.
struct FormulaParameter {
  std::string name;
  std::string unit;
  std::optional<double> lower, upper;  // in the unit; needed where it does not enter linearly
};

/// A formula that is code: from n values of each variable it asked for and one of each parameter, n
/// results. It is called from several threads.
using FormulaFunction =
    std::function<std::vector<double>(const std::map<std::string, std::vector<double>>& variables,
                                      const std::map<std::string, double>& parameters)>;

/// An effect written down as a formula.
///
/// It gives µm of a height or µrad of a slope, from the variables r x X z (mm), theta (rad), t m
/// t_read (s), k (turns), s (m), R (cut_radius_mm), feed (mm/min), rpm (1/min), pi, and its
/// parameters. A parameter that enters linearly is an amplitude; its unit begins with um (the
/// formula is of heights) or urad (of slopes). All others are shapes, searched between their
/// bounds.
struct Formula {
  std::string name;  // of the effect, in the report
  std::string text;  // "a * (1 - exp(-t / tau))"
  std::vector<FormulaParameter> parameters;
  std::string standard_name = {}, cause = {}, source = {}, typical = {};
  std::string confounded_with = {}, separated_by = {};
  FormulaFunction function = {};            // instead of the text, which then only describes it
  std::vector<std::string> variables = {};  // that the function takes
};

/// Parses the formula once and finds out which parameters enter linearly.
/// @throws UsageError  "column 5: what is wrong; accepted: ...": a syntax error, a name that is
///                     unknown or taken, a parameter without use, without bounds where it needs
///                     them or with a unit that does not fit, no amplitude, a part without one, a
///                     jump that a shape would move
EffectFactory formula_effect(const Formula& formula);

/// Whether a text can name an effect or a parameter: a letter, then letters, digits, underscores.
bool is_identifier(const std::string& text);

}  // namespace slideway
