#pragma once

#include <map>

#include "search_band.hpp"
#include "search_round.hpp"
#include "slideway/identify/fit.hpp"
#include "slideway/trace/trace.hpp"
#include "time_limit.hpp"

namespace slideway {

/// An effect that was added to the declared model.
struct AcceptedEffect {
  const Candidate* candidate = nullptr;
  std::vector<double> shape;
  TraceRound round;
  bool is_expected = false;  // its BIC alone counts: place_of_another()

  [[nodiscard]] const std::string& name() const { return candidate->name(); }
};

/// What a search has worked with, for a plan of what to measure next.
struct Searched {
  std::unique_ptr<SearchBand> band;  // with the effects that were added; null: the declared one
  Dictionary dictionary;             // of what is not in that model, without lines of the samples
};

/// How many effects a set has, of one with a size per cut one.
int distinct_effects(const std::vector<AcceptedEffect>& effects);

/// Of a set, polynomials of the carriages that are raised.
std::vector<AcceptedEffect> raised_degrees(std::vector<AcceptedEffect> effects);

std::vector<AcceptedEffect> all_but(std::vector<AcceptedEffect> effects, std::size_t i);
/// @param which  rising
std::vector<AcceptedEffect> all_but(const std::vector<AcceptedEffect>& effects,
                                    const std::vector<std::size_t>& which);

/// Makes and searches models of one problem, in the low band effects are searched in: that of each
/// profile, or the first coarser one that leaves it few enough values. What was made once for a set
/// of effects is kept.
/// Whatever it makes, the time limit is asked first: TimeIsUp.
class ModelExtender {
 public:
  /// All arguments must outlive it and what it makes.
  /// @param declared  with what is shown
  ModelExtender(const Problem& problem, const std::vector<Profile>& profiles,
                const FittedModel& declared, const TimeLimit& limit, const Progress& progress);

  /// The declared model, in the low band of the search.
  [[nodiscard]] const FittedModel& base() const { return coarser_ ? coarser_->fitted : declared_; }

  /// Whether that is coarser than the declared one.
  [[nodiscard]] bool is_coarser() const { return coarser_ != nullptr; }

  /// The profiles of base().
  [[nodiscard]] const std::vector<Profile>& profiles() const {
    return coarser_ ? coarser_->profiles : profiles_;
  }

  /// The declared model with effects, fitted.
  const FittedModel& extended(const std::vector<AcceptedEffect>& effects);

  /// Its numbers for the report, in the declared low band.
  const ModelResult& summary(const std::vector<AcceptedEffect>& effects);

  /// The same in the low band of the search.
  const ModelResult& summary_of_search(const std::vector<AcceptedEffect>& effects);

  /// Its residual searched for every candidate whose name is not among the effects.
  const SearchRound& search(const std::vector<AcceptedEffect>& effects);

  /// That search if it was made, or null.
  [[nodiscard]] const SearchRound* searched(const std::vector<AcceptedEffect>& effects) const;

  /// The same model, fitted in the declared low band, taken out of what is kept: the last call.
  FittedModel take_in_declared_band(const std::vector<AcceptedEffect>& effects);

  /// With the effects of a set added: the last call of all.
  Searched take_searched(const std::vector<AcceptedEffect>& effects);

  [[nodiscard]] const Dictionary& dictionary() const { return dictionary_; }
  [[nodiscard]] const TimeLimit& limit() const { return limit_; }
  /// Candidates whose name is not among the effects.
  [[nodiscard]] Candidates candidates_beside(const std::vector<AcceptedEffect>& effects) const;
  /// Null distribution of the search; none before the first search, or without candidates.
  [[nodiscard]] const std::optional<Calibration>& calibration() const { return calibration_; }
  /// How many searches were made: one for each set of effects that was looked at.
  [[nodiscard]] std::size_t searches() const { return rounds_.size(); }

 private:
  [[nodiscard]] FittedModel in_declared_band(const std::vector<AcceptedEffect>& effects);

  using Key =
      std::vector<std::pair<std::string, int>>;  // names with degrees, or unknowns, in order

  static Key key_of(const std::vector<AcceptedEffect>& effects);
  [[nodiscard]] Eigen::VectorXd shapes_of(const std::vector<AcceptedEffect>& effects) const;

  const std::vector<Profile>& profiles_;
  const FittedModel& declared_;
  const TimeLimit& limit_;
  const Progress& progress_;
  std::unique_ptr<SearchBand> coarser_;
  Eigen::Index spare_values_;                   // of base(): what more unknowns could rest on
  std::optional<Eigen::Index> spare_stations_;  // and those along the slide
  Dictionary dictionary_;
  std::optional<Calibration> calibration_;
  std::map<Key, FittedModel> models_;
  std::optional<std::pair<Key, FittedModel>> last_fine_;  // of summary()
  std::map<Key, ModelResult> summaries_, search_summaries_;
  std::map<Key, SearchRound> rounds_;
};

}  // namespace slideway
