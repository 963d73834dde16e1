#include "formula_parts.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "../variable_range.hpp"
#include "formula_probes.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"

namespace slideway {
namespace {

constexpr std::size_t kFewestFinite = 20;    // of the places a formula is tried at
constexpr double kLogarithmic = 10.0;        // upper over lower, from which a shape is searched so
constexpr std::size_t kMostParameters = 12;  // of one formula
constexpr std::size_t kMostNumbers = 3;      // whose units are looked for

/// Of a trace on the workpiece, from the mark of azimuth_deg; the other half of a diameter lies
/// half a turn further.
double azimuth_of(const Stations& stations, Eigen::Index i) {
  constexpr double kHalfTurn = 180.0;
  return stations.setup().azimuth_deg * kPi / kHalfTurn + (stations.trace(i) < 0.0 ? kPi : 0.0);
}

std::vector<std::string> names_of(const Formula& formula) {
  std::vector<std::string> names;
  for (const FormulaVariable& variable : formula_variables()) names.emplace_back(variable.name);
  for (const FormulaParameter& parameter : formula.parameters) {
    const std::string& name = parameter.name;
    const std::string what = "parameter '" + printable(name) + "' ";
    if (!is_identifier(name))
      throw UsageError(what + "is no name; accepted: a letter, then letters, digits, _");
    if (is_word_of_expressions(name) || std::ranges::count(names, name) > 0)
      throw UsageError(what + "has a name that is taken; accepted: none of " + joined(names, " ") +
                       " pi, nor a function");
    names.push_back(name);
  }
  if (formula.parameters.size() > kMostParameters)
    throw UsageError("more than " + std::to_string(kMostParameters) + " parameters");
  return names;
}

/// Where a name stands in a formula; its end if it does not.
std::size_t place_of(const std::string& name, const std::string& text) {
  const auto is_part = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
  };
  for (std::size_t at = 0; (at = text.find(name, at)) != std::string::npos; ++at)
    if ((at == 0 || !is_part(text[at - 1])) &&
        (at + name.size() >= text.size() || !is_part(text[at + name.size()])))
      return at;
  return text.size();
}

/// Of a size in "um/min" or "mm um/s^2": height; of one in "urad/s": slope; of any other: none.
std::optional<Quantity> quantity_of(UnitPowers powers) {
  const bool is_height = powers["um"] == 1.0, is_slope = powers["urad"] == 1.0;
  if (is_height == is_slope) return std::nullopt;
  return is_slope ? Quantity::slope : Quantity::height;
}

/// The power of one unit in that of every name.
std::vector<double> exponents_of(const std::string& symbol, const std::vector<UnitPowers>& powers) {
  std::vector<double> out;
  for (const UnitPowers& of_name : powers) {
    const auto at = of_name.find(symbol);
    out.push_back(at == of_name.end() ? 0.0 : at->second);
  }
  return out;
}

/// The same formula, with a parameter of one value for each number that may carry a unit.
Formula with_named_numbers(const Formula& formula) {
  Formula out = formula;
  std::vector<FormulaNumber> numbers = numbers_with_unit(formula.text);
  std::ranges::reverse(numbers);  // those to the left stay where they are
  for (const FormulaNumber& number : numbers) {
    const std::string name = "_" + std::to_string(number.first);  // as no parameter is called
    out.text.replace(number.first, number.length, "(" + name + ")");
    out.parameters.push_back({name, "1", number.value, number.value});
  }
  return out;
}

/// FormulaProbes::degree() with the powers of a unit in so many numbers, the last names, that bring
/// it nearest to what is wanted.
std::optional<double> nearest_degree(FormulaProbes& probes, std::vector<double> exponents,
                                     std::size_t numbers, double wanted,
                                     std::span<const std::size_t> sizes, std::size_t of) {
  constexpr double kPowers[] = {0.0, 1.0, -1.0, 2.0, -2.0, 0.5, 3.0, 4.0};
  const std::size_t first = exponents.size();
  exponents.resize(first + numbers, 0.0);
  std::vector<std::size_t> at(numbers, 0);
  for (std::optional<double> out;;) {
    for (std::size_t i = 0; i < numbers; ++i) exponents[first + i] = kPowers[at[i]];
    const std::optional<double> degree = probes.degree(exponents, sizes, of);
    if (degree && (!out || std::abs(*degree - wanted) < std::abs(*out - wanted))) out = degree;
    std::size_t next = 0;
    while (next < numbers && ++at[next] == std::size(kPowers)) at[next++] = 0;
    if (next == numbers || (out && std::round(2.0 * *out) == 2.0 * wanted)) return out;
  }
}

std::string symbol_of_unit(std::string unit) {
  if (unit.starts_with("um")) return "µm" + unit.substr(2);
  if (unit.starts_with("urad")) return "µrad" + unit.substr(4);
  return unit;
}

}  // namespace

