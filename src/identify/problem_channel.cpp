#include "problem_channel.hpp"

#include <algorithm>
#include <cmath>

#include "problem_own.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"
#include "slideway/effects/formula.hpp"

namespace slideway {
namespace {

constexpr std::size_t kMostValues = 20000;  // of a log; more are kept as means

/// The unit that the file states, where it does and the problem asks for no other.
std::optional<std::string> unit_of(const Section& section, const std::string& key,
                                   const std::string& in_file,
                                   const std::optional<std::string>& asked) {
  if (in_file.empty()) return asked;
  if (asked && *asked != in_file)
    section.fail(key,
                 "the file has " + in_file + ", the problem " + *asked + "; accepted: the same");
  return in_file;
}

/// What a place in the file is in s, or in mm.
double scale_of_places(const Section& section, const Channel& channel, const TraceFile& file) {
  const bool is_slide = channel.clock == IndependentVariable::slide;
  const std::string accepted(is_slide ? kLengthUnits : kTimeUnits);
  const std::optional<std::string> asked = section.unit("time_unit", accepted, "");
  const std::string unit = section.required(
      "time_unit", unit_of(section, "time_unit", file.trace.position_unit, asked), accepted);
  if (const auto scale = is_slide ? length_unit(unit) : time_unit(unit)) return (*scale)(1.0);
  section.fail("time_unit", "the file has " + unit + "; accepted: " + accepted);
}

/// Missing values left out, those of one time and those there are too many of as means.
void take(const TraceFile& file, double scale, Channel& channel) {
  const Trace& trace = file.trace;
  std::vector<std::pair<double, double>> points;
  for (std::size_t i = 0; i < trace.positions.size(); ++i)
    if (std::isfinite(trace.positions[i]) && std::isfinite(trace.values[i]))
      points.emplace_back(trace.positions[i] * scale, trace.values[i]);
  std::ranges::stable_sort(points, {}, &std::pair<double, double>::first);
  const std::size_t most = points.size() / kMostValues + 1;
  for (std::size_t i = 0; i < points.size();) {
    double at = 0.0, value = 0.0, count = 0.0;
    const std::size_t first = i;
    const auto belongs = [&] {
      return i < points.size() && (i < first + most || points[i].first == points[i - 1].first);
    };
    for (; belongs(); ++i, ++count) {
      at += points[i].first;
      value += points[i].second;
    }
    channel.at.push_back(at / count);
    channel.values.push_back(value / count);
  }
}

std::string name_of_channel(const Section& section) {
  std::string name = section.required("name", section.text("name"), "a name of its own");
  if (!is_identifier(name))
    section.fail("name", "'" + name + "' is no name; accepted: a letter, then letters, digits, _");
  return name;
}

/// In the place of a log that was refused, so that what names it is read.
Channel stand_in(const Section& section) {
  Channel channel;
  channel.name = name_of_channel(section);
  channel.at = channel.values = {0.0, 1.0, 2.0};
  return channel;
}

TraceFile read_log(const std::string& name, const std::filesystem::path& path,
                   const TraceRequest& request) {
  try {
    return read_trace(path, request);
  } catch (const DataError& error) {
    throw DataError("channel '" + name + "': " + error.what());
  }
}

Channel read_channel(const Section& section, const ProblemRules& rules, Problem& problem) {
  section.accept("name file time_column time_unit value_column value_unit clock");
  Channel channel;
  channel.name = name_of_channel(section);
  const std::string clock = section.one_of("clock", "t m t_read x").value_or("t");
  for (const IndependentVariable each :
       {IndependentVariable::slide, IndependentVariable::measuring_time,
        IndependentVariable::reading_time})
    if (clock == symbol(each)) channel.clock = each;
  TraceRequest request;
  request.position_column = section.column("time_column").value_or(request.position_column);
  request.value_column = section.column("value_column").value_or(request.value_column);
  request.positions_are_times = channel.clock != IndependentVariable::slide;
  const std::filesystem::path path =
      resolved(section, "file", section.required("file", section.text("file"), "a path"), rules);
  problem.beside.push_back(path);
  const TraceFile file = read_log(channel.name, path, request);
  const std::optional<std::string> asked = section.text("value_unit");
  channel.unit =
      (file.states_units ? unit_of(section, "value_unit", file.trace.value_unit, asked) : asked)
          .value_or("unit of the log");
  take(file, scale_of_places(section, channel, file), channel);
  if (const std::vector<std::size_t> outliers = outliers_of(channel); !outliers.empty())
    problem.remarks.push_back("channel '" + channel.name + "': " + std::to_string(outliers.size()) +
                              " of " + std::to_string(channel.values.size()) +
                              " values do not belong to it and are left out (" +
                              significant(channel.values[outliers.front()], 4) + " " +
                              channel.unit + " at " + significant(channel.at[outliers.front()], 4) +
                              (channel.clock == IndependentVariable::slide ? " mm)" : " s)"));
  return channel;
}

/// What the loop asks of every log: what follows it later and slowly, one of these, or neither.
DeclaredEffect follower_of(const Section& section, const Channel& channel, const Problem& problem) {
  check_name_is_free(section, "name", channel.name, problem.own_effects);
  try {
    std::vector<ChannelResponse> responses;
    for (const bool free_tau : {true, false})
      for (const bool free_lag : {true, false})
        responses.push_back({.name = channel.name, .free_lag = free_lag, .free_tau = free_tau});
    std::vector<EffectFactory> made = channel_effects(channel, responses);
    EffectOptions options{.own = std::move(made.front())};
    made.erase(made.begin());
    options.simpler = std::move(made);
    return {channel.name, std::move(options), {}};
  } catch (const UsageError& error) {
    section.fail("file", error.what());
  }
}

}  // namespace

std::vector<Channel> read_channels(const Section& root, const ProblemRules& rules,
                                   Problem& problem) {
  std::vector<Channel> out;
  for (const Section& section : root.tables("channel")) {
    const auto take_in = [&](Channel channel) {
      problem.own_effects.push_back(follower_of(section, channel, problem));
      out.push_back(std::move(channel));
    };
    if (!section.attempt([&] { take_in(read_channel(section, rules, problem)); }))
      section.attempt([&] { take_in(stand_in(section)); });
  }
  return out;
}

}  // namespace slideway
