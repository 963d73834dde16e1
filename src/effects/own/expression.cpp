#include "expression.hpp"

#include <muParser.h>

#include <algorithm>
#include <mutex>

#include "formula_parts.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"

namespace slideway {
namespace {

constexpr std::size_t kLongest = 2000;  // characters

[[noreturn]] void refuse(std::size_t at, const std::string& what) {
  throw UsageError("column " + std::to_string(at + 1) + ": " + what);
}

mu::Parser bare_parser() {
  mu::Parser parser;
  parser.ClearConst();
  parser.DefineConst("pi", kPi);
  return parser;
}

std::string functions() {
  std::vector<std::string> names;
  const mu::Parser parser = bare_parser();
  for (const auto& [name, function] : parser.GetFunDef()) names.push_back(name);
  return joined(names, " ");
}

/// What the parser would take for something else than arithmetic.
void check_characters(const std::string& text) {
  if (text.size() > kLongest)
    refuse(kLongest, "too long; accepted: " + std::to_string(kLongest) + " characters");
  constexpr std::string_view kSigns = " +-*/^()<>=!&|?:.,_";
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (!letter && kSigns.find(c) == std::string_view::npos)
      refuse(i,
             "a character that is not of a formula; accepted: letters, digits,"
             " + - * / ^ ( ) < > == != && || ? : . ,");
    const char before = i > 0 ? text[i - 1] : ' ', after = i + 1 < text.size() ? text[i + 1] : ' ';
    if (c == '=' && after != '=' && std::string_view("=<>!").find(before) == std::string_view::npos)
      refuse(i, "'=' assigns; accepted: == to compare");
  }
}

}  // namespace

struct Expression::Parsed {
  explicit Parsed(std::size_t names) : values(names, 1.0) {}
  Parsed(const std::string& text, const std::vector<std::string>& names)
      : parser(bare_parser()), values(names.size(), 1.0) {
    for (std::size_t i = 0; i < names.size(); ++i) parser.DefineVar(names[i], &values[i]);
    parser.SetExpr(text);
    parser.Eval();
  }

  mu::Parser parser;
  std::vector<double> values;
};

struct Expression::Shared {
  std::string text;
  std::vector<std::string> names;
  FormulaFunction function;
  std::vector<bool> used;
  std::mutex mutex;
  std::vector<std::unique_ptr<Parsed>> idle;  // one for each thread that ever evaluated
};

Expression::Expression(const std::string& text, const std::vector<std::string>& names)
    : shared_(std::make_shared<Shared>()) {
  check_characters(text);
  shared_->text = text;
  shared_->names = names;
  try {
    auto parsed = std::make_unique<Parsed>(text, names);
    if (parsed->parser.GetNumResults() != 1)
      refuse(text.find(','), "several results; accepted: one, with a decimal point");
    const auto& variables = parsed->parser.GetUsedVar();
    for (const std::string& name : names) shared_->used.push_back(variables.contains(name));
    shared_->idle.push_back(std::move(parsed));
  } catch (const mu::Parser::exception_type& error) {
    const std::string token(trimmed(error.GetToken()));
    // The parser says where it stood: behind a token that it did not expect, or before it.
    const std::size_t last = std::min<std::size_t>(std::max(error.GetPos(), 0), text.size());
    const std::size_t at = token.empty() ? last : std::min(text.rfind(token, last), last);
    refuse(at, (token.empty() ? "the formula breaks off or is empty"
                              : "'" + token + "' does not fit here") +
                   "; accepted: " + joined(names, " ") + " pi, functions " + functions());
  }
}

Expression::Expression(const Formula& formula, const std::vector<std::string>& names)
    : shared_(std::make_shared<Shared>()) {
  shared_->names = names;
  shared_->function = formula.function;
  const std::size_t first = names.size() - formula.parameters.size();
  for (const std::string& variable : formula.variables)
    if (const auto end = names.begin() + static_cast<std::ptrdiff_t>(first);
        std::find(names.begin(), end, variable) == end)
      throw UsageError("'" + printable(variable) +
                       "' is no variable; accepted: " + joined(std::span(names).first(first), " "));
  for (std::size_t i = 0; i < names.size(); ++i)
    shared_->used.push_back(i >= first || std::ranges::count(formula.variables, names[i]) > 0);
}

bool Expression::uses(std::size_t name) const { return shared_->used[name]; }

Expression::Evaluation::Evaluation(const Expression& expression) : expression_(&expression) {
  Shared& shared = *expression.shared_;
  {
    const std::lock_guard lock(shared.mutex);
    if (!shared.idle.empty()) {
      parsed_ = std::move(shared.idle.back());
      shared.idle.pop_back();
    }
  }
  if (!parsed_)
    parsed_ = shared.function ? std::make_unique<Parsed>(shared.names.size())
                              : std::make_unique<Parsed>(shared.text, shared.names);
}

Expression::Evaluation::~Evaluation() {
  Shared& shared = *expression_->shared_;
  const std::lock_guard lock(shared.mutex);
  shared.idle.push_back(std::move(parsed_));
}

std::span<double> Expression::Evaluation::values() { return parsed_->values; }

double Expression::Evaluation::result() {
  if (!expression_->shared_->function) return parsed_->parser.Eval();
  std::vector<std::vector<double>> variables;
  for (const double value : parsed_->values) variables.push_back({value});
  double out = 0.0;
  results(variables, {&out, 1});
  return out;
}

void Expression::Evaluation::results(std::span<const std::vector<double>> variables,
                                     std::span<double> out) {
  const Shared& shared = *expression_->shared_;
  if (!shared.function) {
    for (std::size_t i = 0; i < out.size(); ++i) {
      for (std::size_t v = 0; v < variables.size(); ++v)
        if (!variables[v].empty()) parsed_->values[v] = variables[v][i];
      out[i] = parsed_->parser.Eval();
    }
    return;
  }
  const std::size_t first = formula_variables().size();
  std::map<std::string, std::vector<double>> arrays;
  std::map<std::string, double> parameters;
  for (std::size_t v = 0; v < shared.names.size(); ++v)
    if (v >= first)
      parameters[shared.names[v]] = parsed_->values[v];
    else if (shared.used[v])
      arrays[shared.names[v]] = variables[v];
  const std::vector<double> values = shared.function(arrays, parameters);
  if (values.size() != out.size())
    throw UsageError("the function gives " + std::to_string(values.size()) + " values for " +
                     std::to_string(out.size()) + "; accepted: as many");
  std::ranges::copy(values, out.begin());
}

bool is_word_of_expressions(const std::string& name) {
  return name == "pi" || bare_parser().GetFunDef().contains(name);
}

}  // namespace slideway