bool is_identifier(const std::string& text) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  return !text.empty() && is_letter(text[0]) && std::ranges::all_of(text, [&](char c) {
    return is_letter(c) || (c >= '0' && c <= '9') || c == '_';
  });
}

bool is_logarithmic(double lower, double upper) {
  return lower > 0.0 && upper >= kLogarithmic * lower;
}

const std::vector<FormulaVariable>& formula_variables() {
  using enum IndependentVariable;
  static const std::vector<FormulaVariable> kAll{
      {"r", radius_of, "mm", radius, true},
      {"x", slide_of, "mm", slide},
      {"X", [](const Stations& s, Eigen::Index i) { return s.trace(i); }, "mm", trace},
      {"z", [](const Stations& s, Eigen::Index) { return s.setup().z_mm; }, "mm", std::nullopt},
      {"theta", azimuth_of, "rad", std::nullopt, true},
      {"t", time_of, "s", time},
      {"m", measuring_time_of, "s", measuring_time},
      {"t_read", reading_time_of, "s", reading_time},
      {"k", revolution_of, "turns", revolution},
      {"s", distance_m_of, "m", distance, true},
      {"R", [](const Stations& s, Eigen::Index) { return s.setup().cut_radius_mm.value_or(0.0); },
       "mm", std::nullopt, true, "cut_radius_mm",
       [](const Setup& setup) { return setup.cut_radius_mm.has_value(); }},
      {"feed",
       [](const Stations& s, Eigen::Index) { return s.setup().feed_mm_per_min.value_or(0.0); },
       "mm/min", std::nullopt, false, "feed_mm_per_min",
       [](const Setup& setup) { return setup.feed_mm_per_min.has_value(); }},
      {"rpm", [](const Stations& s, Eigen::Index) { return s.setup().spindle_rpm.value_or(0.0); },
       "1/min", std::nullopt, false, "spindle_rpm",
       [](const Setup& setup) { return setup.spindle_rpm.has_value(); }}};
  return kAll;
}

FormulaParts::FormulaParts(const Formula& formula)
    : formula_(formula),
      expression_(formula.function ? Expression(formula, names_of(formula))
                                   : Expression(formula.text, names_of(formula))) {
  if (variables().empty())
    throw UsageError("column 1: no variable: the effect is the same everywhere; accepted: " +
                     std::string("r x X z theta t m t_read k s R feed rpm"));
  sort_parameters();
  check_sizes();
  check_units();
  describe_parameters();
}

void FormulaParts::refuse(const std::string& name, const std::string& what) const {
  if (formula_.function) throw UsageError("'" + name + "' " + what);
  const std::size_t at = place_of(name, formula_.text);
  throw UsageError("column " + std::to_string(at + 1) + ": '" + name + "' " + what);
}

