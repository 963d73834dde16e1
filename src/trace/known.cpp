#include "known.hpp"

#include <utility>

namespace slideway {

Known known_before_search(const Problem& problem, const FittedModel& declared) {
  Known out{.shown = shown_by_samples(problem, declared)};
  if (!out.shown.empty()) {
    ShownModel with = with_shown(declared, out.shown);
    out.fitted.emplace(std::move(with.fitted));
    out.rounds = std::move(with.rounds);
  }
  if (std::optional<WithinRims> rims = within_rims(out.fitted ? *out.fitted : declared)) {
    out.fitted.emplace(std::move(rims->fitted));
    out.note = std::move(rims->note);
  }
  return out;
}

}  // namespace slideway
