#pragma once

#include "dictionary.hpp"
#include "slideway/identify/fit.hpp"
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

/// The declared model with added effects, fitted.
struct Extended : FittedModel {
  Extended(FittedModel with_effects, std::vector<Added> effects)
      : FittedModel(std::move(with_effects)), added(std::move(effects)) {}

  std::vector<Added> added;
  double lost_centre_mm = 0.0;                 // values within this radius are left out of the fit
  mutable std::optional<ModelResult> numbers;  // Extender::summary(), made once
};

/// Makes Extended models of one problem, in the low band effects are searched in: the declared one,
/// or the first coarser one that leaves every profile few enough values.
class Extender {
 public:
  /// The profiles and the declared model must outlive it and what it makes.
  Extender(const Problem& problem, const std::vector<Profile>& profiles,
           const FittedModel& declared);

  [[nodiscard]] const FittedModel& base() const { return coarser_ ? *coarser_ : declared_; }

  [[nodiscard]] Extended extend(std::vector<Added> added) const;

  /// The report's numbers, in the declared low band. They live as long as `extended`.
  [[nodiscard]] const ModelResult& summary(const Extended& extended) const;

  /// The same model, fitted in the declared low band.
  [[nodiscard]] FittedModel in_declared_band(Extended extended) const;

 private:
  [[nodiscard]] ModelResult summarised(const Extended& extended) const;
  [[nodiscard]] FittedModel refitted(const Extended& extended) const;
  [[nodiscard]] Eigen::VectorXd shapes_of(const std::vector<Added>& added) const;

  const FittedModel& declared_;
  std::optional<FittedModel> coarser_;
};

}  // namespace slideway