void FormulaParts::sort_parameters() {
  const std::size_t first = formula_variables().size();
  for (std::size_t p = 0; p < formula_.parameters.size(); ++p)
    if (!expression_.uses(first + p))
      throw UsageError("parameter '" + formula_.parameters[p].name + "' is not in the formula");
  FormulaProbes probes(formula_, expression_);
  if (probes.finite() < kFewestFinite)
    throw UsageError("column 1: the formula is not finite, wherever it is tried");
  std::vector<std::size_t> linear;
  // Those with bounds last: of two factors, the other one is the size.
  for (const bool bounded : {false, true})
    for (std::size_t p = 0; p < formula_.parameters.size(); ++p) {
      if ((formula_.parameters[p].lower || formula_.parameters[p].upper) != bounded) continue;
      linear.push_back(p);
      if (!probes.are_linear(linear)) linear.pop_back();
    }
  std::ranges::sort(linear);
  if (linear.empty())
    throw UsageError(
        "column 1: no parameter enters linearly; accepted: a * (...), with the size a");
  if (!probes.vanishes_without(linear))
    refuse(formula_.parameters[linear.front()].name,
           "is the size, and something is left of the formula where it is 0; accepted: an "
           "amplitude before every part");
  for (std::size_t p = 0; p < formula_.parameters.size(); ++p) {
    const FormulaParameter& parameter = formula_.parameters[p];
    const bool is_amplitude = std::ranges::count(linear, p) > 0;
    (is_amplitude ? amplitudes_ : shapes_).push_back(first + p);
    if (is_amplitude) continue;
    if (!parameter.lower || !parameter.upper)
      refuse(parameter.name, "does not enter linearly: it needs lower and upper, to be searched");
    if (probes.moves_a_jump(p))
      refuse(parameter.name,
             "moves a jump, or does nothing; accepted: a formula that changes smoothly with it, "
             "as 1/(1 + exp((r - r0)/w)) for a step");
  }
}

UnitPowers FormulaParts::powers_in(const FormulaParameter& parameter) const {
  try {
    return powers_of(parameter.unit);
  } catch (const UsageError& error) {
    refuse(parameter.name, std::string("has a unit that cannot be read: ") + error.what());
  }
}

void FormulaParts::check_sizes() {
  const std::size_t first = formula_variables().size();
  std::optional<Quantity> of_all;
  for (const std::size_t place : amplitudes_) {
    const FormulaParameter& parameter = formula_.parameters[place - first];
    const std::optional<Quantity> quantity = quantity_of(powers_in(parameter));
    if (!quantity)
      refuse(parameter.name, "enters linearly, in \"" + printable(parameter.unit) +
                                 "\"; accepted: um, or urad where the formula is of slopes, "
                                 "alone or by another unit, as um/min");
    if (of_all && *quantity != *of_all)
      refuse(parameter.name, "is in \"" + parameter.unit + "\", another size is not; accepted: " +
                                 "all in um or all in urad");
    of_all = quantity;
  }
  quantity_ = *of_all;
}

