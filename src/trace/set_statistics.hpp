#pragma once

#include <map>
#include <tuple>
#include <vector>

#include "naming.hpp"

namespace slideway {

/// How a set of effects stands against what has no name.
struct Standing {
  double margin = INFINITY;  // beyond what the gates ask for, nats
  std::string rival;         // the nearest: "a process in t"; "": none
  std::vector<std::size_t> in_place_of;
};

/// Statistics of sets of effects that no gate changes, each computed once however often the
/// effects are selected.
class SetStatistics {
 public:
  using Effects = std::vector<AcceptedEffect>;

  explicit SetStatistics(ModelExtender& extender) : extender_(extender) {}

  [[nodiscard]] ModelExtender& extender() const { return extender_; }

  /// -ΔBIC of an effect beside the others of the set.
  double gain_beside(const Effects& effects, std::size_t which);

  /// gain_over_process()
  double over_process(const Effects& effects, std::size_t which);

  /// What the unknowns of a set cost in BIC.
  double price(const Effects& effects);

  /// By how much the BIC of a set is lower than that of another one, under the noise beside it.
  double lead(const Effects& effects, const Effects& other);

  /// The nearest of unnamed_rivals(). REQUIRES a set that is not empty.
  Standing standing(const Effects& effects, const Gates& gates);

 private:
  using Key = std::vector<const Candidate*>;

  using One = std::tuple<Key, std::size_t, std::vector<double>>;  // its shape where that matters

  ModelExtender& extender_;
  std::map<Key, std::vector<UnnamedRival>> rivals_;
  std::map<One, double> gains_, over_process_;
  std::map<std::pair<Key, Key>, double> leads_;
};

}  // namespace slideway
