#pragma once

#include <optional>
#include <string>
#include <vector>

#include "slideway/effects/effect.hpp"

namespace slideway {

/// A quantity that was logged beside the profiles, on the clock of one of their variables.
struct Channel {
  std::string name;
  IndependentVariable clock = IndependentVariable::time;  // or measuring_time, reading_time, slide
  std::string unit = "1";                                 // of the values
  std::vector<double> at;                                 // s (slide: mm), increasing
  std::vector<double> values;                             // as many, finite
};

/// What stands between a logged quantity and the height it makes. A lag or a time constant that is
/// free is a shape parameter.
struct ChannelResponse {
  std::string name;  // of the effect, in the report
  bool free_lag = false;
  double lag_s = 0.0;  // the height follows so much later (slide: mm)
  bool free_tau = false;
  std::optional<double> tau_s;  // first-order lag: τ dy/dt = q - y, in balance at its start
  bool since_start = false;     // q is counted from its value where the cut starts
};

/// Standard deviation of the white noise of a log, from its second differences (median, so that
/// what moves does not count).
double noise_of(const Channel& channel);

/// The effect h = gain · q, on the clock reading_time also of slopes: q, straight between its
/// values, is taken through the response and averaged over the spacing of the stations, which is
/// the filter against aliases.
/// @throws UsageError  fewer than three values, places that do not increase, a number beyond 1e30
EffectFactory channel_effect(Channel channel, const ChannelResponse& response);

}  // namespace slideway
