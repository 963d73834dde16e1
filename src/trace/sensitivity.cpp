#include "sensitivity.hpp"

#include <algorithm>
#include <cmath>

#include "outcome.hpp"

namespace slideway {
namespace {

constexpr double kBeyond = 1e-6;  // relative, past the statistic

/// A gate at the statistic that was held against it.
struct Change {
  const Gate* gate = nullptr;
  double value = 0.0, size = 0.0;
};

const Gate& gate_of(double Gates::*member) {
  return *std::ranges::find(gate_table(), member, &Gate::value);
}

class Changes {
 public:
  explicit Changes(const Gates& gates) : gates_(gates) {}

  /// The gate moved past a statistic, if its range allows it.
  void add(double Gates::*member, double statistic) {
    const Gate& gate = gate_of(member);
    const double now = gates_.*member;
    const double value = statistic * (statistic > now ? 1.0 + kBeyond : 1.0 - kBeyond);
    if (!(value > 0.0 && value >= gate.lower && value <= gate.upper && value != now)) return;
    all_.push_back({&gate, value, std::abs(std::log(value / now))});
  }

  /// Statistics of a candidate: every gate it passes, or the only one it does not.
  void add(const TestedCandidate& tested) {
    const bool passes = tested.refused(gates_).empty();
    const auto held = [&](double Gates::*member, double statistic) {
      Gates moved = gates_;
      moved.*member = statistic * (statistic < gates_.*member ? 1.0 - kBeyond : 1.0 + kBeyond);
      if (passes || tested.refused(moved).empty()) add(member, statistic);
    };
    held(&Gates::delta_bic, -tested.refined.delta_bic);
    held(&Gates::significance, tested.p_value);
    held(&Gates::size, tested.refined.size_in_uncertainties);
  }

  /// Nearest first.
  [[nodiscard]] std::vector<Change> sorted() && {
    std::ranges::stable_sort(all_, {}, &Change::size);
    all_.resize(std::min(all_.size(), static_cast<std::size_t>(gates_.tried_changes)));
    return std::move(all_);
  }

 private:
  const Gates& gates_;
  std::vector<Change> all_;
};

TraceVerdict verdict_of(const Selection& selection, const Gates& gates) {
  TraceResult out;
  for (const AcceptedEffect& effect : selection.effects) out.rounds.push_back(effect.round);
  if (selection.withheld || selection.lack_of_fit.significant(gates)) out.unnamed.emplace();
  return verdict(out, false);
}

}  // namespace

std::optional<Fragile> smallest_change(const Problem& problem, SetStatistics& statistics,
                                       const Selection& selection, const Gates& gates) {
  ModelExtender& extender = statistics.extender();
  Changes changes(gates);
  for (const TestedCandidate& tested : extender.search(selection.effects).tested)
    changes.add(tested);
  for (std::size_t i = 0; i < selection.effects.size(); ++i) {
    const SearchRound& round = extender.search(all_but(selection.effects, i));
    const TestedCandidate& own = *find_tested(round, selection.effects[i], gates);
    changes.add(own);
    for (const TestedCandidate& other : round.tested)
      if (other.name() != own.name())
        changes.add(&Gates::tie_bic, other.refined.delta_bic - own.refined.delta_bic);
  }
  changes.add(&Gates::lack_of_fit_p, selection.lack_of_fit.p_value);
  changes.add(&Gates::lack_of_fit_ratio, selection.lack_of_fit.ratio);
  const TraceVerdict now = verdict_of(selection, gates);
  for (const Change& change : std::move(changes).sorted()) {
    extender.limit().check();
    Gates moved = gates;
    moved.*change.gate->value = change.value;
    const TraceVerdict there = verdict_of(select_effects(problem, statistics, moved, {}), moved);
    if (there != now) return Fragile{std::string(change.gate->name), change.value, there};
  }
  return std::nullopt;
}

}  // namespace slideway
