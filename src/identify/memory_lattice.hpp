#pragma once

#include <Eigen/Core>
#include <map>
#include <tuple>
#include <vector>

#include "restricted_likelihood.hpp"

namespace slideway {

/// A place on the lattice of memories; a size of 0 leaves that part out, and its other index is 0.
struct MemoryPlace {
  int texture = 0, length = 0;  // size and length of a noise with one exponential
  int memory = 0, slope = 0;    // size and exponent of a long memory

  bool operator==(const MemoryPlace&) const = default;
  bool operator<(const MemoryPlace& other) const {
    return std::tie(texture, length, memory, slope) <
           std::tie(other.texture, other.length, other.memory, other.slope);
  }
};

/// I + g T + h K of a trace of n values there; the memory reaches from two values to `traces`
/// traces.
ExponentialMixture memory_at(const MemoryPlace& place, double n, double traces);

/// The memory that the profiles of a pool have in common, by restricted likelihood.
class PoolMemory {
 public:
  /// @param rest  r + 1 by r + 1: information of other pools and of priors
  PoolMemory(std::vector<const ProfileLikelihood*> profiles, const Eigen::MatrixXd& rest,
             const Gates& gates);

  /// A memory the data allow.
  struct Allowed {
    double probability = 0.0;
    ExponentialMixture covariance;  // I + g T + h K
    FittedSizes sizes;
  };
  [[nodiscard]] const std::vector<Allowed>& allowed() const { return allowed_; }

  /// The most probable one.
  [[nodiscard]] const Allowed& best() const;

 private:
  /// What a search without passes over long profiles has found, and what is near it, in full.
  void judge_in_full();
  [[nodiscard]] FittedSizes evaluate(const MemoryPlace& place, const Eigen::VectorXd& from) const;
  void visit(const std::vector<MemoryPlace>& places, const Eigen::VectorXd& from);
  [[nodiscard]] bool fits(const MemoryPlace& place) const;
  [[nodiscard]] MemoryPlace most_probable() const;
  [[nodiscard]] bool is_resolved() const;
  void explore(int step);
  void refine();
  void search();

  std::vector<const ProfileLikelihood*> profiles_;
  const Eigen::MatrixXd& rest_;
  const Gates& gates_;
  double values_ = 0.0;   // of the longest trace
  bool is_near_ = false;  // costs are those of ProfileLikelihood::nearly_under()
  int step_ = 1;          // of the lattice, at last
  std::map<MemoryPlace, FittedSizes> visited_;
  std::vector<Allowed> allowed_;
};

}  // namespace slideway
