#pragma once

#include "calibration.hpp"
#include "holdout.hpp"
#include "slideway/trace/trace.hpp"

namespace slideway {

/// A candidate that was worth a closer look.
struct Seen {
  Refined refined;
  double p_value = 1.0;
  std::optional<HeldOut> held_out;
  std::string refused;     // why; empty: acceptable
  Eigen::VectorXd fitted;  // what it takes of the white residual

  [[nodiscard]] const std::string& name() const { return refined.candidate->name(); }
};

/// Physically possible, and not of the model's own span.
bool is_possible(const Seen& each);

/// One look at what a fitted model leaves over.
struct Look {
  Whitened data;
  std::vector<Seen> seen;  // best BIC first

  /// The candidate to accept, none of `taken`: the acceptable one of least BIC, if no better one
  /// that cannot be accepted itself takes the same of the residual. Null: none.
  [[nodiscard]] const Seen* choice(const std::vector<std::string>& taken = {}) const;

  /// Other effects that take the same of the residual, within 10 of the BIC of `chosen`: the
  /// acceptable ones, and those too uncertain to be accepted that need no more unknowns. Where the
  /// chosen one is a carriage's polynomial, which comes near every smooth effect, all that are
  /// possible.
  [[nodiscard]] std::vector<const Seen*> rivals(const Seen& chosen) const;
};

/// @param calibration  null distribution of the search; made here if it is not there yet
/// @param told         which part of that is done
Look look(const Model& model, const Solution& fit, const Candidates& candidates,
          double significance, std::optional<Calibration>& calibration,
          const std::function<void(double)>& told = {});

}  // namespace slideway
