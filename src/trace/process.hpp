#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "slideway/identify/model.hpp"
#include "whitened.hpp"

namespace slideway {

inline constexpr const char* kSlideSymbol = "r";  // of the slide coordinate, as the paper has it
inline constexpr const char* kOfEachProfile = "per profile";

/// What something without a name may depend on, with cosines of it as a basis.
struct ProcessVariable {
  std::string symbol;  // "r" "t" "s" "X", "per profile", or "NAME alone" for one profile
  std::string unit;    // mm or s
  double range = 0.0;  // of the readings
  std::vector<std::size_t> profiles;     // fitted ones that it acts in
  std::vector<Eigen::MatrixXd> cosines;  // of each of these: #values by #cosines
  bool of_each = false;                  // each of these has a process of its own

  /// Per fitted profile: its rows of all coefficients.
  [[nodiscard]] std::vector<Eigen::MatrixXd> columns(const Linearisation& linear) const;
};

/// Slide coordinate of the low-band values of every fitted profile, mm.
std::vector<Eigen::VectorXd> slide_positions(const Model& model, const Linearisation& linear);

/// Readings of what something without a name depends on ("r" "t" "s" "X" "t_read") at the low-band
/// values of every fitted profile; of what is of one profile alone its trace position. mm or s
std::vector<Eigen::VectorXd> readings_of(const Model& model, const Linearisation& linear,
                                         const std::string& symbol);

/// Every variable that all fitted profiles have readings of: slide coordinate, cutting time,
/// cutting distance, trace position.
std::vector<ProcessVariable> shared_variables(const Model& model, const Linearisation& linear);

/// The same, then each profile with a process of its own, and one profile alone.
std::vector<ProcessVariable> process_variables(const Model& model, const Linearisation& linear);

/// A Gaussian process of a variable, outside the model's span: its values are cosines * w with
/// independent w of standard deviations `sizes`, the spectrum of a Matérn covariance.
struct Process {
  double log_evidence =
      -INFINITY;                 // over noise alone, nats; length, size, smoothness at their best
  double length = 0.0;           // part of the variable's range
  Eigen::VectorXd sizes;         // prior standard deviations of the coefficients
  Eigen::VectorXd coefficients;  // posterior mean
};

/// The process of largest evidence over Matérn smoothness 1/2, 3/2, 5/2, length and size. With G
/// the Gram matrix of the white cosines outside the model, b their products with the residual and
/// L L' the prior covariance of the coefficients (Rasmussen and Williams 2006, Eq. (2.30)):
///   ln E = b'L (I + L'G L)^-1 L'b / 2 - ln det(I + L'G L) / 2.
Process best_process(const Whitened& data, const ProcessVariable& variable);
std::vector<Process> best_processes(const Whitened& data,
                                    const std::vector<ProcessVariable>& variables);

}  // namespace slideway
