#pragma once

#include <vector>

#include "slideway/identify/fit.hpp"

namespace slideway {

/// One profile as an experiment on paper needs it: white, what is free in the trace taken out, the
/// model's columns and those of effects that may be missing (suspects) turned into few rows that
/// they share and rows that are the suspects' own. No value of the profile is in it.
struct PaperProfile {
  Eigen::MatrixXd model;    // at most k by k
  Eigen::MatrixXd inside;   // the same rows of the suspects
  Eigen::MatrixXd outside;  // what is left of the suspects in other rows
  Eigen::VectorXd squares;  // of the white suspects, before anything was taken out
  Eigen::VectorXd scale;    // the same of the model
  Eigen::Index values = 0;

  PaperProfile(const Observation& observation, const Noise& noise, const Eigen::MatrixXd& columns,
               Eigen::MatrixXd suspects);
};

/// Several of them together: inner products of what the model leaves of the suspects, made for
/// those that are asked for. The profiles outlive it.
class PaperData {
 public:
  /// @param prior_rows  of the model (Linearisation::prior_rows)
  PaperData(std::vector<const PaperProfile*> profiles, const Eigen::MatrixXd& prior_rows);

  [[nodiscard]] Eigen::Index values() const { return values_; }

  /// Of these columns, outside the model and the columns `beside`; 0 what is rounding.
  [[nodiscard]] Eigen::MatrixXd left(const std::vector<Eigen::Index>& columns,
                                     const std::vector<Eigen::Index>& beside = {}) const;

  /// How many of these columns the model does not make.
  [[nodiscard]] Eigen::Index rank(const std::vector<Eigen::Index>& columns) const;

 private:
  [[nodiscard]] Eigen::MatrixXd products(const std::vector<Eigen::Index>& columns,
                                         const std::vector<Eigen::Index>& others) const;

  std::vector<const PaperProfile*> profiles_;
  Eigen::MatrixXd inside_;  // rows of the suspects in which the profiles meet, less the model's
  Eigen::VectorXd squares_;
  Eigen::Index values_ = 0;
};

}  // namespace slideway
