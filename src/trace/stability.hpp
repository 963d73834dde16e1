#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "search_round.hpp"

namespace slideway {

inline constexpr std::string_view kNothing = "nothing";  // no candidate pays

/// How often resamples of the data choose the same effect among the candidates of one search.
struct Stability {
  double share = 1.0;  // of the resamples
  std::string other;   // what the rest choose most often; or kNothing; "": none do
};

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

/// Resamples: each profile left out, alternate blocks of a sixteenth and an eighth of each profile
/// left out, either half, noise drawn anew on what the effect makes, and where the fit is given,
/// the low bands one level up and one level down (other_level.hpp). A profile counts as left out
/// only if it is not the only one that shows the effect. Each resample chooses the candidate of
/// least BIC at the shapes all data gave, and this effect if none is better by Gates::tie_bic;
/// gains of parts are scaled to the number of all rows.
///
/// @param fitted  the model that was searched; null: no other levels
Stability stability(const SearchRound& round, const TestedCandidate& effect, const Gates& gates,
                    const FittedModel* fitted = nullptr);

}  // namespace slideway
