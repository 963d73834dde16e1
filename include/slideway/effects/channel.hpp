#pragma once

#include <optional>
#include <string>
#include <string_view>
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

/// How what such an effect lacks (Effect::lacking) begins.
inline constexpr std::string_view kLogLacks = "the log ";

/// Values of a log that do not belong to it: single ones far from both neighbours, and those of one
/// number, such as 0 where a sensor was not read, that lies further away from all others than these
/// from one another. In order.
std::vector<std::size_t> outliers_of(const Channel& log);

/// The effect h = gain · q, on the clock reading_time also of slopes: q, the log without its
/// outliers and noise, is taken through the response and averaged over the spacing of the stations,
/// which is the filter against aliases.
/// @throws UsageError  fewer than three values, places that do not increase, a number beyond 1e30
EffectFactory channel_effect(Channel channel, const ChannelResponse& response);

/// The same of several responses to one log, as many factories.
std::vector<EffectFactory> channel_effects(Channel channel,
                                           const std::vector<ChannelResponse>& responses);

}  // namespace slideway
