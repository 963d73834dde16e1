#include "form_library.hpp"

#include <algorithm>
#include <cmath>

#include "slideway/base/text.hpp"

namespace slideway {
namespace {

constexpr std::size_t kFormPlaces = 24;  // over the range
constexpr std::size_t kFormWidths = 4;   // from a 100th to a quarter of it
constexpr std::size_t kFormLengths = 8;  // from a 40th to twice of it
constexpr std::size_t kExponents = 7;    // from 1/5 to 5
constexpr double kMostCycles = 12.0;     // over the range
constexpr double kCyclesApart = 0.5;     // of two waves of the grid
constexpr std::size_t kChanges = 9;
constexpr double kMostChange = 8.0;         // of the cycles over the range, by a changing period
constexpr double kNarrowest = 2.0;          // low-band values
constexpr double kNearOrigin = 0.05;        // of the range: counted from 0 as well
constexpr std::size_t kLargestPieces = 10;  // of the decade of the range an origin is rounded to

/// {x} is the variable, {v} the same from where its readings begin, {V} their range; the others are
/// parameters, a size with its own unit behind a colon.
struct Template {
  const char* name;
  const char* text;
  bool is_local = false;
};

constexpr Template kTemplates[] = {
    {"line", "{a:1} * {v}"},
    {"parabola", "{a:1} * {v} + {b:2} * {v}^2"},
    {"cubic", "{a:1} * {v} + {b:2} * {v}^2 + {c:3} * {v}^3"},
    {"exponential", "{a} * (1 - exp(-{v} / {tau}))", true},
    {"growing exponential", "{a} * exp(({v} - {V}) / {tau})"},
    {"stretched exponential", "{a} * (1 - exp(-({v} / {tau})^{n}))"},
    {"power", "{a} * ({v} / {V})^{n}"},
    {"smooth step", "{a} * (1 + tanh(({x} - {x0}) / {w})) / 2", true},
    {"kink", "{a:1} * max({x} - {x0}, 0)", true},
    {"bump", "{a} * exp(-(({x} - {x0}) / {w})^2 / 2)", true},
    {"wave", "{a} * cos(2 * pi * {f} * {v}) + {b} * sin(2 * pi * {f} * {v})"},
    {"chirp",
     "{a} * cos(2 * pi * ({f} * {v} + {g} * {v}^2)) + {b} * sin(2 * pi * ({f} * {v} + {g} * "
     "{v}^2))"},
    {"line * exponential", "{a:1} * {v} * exp(-{v} / {tau})"},
    {"line * wave", "{v} / {V} * ({a} * cos(2 * pi * {f} * {v}) + {b} * sin(2 * pi * {f} * {v}))"},
    {"exponential * wave",
     "exp(-{v} / {tau}) * ({a} * cos(2 * pi * {f} * {v}) + {b} * sin(2 * pi * {f} * {v}))"},
    {"exponential from a kink", "{a} * (1 - exp(-max({x} - {x0}, 0) / {tau}))"}};

std::vector<double> spread(double low, double high, std::size_t count, bool logarithmic) {
  std::vector<double> out;
  for (std::size_t i = 0; i < count; ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(count - 1);
    out.push_back(logarithmic ? low * std::pow(high / low, part) : low + (high - low) * part);
  }
  return out;
}

/// A template as it is filled in for a variable.
class Writer {
 public:
  explicit Writer(const FormVariable& variable)
      : variable_(variable), range_(variable.high - variable.low) {}

  /// @param suffix  of its parameters' names: "" or a digit
  void append(const Template& from, const std::string& suffix, ShortForm& out) const {
    const std::string text = from.text;
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t open = std::min(text.find('{', at), text.size());
      out.formula.text += text.substr(at, open - at);
      if (open == text.size()) return;
      const std::size_t close = text.find('}', open);
      out.formula.text += word(text.substr(open + 1, close - open - 1), suffix, out);
      at = close + 1;
    }
  }

