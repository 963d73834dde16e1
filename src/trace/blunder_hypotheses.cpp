#include "blunder_hypotheses.hpp"

#include <algorithm>
#include <cmath>

#include "rescaled.hpp"

namespace slideway {
namespace {

constexpr std::array<std::pair<BlunderKind, double>, 4> kPositionFactors{
    {{BlunderKind::position_inch, 25.4},
     {BlunderKind::position_per_inch, 1 / 25.4},
     {BlunderKind::position_metre, 1000.0},
     {BlunderKind::position_per_metre, 1e-3}}};
// Of the time of the cut: a start that was forgotten, or is one of another cut.
constexpr std::array<double, 12> kShifts{-2.0,   -1.0,  -0.5, -0.25, -0.125, -0.0625,
                                         0.0625, 0.125, 0.25, 0.5,   1.0,    2.0};

/// Another unit of the positions that makes a trace about as long as one of the others, where it is
/// as long as none.
std::optional<BlunderHypothesis> other_position_unit(const Profile& profile,
                                                     const std::vector<double>& other_lengths) {
  const auto is_as_long = [&](double factor) {
    return std::ranges::any_of(other_lengths, [&](double length) {
      return std::abs(std::log(length / (factor * length_of(profile)))) < 0.5 * std::log(25.4);
    });
  };
  if (is_as_long(1.0)) return std::nullopt;
  for (const auto& [kind, factor] : kPositionFactors)
    if (is_as_long(factor)) return BlunderHypothesis{kind, 1.0, rescaled(profile, factor)};
  return std::nullopt;
}

}  // namespace

bool is_possible(BlunderKind kind, const Setup& setup) {
  return setup.quantity == Quantity::slope ||
         (kind != BlunderKind::arcsecond && kind != BlunderKind::per_arcsecond);
}

std::vector<BlunderHypothesis> hypotheses(const Profile& profile,
                                          const std::vector<double>& other_lengths,
                                          bool is_reversal) {
  const Setup& setup = profile.setup;
  std::vector<BlunderHypothesis> out;
  for (const auto& [kind, factor] : kFactors)
    if (is_possible(kind, setup) && (kind != BlunderKind::sign || !is_reversal))
      out.push_back({kind, factor, {}});
  if (auto other = other_position_unit(profile, other_lengths)) out.push_back(*std::move(other));
  if (!setup.cut_direction || !setup.feed_mm_per_min) return out;
  Profile other = profile;
  other.setup.cut_direction =
      *setup.cut_direction == CutDirection::inward ? CutDirection::outward : CutDirection::inward;
  out.push_back({BlunderKind::cut_direction, 1.0, other});
  other.setup.cut_direction = setup.cut_direction;
  const double length = setup.cut_radius_mm.value_or(length_of(profile));
  const double duration = kMinute * length / *setup.feed_mm_per_min;
  for (const double share : kShifts) {
    other.setup.start_s = setup.start_s + share * duration;
    out.push_back({BlunderKind::clock, 1.0, other});
  }
  return out;
}

}  // namespace slideway
