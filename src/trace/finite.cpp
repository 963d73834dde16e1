#include <charconv>
#include <cmath>
#include <limits>
#include <string>

#include "slideway/trace/analysis_fields.hpp"

namespace slideway {
namespace {

/// Walks through all that a report holds.
class NonFinite {
 public:
  template <Recorded T>
  void leave_out(T& object) {
    std::vector<std::string>* const outer_notes = notes_;
    std::string outer_path;
    for_each_field<T>([&](const auto& field) {
      auto& member = std::invoke(field.access, object);
      if constexpr (std::is_same_v<decltype(member), std::vector<std::string>&>)
        if (field.key == "notes") {
          notes_ = &member;
          outer_path = std::exchange(path_, "");
        }
    });
    const bool has_notes = notes_ != outer_notes;
    for_each_field<T>([&](const auto& field) {
      inside((path_.empty() ? "" : ".") + std::string(field.key),
             [&] { leave_out(std::invoke(field.access, object)); });
    });
    if (has_notes) path_ = std::move(outer_path);
    notes_ = outer_notes;
  }

 private:
  void leave_out(double& number) {
    if (std::isfinite(number)) return;
    number = std::numeric_limits<double>::quiet_NaN();
    say();
  }
  void leave_out(std::optional<double>& number) {
    if (!number || std::isfinite(*number)) return;
    number.reset();
    say();
  }
  void leave_out(std::vector<double>& numbers) {
    bool any = false;
    for (double& number : numbers) {
      if (std::isfinite(number)) continue;
      number = std::numeric_limits<double>::quiet_NaN();
      any = true;
    }
    if (any) say();
  }
  void leave_out(std::vector<std::pair<std::string, double>>& numbers) {
    for (auto& entry : numbers) inside("." + entry.first, [&] { leave_out(entry.second); });
  }
  void leave_out(ParameterCorrelation& pair) { leave_out(std::get<double>(pair)); }
  template <typename T>
  void leave_out(std::optional<T>& value) {
    if (value) leave_out(*value);
  }
  template <typename T>
  void leave_out(std::vector<T>& values) {
    if constexpr (!std::is_arithmetic_v<T> && !std::is_same_v<T, std::string>)
      for (std::size_t i = 0; i < values.size(); ++i)
        inside("[" + std::to_string(i) + "]", [&] { leave_out(values[i]); });
  }
  template <typename T>
  requires(!Recorded<T>) void leave_out(T& /*no number*/) {}

  template <typename Visit>
  void inside(const std::string& place, Visit&& visit) {
    const std::size_t size = path_.size();
    path_ += place;
    visit();
    path_.resize(size);
  }

  void say() { notes_->push_back(path_ + " is not a finite number and is left out"); }

  std::vector<std::string>* notes_ = nullptr;
  std::string path_;
};

/// Rounds every number of the fields that are drawn.
template <Recorded T>
void round_fields(T& object);

void round_all(std::vector<double>& numbers, int digits) {
  for (double& number : numbers) {
    char buffer[32];
    const auto end =
        std::to_chars(buffer, std::end(buffer), number, std::chars_format::general, digits).ptr;
    std::from_chars(buffer, end, number);
  }
}

template <typename T>
void round_all(std::vector<T>& values, int digits) {
  for (T& value : values) {
    if constexpr (Recorded<T>)
      round_fields(value);
    else if constexpr (std::is_same_v<T, std::vector<double>>)
      round_all(value, digits);
  }
}

template <typename T>
void round_all(std::optional<T>& value, int /*digits*/) {
  if constexpr (Recorded<T>)
    if (value) round_fields(*value);
}

template <typename T>
void round_all(T& value, int /*digits*/) {
  if constexpr (Recorded<T>) round_fields(value);
}

template <Recorded T>
void round_fields(T& object) {
  for_each_field<T>([&](const auto& field) {
    auto& member = std::invoke(field.access, object);
    constexpr bool is_numbers = std::is_same_v<decltype(member), std::vector<double>&>;
    if (!is_numbers || field.digits > 0) round_all(member, field.digits);
  });
}

}  // namespace

void round_drawn(Analysis& analysis) { round_fields(analysis); }

void leave_out_non_finite(Analysis& analysis) { NonFinite().leave_out(analysis); }

}  // namespace slideway
