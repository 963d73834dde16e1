#include "formula_units.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"

namespace slideway {
namespace {

bool is_letter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0 || static_cast<unsigned char>(c) > 127;
}

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

bool has_no_dimension(const std::string& symbol) {
  for (const char* each : {"rad", "turn", "turns", "rev", "cycle", "cycles", "%", "1"})
    if (symbol == each) return true;
  return false;
}

/// Reads a unit from left to right: symbols with powers, between * and / or blanks; what is in
/// brackets counts as one.
class UnitReader {
 public:
  explicit UnitReader(const std::string& unit) : unit_(unit) {}

  UnitPowers read() {
    product(1.0, false);
    return std::move(powers_);
  }

 private:
  [[noreturn]] void fail() const {
    throw UsageError("\"" + printable(unit_) + "\"; accepted: as um, um/s, mm^-2, um/(m s), 1");
  }

  [[nodiscard]] bool at_end() const { return at_ >= unit_.size(); }
  bool takes(char c) {
    if (at_end() || unit_[at_] != c) return false;
    ++at_;
    return true;
  }

  void product(double sign, bool in_brackets) {
    double next = sign;
    for (bool any = false;; any = true) {
      while (takes(' ') || takes('*')) {
      }
      if (at_end() || (in_brackets && unit_[at_] == ')')) {
        if (!any) fail();
        return;
      }
      if (any && takes('/')) {
        next = -sign;
        while (takes(' ')) {
        }
      }
      factor(next);
      next = sign;
    }
  }

  void factor(double sign) {
    if (takes('(')) {
      product(sign, true);
      if (!takes(')')) fail();
      return;
    }
    const std::size_t first = at_;
    if (!takes('1') && !takes('%'))
      while (!at_end() && is_letter(unit_[at_])) ++at_;
    const std::string symbol = unit_.substr(first, at_ - first);
    if (symbol.empty()) fail();
    const double power = sign * exponent();
    if (has_no_dimension(symbol)) return;
    if (symbol == "Hz")
      powers_["s"] -= power;
    else
      powers_[symbol] += power;
  }

  double exponent() {
    const bool is_marked = takes('^');
    const double sign = is_marked && takes('-') ? -1.0 : 1.0;
    double out = 0.0;
    const std::size_t first = at_;
    while (!at_end() && (is_digit(unit_[at_]) || (is_marked && unit_[at_] == '.'))) ++at_;
    std::from_chars(unit_.data() + first, unit_.data() + at_, out);
    if (at_ == first && is_marked) fail();
    return at_ == first ? 1.0 : sign * out;
  }

  const std::string& unit_;
  std::size_t at_ = 0;
  UnitPowers powers_;
};

}  // namespace

UnitPowers powers_of(const std::string& unit) { return UnitReader(unit).read(); }

std::string spelled(const UnitPowers& powers) {
  const auto raised = [](const std::string& symbol, double power) {
    return power == 1.0 ? symbol : symbol + "^" + significant(power, 3);
  };
  std::vector<std::string> above, below;
  for (const auto& [symbol, power] : powers) {
    if (power > 0.0) above.push_back(raised(symbol, power));
    if (power < 0.0) below.push_back(raised(symbol, -power));
  }
  std::string over = above.empty() ? "1" : joined(above, " ");
  if (below.empty()) return over;
  return over + "/" + (below.size() == 1 ? below.front() : "(" + joined(below, " ") + ")");
}

std::vector<FormulaNumber> numbers_with_unit(const std::string& text) {
  std::vector<FormulaNumber> out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (is_letter(text[i]) || text[i] == '_') {  // a name, digits and all
      while (i + 1 < text.size() &&
             (is_letter(text[i + 1]) || is_digit(text[i + 1]) || text[i + 1] == '_'))
        ++i;
      continue;
    }
    if (!is_digit(text[i]) && text[i] != '.') continue;
    double number = INFINITY;
    const char* const first = text.data() + i;
    const auto end = std::from_chars(first, text.data() + text.size(), number).ptr;
    const auto length = static_cast<std::size_t>(std::max<std::ptrdiff_t>(end - first, 1));
    const bool is_of_law = number == 0.5 || (number == std::floor(number) && number <= 4.0);
    if (!is_of_law) out.push_back({i, length, number});
    i += length - 1;
  }
  return out;
}

}  // namespace slideway
