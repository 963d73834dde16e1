#include "closure_summary.hpp"

#include <algorithm>
#include <cmath>

#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"
#include "slideway/profile/closure.hpp"

namespace slideway {
namespace {

std::string in_brackets(const std::array<double, 2>& place) {
  std::string text = "[";
  return text.append(significant(place[0], 5)).append(", ").append(significant(place[1], 5)) +
         "] mm";
}

std::string ratio(const Misclosure& reading) {
  return significant(std::abs(*reading.size) / *reading.standard_uncertainty, 2);
}

std::string micrometres(double mm) { return significant(mm / kMicrometre, 3) + " µm"; }

std::string suspicion(const std::vector<std::string>& suspects) {
  if (suspects.empty()) return "no line alone is to blame: without any one the rest does not close";
  if (suspects.size() == 1) return "without '" + suspects[0] + "' the rest closes";
  return "the rest closes without any one of " + joined(suspects) +
         ": the lines cannot tell which is to blame";
}

// The closure furthest from 0 in its uncertainties; REQUIRES a limit.
const Misclosure& largest(const Closure& closure) {
  if (closure.worst) return closure.readings[*closure.worst];
  const auto size = [](const Misclosure& each) {
    return each.size ? std::abs(*each.size) / *each.standard_uncertainty : 0.0;
  };
  return *std::ranges::max_element(closure.readings, {}, size);
}

std::string in_words(const Closure& closure, const std::vector<Profile>& profiles,
                     const std::vector<std::string>& suspects) {
  std::string text =
      std::to_string(closure.lines) + " lines meet at " + counted(closure.places, "place");
  if (closure.places == 0) return text + ": nothing to close";
  if (closure.redundancy == 0) return text + ", and no loop closes: offsets and tilts take it all";
  if (!closure.limit) return text + ": too few stations to tell chance from error";
  const Misclosure& reading = largest(closure);
  const std::string who = "'" + profiles[reading.profile].name + "'";
  if (!closure.worst)
    return text + " and close; the largest misclosure is " + micrometres(*reading.size) + " of " +
           who + " at " + in_brackets(reading.place) + ", " + ratio(reading) +
           " standard uncertainties";
  return text + " and do not close: " + who + " lies " + micrometres(std::abs(*reading.size)) +
         (*reading.size < 0.0 ? " below" : " above") + " what the others say at " +
         in_brackets(reading.place) + ", " + ratio(reading) + " standard uncertainties, where " +
         significant(*closure.limit, 2) + " come by chance in 1 of 1000 sets of lines; " +
         suspicion(suspects);
}

RepeatSummary summarise(const Repeat& repeat, const std::vector<Profile>& profiles) {
  return {profiles[repeat.a].name,
          profiles[repeat.b].name,
          repeat.stations,
          repeat.place[0],
          repeat.place[1],
          repeat.difference / kMicrometre,
          repeat.standard_uncertainty / kMicrometre,
          repeat.limit,
          repeat.is_beyond() ? RepeatVerdict::do_not_agree : RepeatVerdict::agree};
}

std::string in_words(const Repeat& repeat, const RepeatSummary& summary) {
  const std::string what = "'" + summary.a + "' and '" + summary.b + "', of one line, ";
  if (!repeat.is_beyond())
    return what + "agree at all of " + std::to_string(repeat.stations) + " stations";
  return what + "differ by " + micrometres(std::abs(repeat.difference)) + " at " +
         in_brackets(repeat.place) + " from what their other stations say, " +
         significant(std::abs(repeat.difference) / repeat.standard_uncertainty, 2) +
         " standard uncertainties, where " + significant(repeat.limit, 2) +
         " come by chance in 1 of 1000 lines: one of the two is wrong there";
}

}  // namespace

std::optional<ClosureSummary> summarise_closure(const std::vector<Profile>& profiles) {
  const std::optional<Closure> closure = close_lines(profiles);
  if (!closure) return std::nullopt;
  const auto in_um = [](const std::optional<double>& mm) {
    return mm ? std::optional(*mm / kMicrometre) : std::nullopt;
  };
  ClosureSummary out;
  out.lines = closure->lines;
  out.places = closure->places;
  out.redundancy = closure->redundancy;
  out.verdict = closure->worst   ? ClosureVerdict::does_not_close
                : closure->limit ? ClosureVerdict::closes
                                 : ClosureVerdict::not_judged;
  out.false_alarm = kClosureFalseAlarm;
  out.limit = closure->limit;
  out.tied = closure->tied;
  for (const Misclosure& each : closure->readings)
    out.readings.push_back({profiles[each.profile].name, each.place[0], each.place[1],
                            in_um(each.difference), in_um(each.size),
                            in_um(each.standard_uncertainty)});
  for (const std::size_t profile : closure->suspects)
    out.suspects.push_back(profiles[profile].name);
  out.notes.push_back(in_words(*closure, profiles, out.suspects));
  if (closure->tied)
    out.notes.emplace_back(
        "where lines meet their heights are the same to the last digit, as a reduction makes them: "
        "closed is what the stations beside say");
  for (const Repeat& repeat : closure->repeats) {
    out.repeats.push_back(summarise(repeat, profiles));
    out.notes.push_back(in_words(repeat, out.repeats.back()));
  }
  out.notes.insert(out.notes.end(), closure->notes.begin(), closure->notes.end());
  return out;
}

}  // namespace slideway
