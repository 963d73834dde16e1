#include "request.hpp"

#include <algorithm>
#include <utility>

#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"

namespace slideway {
namespace {

std::string axis_name(Axis axis) { return std::string(1, "xyz"[static_cast<std::size_t>(axis)]); }

std::string names_of(const Machine& machine, const std::vector<int>& bodies) {
  std::vector<std::string> names;
  for (const int body : bodies) names.push_back(machine.bodies()[body - 1].name);
  return joined(names);
}

}  // namespace

void Request::accept_only(const std::vector<std::string>& accepted) const {
  const std::pair<const char*, bool> given[] = {
      {"body", options.body.has_value()},
      {"degree", options.degree.has_value()},
      {"span_mm", options.span_mm.has_value()},
      {"form", options.form.has_value()},
      {"resolution_mm", options.resolution_mm.has_value()},
      {"harmonics", !options.harmonics.empty()},
      {"each_half", options.each_half}};
  for (const auto& [key, is_set] : given)
    if (is_set && std::find(accepted.begin(), accepted.end(), key) == accepted.end())
      throw UsageError("effect " + name + ": '" + key + "' is not an option of it; accepted: " +
                       (accepted.empty() ? "none" : joined(accepted)));
}

int Request::carriage(Axis axis) const {
  const std::vector<int> carriages = machine.carriages(axis);
  const std::string where = "effect " + name + ": ";
  if (carriages.empty())
    throw UsageError(where + "no body on the branch to the tool moves along " + axis_name(axis));
  if (options.body) {
    const int body = machine.body(*options.body);
    if (std::find(carriages.begin(), carriages.end(), body) == carriages.end())
      throw UsageError(where + "body '" + *options.body + "' does not carry the tool along " +
                       axis_name(axis) + "; accepted: " + names_of(machine, carriages));
    return body;
  }
  if (carriages.size() > 1)
    throw UsageError(where + "'body' is needed, as several bodies move along " + axis_name(axis) +
                     "; accepted: " + names_of(machine, carriages));
  return carriages.front();
}

int Request::degree(int lowest, int highest) const {
  const std::string accepted =
      "; accepted: " + std::to_string(lowest) + " to " + std::to_string(highest);
  if (!options.degree) throw UsageError("effect " + name + ": 'degree' is missing" + accepted);
  if (*options.degree < lowest || *options.degree > highest)
    throw UsageError("effect " + name + ": degree " + std::to_string(*options.degree) +
                     " is out of range" + accepted);
  return *options.degree;
}

}  // namespace slideway