 private:
  std::string word(const std::string& key, const std::string& suffix, ShortForm& out) const {
    if (key == "x") return variable_.name;
    if (key == "v") return from_origin();
    if (key == "V") return significant(range_, 4);
    const std::string base = key.substr(0, key.find(':'));
    std::string name =
        base == "x0" ? variable_.name + (suffix.empty() ? "0" : suffix) : base + suffix;
    std::vector<FormulaParameter>& known = out.formula.parameters;
    if (std::ranges::find(known, name, &FormulaParameter::name) == known.end())
      declare(key, name, out);
    return name;
  }

  void declare(const std::string& key, const std::string& name, ShortForm& out) const {
    FormulaParameter parameter{name, "", {}, {}};
    const std::size_t colon = key.find(':');
    const bool is_size = key == "a" || key == "b" || colon != std::string::npos;
    if (is_size) {
      parameter.unit = variable_.size_unit;
      if (colon != std::string::npos) parameter.unit += "/" + power_of_unit(key.substr(colon + 1));
    } else {
      auto [unit, axis] = shape(key);
      parameter.unit = unit;
      parameter.lower = axis.front();
      parameter.upper = axis.back();
      out.axes.push_back(std::move(axis));
    }
    out.formula.parameters.push_back(std::move(parameter));
  }

  [[nodiscard]] std::pair<std::string, std::vector<double>> shape(const std::string& key) const {
    const double finest = kNarrowest * variable_.step;
    if (key == "x0")
      return {variable_.unit, spread(variable_.low, variable_.high, kFormPlaces, false)};
    if (key == "w")
      return {variable_.unit,
              spread(std::max(finest, range_ / 100.0), range_ / 4.0, kFormWidths, true)};
    if (key == "tau")
      return {variable_.unit,
              spread(std::max(finest, range_ / 40.0), 2.0 * range_, kFormLengths, true)};
    if (key == "n") return {"1", spread(0.2, 5.0, kExponents, true)};
    const double most = std::min(kMostCycles, range_ / (2.0 * finest));
    if (key == "f")
      return {"1/" + variable_.unit,
              spread(kCyclesApart / range_, most / range_,
                     std::max<std::size_t>(2, std::lround(most / kCyclesApart)), false)};
    const double change = std::min(kMostChange, most) / (range_ * range_);
    return {"1/" + power_of_unit("2"), spread(-change, change, kChanges, false)};
  }

  [[nodiscard]] std::string power_of_unit(const std::string& power) const {
    return power == "1" ? variable_.unit : variable_.unit + "^" + power;
  }

  [[nodiscard]] std::string from_origin() const {
    if (variable_.low >= 0.0 && variable_.low <= kNearOrigin * range_) return variable_.name;
    const double unit = std::pow(10.0, std::floor(std::log10(range_))) / kLargestPieces;
    const double origin = unit * std::floor((variable_.low - variable_.step) / unit);
    return "(" + variable_.name + (origin < 0.0 ? " + " : " - ") +
           significant(std::abs(origin), 6) + ")";
  }

  const FormVariable& variable_;
  double range_;
};

ShortForm written(const FormVariable& variable, const Template& from) {
  ShortForm out{from.name, {}, {}, from.is_local};
  Writer(variable).append(from, "", out);
  return out;
}

const Template& template_of(const std::string& name) {
  return *std::ranges::find_if(kTemplates, [&](const Template& each) { return each.name == name; });
}

}  // namespace

std::vector<ShortForm> short_forms(const FormVariable& variable) {
  std::vector<ShortForm> out;
  for (const Template& each : kTemplates) out.push_back(written(variable, each));
  return out;
}

ShortForm sum_of(const FormVariable& variable, const std::string& first,
                 const std::string& second) {
  ShortForm out{first + " + " + second, {}, {}};
  const Writer writer(variable);
  writer.append(template_of(first), "1", out);
  out.formula.text += " + ";
  writer.append(template_of(second), "2", out);
  return out;
}

}  // namespace slideway
