#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "fuzz/sound.hpp"

/// Problems drawn from bytes: every key, every effect, small data. The same bytes make the same
/// problem on every machine.
namespace slideway {

/// Choices from bytes; when they are used up every choice is the first one.
class Draw {
 public:
  explicit Draw(std::span<const std::uint8_t> bytes) : left_(bytes) {}

  /// 0 to n - 1. REQUIRES n in 1 ... 65536.
  std::size_t below(std::size_t n);
  bool once_in(std::size_t n) { return below(n) == n - 1; }
  double between(double low, double high);

  template <typename T, std::size_t N>
  const T& one_of(const std::array<T, N>& choices) {
    return choices[below(N)];
  }
  template <typename T>
  const T& one_of(const std::vector<T>& choices) {
    return choices[below(choices.size())];
  }

 private:
  std::uint8_t byte();
  std::span<const std::uint8_t> left_;
};

/// Whether a problem is what a person could mean, or has numbers and words nobody means.
enum class Intent { legal, hostile };

struct DrawnProfile {
  std::string name, keys;  // keys: lines of TOML without file, columns, units
  bool is_slope = false;
  double standard_uncertainty = 0.0;                  // as the values; 0: none
  std::vector<double> positions_mm, values, times_s;  // values: um, urad; times: none, or as many
};

struct DrawnLog {
  std::string name, keys;
  std::vector<double> at, values;
};

struct DrawnProblem {
  std::string head, tail;  // of the TOML text, around the profiles
  std::vector<DrawnProfile> profiles;
  std::vector<DrawnLog> logs;
};

DrawnProblem draw_problem(Draw& draw, Intent intent);

/// How a drawn problem is written down.
struct Wording {
  const char* position_unit = "mm";
  double positions_per_mm = 1.0;
  const char *height_unit = "um", *slope_unit = "urad";
  double heights_per_um = 1.0, slopes_per_urad = 1.0;
  double size = 1.0;  // of all values
  bool is_reversed = false;
};

/// A drawn problem as files that lie in memory.
class ProblemFiles {
 public:
  explicit ProblemFiles(const DrawnProblem& problem, const Wording& wording = {});

  [[nodiscard]] std::filesystem::path path() const { return files_.back()->path(); }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string keep(const std::string& bytes);
  std::string text_;
  std::vector<std::unique_ptr<MemoryFile>> files_;
};

}  // namespace slideway
