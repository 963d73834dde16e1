#include "known.hpp"

#include <utility>

#include "off_axis.hpp"
#include "rims.hpp"

namespace slideway {

Known known_before_search(std::vector<ShownEffect> shown, const FittedModel& declared) {
  Known out{.shown = std::move(shown)};
  if (!out.shown.empty()) {
    ShownModel with = with_shown(declared, out.shown);
    out.fitted.emplace(std::move(with.fitted));
    out.rounds = std::move(with.rounds);
  }
  const FittedModel& fitted = out.fitted ? *out.fitted : declared;
  Model model = fitted.model;
  for (std::string note : {leave_out_past_rims(fitted, model), leave_out_off_axis(fitted, model)})
    if (!note.empty()) out.notes.push_back(std::move(note));
  if (!out.notes.empty()) out.fitted.emplace(fit_model(std::move(model)));
  return out;
}

}  // namespace slideway
