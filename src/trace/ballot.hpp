#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

namespace slideway {

inline constexpr std::string_view kNothing = "nothing";  // no candidate pays

/// A choice among candidates: that of least BIC, one of them if none is better by more than a tie.
class Ballot {
 public:
  explicit Ballot(std::string own_name) : own_name_(std::move(own_name)) {}

  void add(const std::string& name, double bic) {
    if (bic < least_) least_ = bic, best_ = name;
    if (name == own_name_) of_own_ = std::min(of_own_, bic);
  }
  /// kNothing: none pays.
  [[nodiscard]] std::string chosen(double tie) const {
    return of_own_ < 0.0 && of_own_ <= least_ + tie ? own_name_ : best_;
  }

 private:
  std::string own_name_, best_{kNothing};
  double least_ = 0.0, of_own_ = 0.0;
};

}  // namespace slideway
