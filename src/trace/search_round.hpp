#pragma once

#include "calibration.hpp"
#include "holdout.hpp"
#include "slideway/identify/gates.hpp"
#include "slideway/trace/trace.hpp"

namespace slideway {

/// A candidate at its best shape, with the statistics the gates are held against.
struct TestedCandidate {
  Refined refined;
  double p_value = 1.0;
  std::optional<HeldOut> held_out;
  Eigen::VectorXd fitted;  // what it takes of the white residual
  std::string part_of;     // part_of_a_line()
  /// Why its line may be another one, folded to where its own is; empty: it is none.
  std::string folded;
  bool of_feed_marks = false;  // is_of_feed_marks(): that is the other one
  bool is_wave = false;        // is_wave()
  double noise_beside = 1.0;   // of a wave: noise_beside_line()

  [[nodiscard]] const std::string& name() const { return refined.candidate->name(); }
  [[nodiscard]] Priority priority() const {
    return priority_of(*refined.candidate, refined.delta_bic);
  }
  /// Difference in BIC under the noise beside its line.
  [[nodiscard]] double delta_bic_beside() const;
  /// Why it is not accepted; empty: it passes.
  [[nodiscard]] std::string refused(const Gates& gates) const;
  /// Why it does not explain the data, whatever they take for it to be said; empty: it does.
  [[nodiscard]] std::string fails(const Gates& gates) const;
  /// Physically possible, and not of the model's own span.
  [[nodiscard]] bool is_possible() const;
};

/// Whether `part` is an error of the instrument, or a measured cause, that `whole` has in more
/// readings.
[[nodiscard]] bool is_in_fewer_readings(const TestedCandidate& part, const TestedCandidate& whole);

/// A search of what one model leaves over.
struct SearchRound {
  Whitened data;
  std::vector<TestedCandidate> tested;  // best BIC first

  /// The candidate to accept, none of `excluded`: the one of least BIC that passes, if no better
  /// one that does not pass takes the same part of the residual. Null: none.
  [[nodiscard]] const TestedCandidate* choice(const Gates& gates,
                                              const std::vector<std::string>& excluded = {}) const;

  /// What explains that for which `choice` would be accepted, within tie_bic of it, and has a
  /// reason of its own: a measured cause, which `choice` is not; that, or an error of the
  /// instrument, in all readings, not in some alone. Null: none.
  [[nodiscard]] const TestedCandidate* better_known_than(
      const TestedCandidate& choice, const Gates& gates,
      const std::vector<std::string>& excluded = {}) const;

  /// Other effects, and the same one in other cuts, that take the same part of the residual, within
  /// tie_bic of `chosen`: those that pass, those that take more cuts to be told, and those too
  /// uncertain to pass that need no more unknowns. Where the chosen one is a carriage's polynomial,
  /// which comes near every smooth effect, all that are possible. Not those that outranked() has.
  [[nodiscard]] std::vector<const TestedCandidate*> rivals(const TestedCandidate& chosen,
                                                           const Gates& gates) const;

  /// The same effect in more readings, where its law is only nearly what it is taken as: what is
  /// larger in some readings may still be in all.
  [[nodiscard]] std::vector<const TestedCandidate*> in_more_readings(
      const TestedCandidate& chosen) const;

  /// What would be rivals of `chosen`, were it no measured cause, or no error of the instrument.
  [[nodiscard]] std::vector<const TestedCandidate*> outranked(const TestedCandidate& chosen,
                                                              const Gates& gates) const;

 private:
  /// Of the same effect with fewer shapes, within tie_bic of `choice`: the one with the fewest.
  [[nodiscard]] const TestedCandidate* simplest_law(const TestedCandidate& choice,
                                                    const Gates& gates) const;

  /// The least difference in BIC of an effect and, where it is one of the place of each trace, of
  /// the same effect of all: each has its own, though one for all may explain more than any.
  [[nodiscard]] double least_of_effect(const TestedCandidate& part) const;

  [[nodiscard]] std::vector<const TestedCandidate*> as_good_as(const TestedCandidate& chosen,
                                                               const Gates& gates) const;
};

/// @param calibration  null distribution of the search; made here if it is not there yet, and again
///                     where the noise is better known than it was for that
/// @param progress     is given the part of that which is done
SearchRound search_round(const Model& model, const Solution& fit, const Candidates& candidates,
                         std::optional<Calibration>& calibration,
                         const std::function<void(double)>& progress = {});

}  // namespace slideway
