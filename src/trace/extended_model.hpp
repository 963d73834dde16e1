#pragma once

#include "dictionary.hpp"
#include "slideway/identify/fit.hpp"
#include "slideway/trace/details.hpp"
#include "slideway/trace/trace.hpp"

namespace slideway {

/// An effect that has been added to the declared model.
struct Added {
  const Candidate* candidate = nullptr;
  std::vector<double> shape;
  TraceRound round;

  [[nodiscard]] const std::string& name() const { return candidate->name(); }
};

std::vector<Added> all_but(std::vector<Added> added, std::size_t i);

/// The declared model with added effects, fitted. Its fit points into its model: moved, never
/// copied.
struct Extended {
  Extended(std::vector<Added> effects, Model with_effects, Fit of_it)
      : added(std::move(effects)), model(std::move(with_effects)), fit(std::move(of_it)) {}
  Extended(const Extended&) = delete;
  Extended& operator=(const Extended&) = delete;
  Extended(Extended&&) = default;
  Extended& operator=(Extended&&) = default;

  std::vector<Added> added;
  Model model;
  Fit fit;
  double lost_centre_mm = 0.0;               // values within this radius are left out of the fit
  mutable std::optional<FitResult> numbers;  // Extender::summary(), made once
};

/// Makes Extended models of one problem, in the low band effects are searched in: the declared one,
/// or the first coarser one that leaves every profile few enough values.
class Extender {
 public:
  /// The profiles must outlive it and what it makes.
  Extender(const Problem& problem, const std::vector<Profile>& profiles);

  [[nodiscard]] const Model& base() const { return base_; }
  [[nodiscard]] const Fit& base_fit() const { return base_fit_; }

  [[nodiscard]] Extended extend(std::vector<Added> added) const;

  /// The report's numbers, in the declared low band. They live as long as `extended`.
  [[nodiscard]] const FitResult& summary(const Extended& extended) const;

  /// The same model, fitted in the declared low band.
  [[nodiscard]] Fitted declared(const Extended& extended) const;

 private:
  [[nodiscard]] FitResult summarised(const Extended& extended) const;
  [[nodiscard]] Eigen::VectorXd shapes_of(const std::vector<Added>& added) const;

  Model base_;
  Fit base_fit_;
  std::optional<Model> declared_;  // where its low band is another than the base's
};

}  // namespace slideway