// Each unit is scaled alone: the formula has to follow as its sizes do, each of them beside no
// other. Its numbers may carry units: those with which it follows, if there are any. A law that is
// no power of a unit shows none. A size in um alone gets the unit that it has.
void FormulaParts::check_units() {
  if (formula_.function) return;
  const Formula numbered = with_named_numbers(formula_);
  const std::size_t numbers = numbered.parameters.size() - formula_.parameters.size();
  if (numbers > kMostNumbers) return;
  const std::string of_size = quantity_ == Quantity::slope ? "urad" : "um";
  const std::size_t first = formula_variables().size();
  std::vector<UnitPowers> powers;
  std::set<std::string> known;
  for (std::size_t i = 0; i < first; ++i) {
    powers.push_back(powers_of(formula_variables()[i].unit));
    if (!expression_.uses(i)) continue;
    for (const auto& [symbol, power] : powers.back()) known.insert(symbol);
  }
  const std::vector<std::string> of_variables(known.begin(), known.end());
  known.insert(of_size);
  std::set<std::string> all = known;
  for (const FormulaParameter& parameter : formula_.parameters) {
    powers.push_back(powers_in(parameter));
    for (const auto& [symbol, power] : powers.back()) all.insert(symbol);
  }
  const auto refuse_unit = [&](std::size_t name, const std::string& why,
                               const std::string& accepted) {
    const FormulaParameter& parameter = formula_.parameters[name - first];
    refuse(parameter.name, "is in \"" + parameter.unit + "\": " + why + "; accepted: " + accepted +
                               ", or a number in the formula that converts it");
  };
  Expression expression = expression_;
  if (numbers > 0) {
    std::vector<std::string> names = names_of(formula_);
    for (std::size_t i = formula_.parameters.size(); i < numbered.parameters.size(); ++i)
      names.push_back(numbered.parameters[i].name);
    expression = Expression(numbered.text, names);
  }
  FormulaProbes probes(numbered, expression);
  for (const std::size_t size : amplitudes_) {
    UnitPowers fitting = powers[size];
    for (const std::string& symbol : all) {
      const std::vector<double> exponents = exponents_of(symbol, powers);
      const double wanted = symbol == of_size ? 1.0 : 0.0;
      if (const auto degree =
              nearest_degree(probes, exponents, numbers, wanted, amplitudes_, size)) {
        const double more = std::round(2.0 * (*degree - wanted)) / 2.0;
        if (more != 0.0) fitting[symbol] -= more;
      } else if (!known.contains(symbol)) {
        for (std::size_t name = first; name < powers.size(); ++name)
          if (exponents[name] != 0.0)
            refuse_unit(name, "no variable of the formula is",
                        symbol == "deg" ? "rad" : joined(of_variables, " "));
      }
    }
    if (fitting == powers[size]) continue;
    if (powers[size].size() > 1)
      refuse_unit(size, "the formula is then not in " + of_size, spelled(fitting));
    formula_.parameters[size - first].unit = spelled(fitting);
  }
}

void FormulaParts::describe_parameters() {
  constexpr double kOrdinary = 0.1;  // µm
  const std::size_t first = formula_variables().size();
  for (const std::vector<std::size_t>* places : {&amplitudes_, &shapes_})
    for (const std::size_t place : *places) {
      const FormulaParameter& from = formula_.parameters[place - first];
      Parameter to{from.name, from.name, symbol_of_unit(from.unit), kOrdinary};
      if (from.lower) to.lower = *from.lower;
      if (from.upper) to.upper = *from.upper;
      if (places == &shapes_)
        to.scale = is_logarithmic(to.lower, to.upper) ? std::sqrt(to.lower * to.upper)
                                                      : 0.5 * (to.upper - to.lower);
      parameters_.push_back(std::move(to));
    }
}

std::vector<const FormulaVariable*> FormulaParts::variables() const {
  std::vector<const FormulaVariable*> out;
  for (std::size_t i = 0; i < formula_variables().size(); ++i)
    if (expression_.uses(i)) out.push_back(&formula_variables()[i]);
  return out;
}

std::vector<std::vector<double>> FormulaParts::readings(const Stations& stations) const {
  std::vector<std::vector<double>> out(formula_variables().size());
  for (std::size_t v = 0; v < out.size(); ++v)
    for (Eigen::Index i = 0; expression_.uses(v) && i < stations.size(); ++i)
      out[v].push_back(formula_variables()[v].read(stations, i));
  return out;
}

void FormulaParts::set_station(const Stations& stations, Eigen::Index i,
                               std::span<double> values) const {
  for (std::size_t v = 0; v < formula_variables().size(); ++v)
    if (expression_.uses(v)) values[v] = formula_variables()[v].read(stations, i);
}

void FormulaParts::set_amplitude(std::size_t one, std::span<double> values) const {
  for (std::size_t j = 0; j < amplitudes_.size(); ++j)
    values[amplitudes_[j]] = j == one ? 1.0 : 0.0;
}

void FormulaParts::set_shapes(std::span<const double> shape, std::span<double> values) const {
  for (std::size_t s = 0; s < shapes_.size(); ++s) values[shapes_[s]] = shape[s];
}

}  // namespace slideway
