#pragma once

#include "calibration.hpp"
#include "holdout.hpp"
#include "slideway/trace/trace.hpp"

namespace slideway {

/// One look at what a fitted model leaves over.
struct Look {
  Whitened data;
  std::vector<Refined> refined;      // candidates worth a closer look, best BIC first
  std::vector<double> p_values;      // of each
  std::vector<std::string> refused;  // why not, per refined; empty: acceptable
  std::vector<std::optional<HeldOut>> held_out;

  /// Index of the candidate to accept: the acceptable one of least BIC, if it has no better rival
  /// that can not be accepted itself.
  [[nodiscard]] std::optional<std::size_t> choice() const;

  /// Acceptable candidates within 10 of the BIC of `chosen`, without it.
  [[nodiscard]] std::vector<std::size_t> rivals(std::size_t chosen) const;
};

/// @param calibration  null distribution of the search; made here if it is not there yet
Look look(const Model& model, const Fit& fit, const Candidates& candidates, double significance,
          std::optional<Calibration>& calibration);

}  // namespace slideway
