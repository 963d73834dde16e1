#pragma once

#include <string>
#include <utility>
#include <vector>

#include "drawn_problem.hpp"

/// What the parts of drawn_problem.hpp have in common.
namespace slideway {

using Words = std::vector<std::string>;

/// A value that no key means.
const std::string& hostile_value(Draw& draw);

/// Lines of TOML, each value now and then a hostile one.
class Lines {
 public:
  Lines(Draw& draw, Intent intent) : draw_(draw), hostile_(intent == Intent::hostile) {}

  void put(const std::string& key, const std::string& value) {
    text_ += key + " = " + (hostile_ && draw_.once_in(60) ? hostile_value(draw_) : value) + "\n";
  }
  void number(const std::string& key, double low, double high) {
    put(key, shortest(draw_.between(low, high)));
  }
  void word(const std::string& key, const Words& words) {
    put(key, '"' + draw_.one_of(words) + '"');
  }
  void head(const std::string& table) { text_ += table + "\n"; }

  /// Whether a key that may be missing is there.
  bool maybe(std::size_t n = 4) { return draw_.once_in(n); }

  [[nodiscard]] std::string take() { return std::move(text_); }

 private:
  Draw& draw_;
  bool hostile_;
  std::string text_;
};

/// What the parts of one problem must know of one another.
struct Outline {
  bool is_split = false, has_times = false;
  std::size_t profiles = 1;
};

DrawnProfile drawn_profile(Draw& draw, Intent intent, const Outline& outline, std::size_t index);
DrawnLog drawn_log(Draw& draw, Intent intent);

}  // namespace slideway
