#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "fields.hpp"
#include "slideway/base/error.hpp"

namespace slideway {

// Times of a clock, one part of a column after the other, from the midnight before the first on.
// DataError: they are not of one form.
class Midnight {
 public:
  static constexpr std::string_view kOneForm =
      "clock times of two forms in one column; accepted: all with a date or none, and one time "
      "zone";

  void count_on(std::span<double> times, std::size_t of_clock, const ClockForm& form) {
    if (form_ && *form_ != form) throw DataError("has " + std::string(kOneForm));
    form_ = form;
    for (double& time : times) {
      if (std::isnan(time)) continue;
      if (of_clock-- == 0) throw DataError("has clock times and numbers in one column of times");
      if (!first_) first_ = kDay * std::floor(time / kDay);
      time -= *first_;
      if (*first_ == 0.0) time += kDay * std::max(0.0, std::round((last_ - time) / kDay));
      last_ = time;
    }
  }

 private:
  static constexpr double kDay = 86400.0;  // s
  std::optional<ClockForm> form_;
  std::optional<double> first_;  // midnight; 0 without a date
  double last_ = 0.0;
};

}  // namespace slideway
