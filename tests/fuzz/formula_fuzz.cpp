#include "slideway/effects/contract.hpp"
#include "slideway/effects/formula.hpp"
#include "torture/drawn_problem.hpp"

namespace slideway {
namespace {

constexpr std::array<const char*, 48> kParts{
    "a",     "b",    "c",     "t0",     "tau",  "x",    "r",    "X",    "R",    "z",
    "theta", "t",    "m",     "t_read", "k",    "s",    "feed", "rpm",  "pi",   " + ",
    " - ",   " * ",  " / ",   " ^ ",    "(",    ")",    ", ",   " ? ",  " : ",  " > ",
    " < ",   "==",   "1",     "2",      "0",    "0.5",  "1e9",  "1e-9", "exp(", "log(",
    "sqrt(", "sin(", "tanh(", "max(",   "min(", "abs(", "-",    "a * "};

std::string drawn_formula(Draw& draw) {
  std::string text = "a * ";
  for (std::size_t left = 1 + draw.below(14); left > 0; --left) text += draw.one_of(kParts);
  for (auto open = std::ranges::count(text, '('); open > std::ranges::count(text, ')'); --open)
    text += draw.one_of(std::array{"x)", "t)", "2)", ")"});
  return text;
}

std::vector<FormulaParameter> drawn_parameters(Draw& draw) {
  std::vector<FormulaParameter> out{
      {"a", draw.one_of(std::array{"um", "urad", "um/mm", "", "s"}), {}, {}}};
  for (const char* name : {"b", "c", "t0", "tau"}) {
    if (draw.once_in(2)) continue;
    FormulaParameter parameter{name, draw.one_of(std::array{"s", "um", "mm", "1"}), {}, {}};
    if (!draw.once_in(4)) parameter.lower = draw.one_of(std::array{0.0, 1.0, -10.0, 1e-9, 1e9});
    if (!draw.once_in(4)) parameter.upper = draw.one_of(std::array{1.0, 600.0, -1.0, 1e18, 0.0});
    out.push_back(parameter);
  }
  return out;
}

}  // namespace
}  // namespace slideway

// A formula, as the bytes have it (first byte 'f') or made of its parts: what is accepted keeps the
// contract of an effect, or is refused where it is used.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace slideway;
  Draw draw({data, size});
  const bool is_text = size > 0 && data[0] == 'f';
  std::string text = is_text ? std::string(text_of(data + 1, size - 1)) : drawn_formula(draw);
  const Formula formula{.name = "own",
                        .text = std::move(text),
                        .parameters = is_text ? std::vector<FormulaParameter>{{"a", "um", {}, {}}}
                                              : drawn_parameters(draw)};
  ends_well([&] {
    const auto effect = formula_effect(formula)(Machine(Machine::paper_lathe(), Lever::paper), {});
    require(effect->amplitudes() > 0, "a formula without a size");
    for (const std::string& fault : contract_faults(*effect))
      require(!fault.empty(), "a fault without words");
  });
  return 0;
}
