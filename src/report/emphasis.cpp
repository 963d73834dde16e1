#include "slideway/report/emphasis.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

namespace slideway {
namespace {

constexpr std::string_view kBold = "\033[1m", kNotBold = "\033[22m", kNoColour = "\033[39m";
constexpr std::string_view kGreen = "\033[32m", kYellow = "\033[33m", kRed = "\033[31m";

constexpr std::pair<std::string_view, std::string_view> kVerdicts[] = {
    {"Nothing missing:", kGreen}, {"Explained:", kGreen},   {"Ambiguous:", kYellow},
    {"Not identifiable:", kRed},  {"Not converged:", kRed}, {"Unnamed:", kRed},
    {"Inconsistent:", kRed},      {"INCONSISTENT", kRed},   {"DOES NOT FIT", kRed},
    {"NOT CONVERGED", kRed},
};

std::string coloured(std::string_view line) {
  for (const auto& [verdict, colour] : kVerdicts) {
    const std::size_t at = line.find(verdict);
    if (at == std::string_view::npos) continue;
    std::string out(line.substr(0, at));
    return out.append(colour).append(verdict).append(kNoColour) +
           coloured(line.substr(at + verdict.size()));
  }
  return std::string(line);
}

}  // namespace

std::string with_emphasis(const std::string& text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = std::string_view(text).substr(at, end - at);
    const bool is_heading = !line.empty() && line.front() != ' ' && !line.starts_with("│");
    if (is_heading) out += kBold;
    out += coloured(line);
    if (is_heading) out += kNotBold;
    if (end < text.size()) out += '\n';
    at = end + 1;
  }
  return out;
}

}  // namespace slideway
