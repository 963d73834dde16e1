#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dictionary.hpp"
#include "paper_data.hpp"
#include "slideway/trace/plan.hpp"
#include "slideway/trace/trace.hpp"
#include "whitened.hpp"

namespace slideway {

/// An effect that may be missing, in the middle of its shapes, and where its columns stand among
/// those of a PaperProfile.
struct Suspect {
  const Candidate* candidate = nullptr;
  std::vector<double> shape;
  Eigen::VectorXd unit;  // amplitudes of size 1
  std::vector<Eigen::Index> columns;
  std::vector<std::vector<Eigen::Index>> derivatives;  // by shape
  double most = 0.0;            // a larger size is no flatness of the profiles there are
  std::optional<double> limit;  // in the profiles there are
};

/// A suspect and the places on a rival's grid where that looks most like it: columns of a point and
/// of its neighbours.
struct Rivalry {
  std::size_t suspect;
  std::string rival;
  std::vector<std::vector<Eigen::Index>> places;
};

/// Two effects, in one direction or in both.
struct SuspectPair {
  std::vector<Rivalry> directions;  // the one told apart last in front
  std::optional<double> now;        // as PlannedPair
};

/// The effects a problem can lack, held against one another in the profiles there are.
class Suspects {
 public:
  /// @param dictionary  of what the model lacks
  /// @param base        the model at its fit; outlives this
  Suspects(Dictionary dictionary, const FittedModel& base);

  [[nodiscard]] const std::vector<Suspect>& all() const { return suspects_; }
  /// Those that the profiles there are do not tell apart.
  [[nodiscard]] const std::vector<SuspectPair>& pairs() const { return pairs_; }
  /// Effects that cannot be looked for, with what that takes.
  [[nodiscard]] const std::vector<Untestable>& untestable() const {
    return dictionary_.not_testable;
  }

  /// An observation of any profile, on paper.
  [[nodiscard]] PaperProfile on_paper(const Observation& observation, const Noise& noise) const;

  /// Size found with the detection power.
  [[nodiscard]] std::optional<double> limit(const Suspect& suspect, const PaperData& data) const;

  /// Size from which on a suspect is told from its rival, in detection limits of today.
  [[nodiscard]] std::optional<double> told_apart(const SuspectPair& pair,
                                                 const PaperData& data) const;

  /// The profiles there are.
  [[nodiscard]] const std::vector<PaperProfile>& present() const { return present_; }

  /// Parameters of the model that make the columns of a suspect; "": they do not.
  [[nodiscard]] std::string hidden_by(const Suspect& suspect) const;

 private:
  /// A point of a rival's grid, with the columns of it and of its neighbours.
  struct Place {
    const Candidate* candidate;
    std::vector<Eigen::Index> atoms;
  };
  struct PlacedColumns {
    const Candidate* candidate;
    Eigen::Index atom, first;
  };

  void choose_suspects(const Whitened& data);
  void find_pairs(const Whitened& data);
  /// Where one candidate looks most like each suspect.
  [[nodiscard]] std::vector<std::vector<Place>> likely_places(const Candidate& rival,
                                                              const Whitened& data,
                                                              const Eigen::MatrixXd& white) const;
  [[nodiscard]] std::vector<Eigen::Index> columns_of(const Place& place);
  void put_on_paper();
  void set_pairs(const std::vector<Rivalry>& rivalries);
  [[nodiscard]] std::optional<double> told_apart(const Rivalry& rivalry,
                                                 const PaperData& data) const;

  const FittedModel& base_;
  Dictionary dictionary_;
  std::vector<Suspect> suspects_;
  std::vector<SuspectPair> pairs_;
  std::vector<PlacedColumns> placed_;  // of rivals, behind those of the suspects
  Eigen::Index columns_ = 0;
  std::vector<NotSeparable> hidden_;
  std::vector<PaperProfile> present_;
};

}  // namespace slideway
