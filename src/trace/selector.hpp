#pragma once

#include <string>
#include <vector>

#include "selection.hpp"
#include "set_statistics.hpp"
#include "stability.hpp"

namespace slideway {

/// A set of effects that grows by the best of each search, until none is better in the place of one
/// of it and each passes every gate beside the others.
class Selector {
 public:
  using Effects = std::vector<AcceptedEffect>;

  Selector(const Problem& problem, SetStatistics& statistics, const Gates& gates,
           const Progress& progress)
      : problem_(problem),
        statistics_(statistics),
        extender_(statistics.extender()),
        gates_(gates),
        progress_(progress) {}

  void select();
  /// Begins with a raised degree.
  void grow_from(const Candidate& raised);
  /// Begins with what the first search found, whether it passes or not.
  void begin_with(const TestedCandidate& found);
  /// Goes on as select() would, had that been chosen. Nothing is selected where nothing has grown.
  void complete(const Candidate& raised);
  /// Never to be chosen.
  void exclude(const std::string& name);
  /// Takes back what does not pass every gate beside the others as they are now.
  void take_back();
  /// Takes one out of the set.
  void leave(std::size_t which, const std::string& why);
  /// Whether this set leads another one, selected without some candidates, by so little that the
  /// other takes its place.
  bool leaves_to(Selector& other, double by);
  /// Of the effects of the set, in alphabetical order.
  [[nodiscard]] std::vector<std::string> names() const;
  /// Lack of fit beside the set.
  [[nodiscard]] LackOfFit left_over();
  /// Whether the last search finds more than noise gives: an effect of all profiles that passes, or
  /// so much that it does not matter where and why no name was given.
  [[nodiscard]] bool something_is_left();
  /// Whether an effect of all profiles that was taken back passes the gates of the search, under
  /// the noise beside it, all the same: it has found something.
  [[nodiscard]] bool one_stands_out();

  Selection& out() { return out_; }
  [[nodiscard]] const std::vector<std::string>& excluded() const { return excluded_; }

 private:
  AcceptedEffect accepted(const SearchRound& round, const TestedCandidate& choice);
  void grow();
  /// Whether an effect of all profiles would shrink to a part of itself after it has made several
  /// such parts superfluous: none of the others can come back.
  [[nodiscard]] bool narrows_to_one_of_several(const AcceptedEffect& effect,
                                               const TestedCandidate& part) const;
  /// An effect of all profiles beside the same effect in some of them is confined to the rest,
  /// where that explains as much.
  void confine_last(const SearchRound& round, const TestedCandidate& last);
  /// Why an effect that resamples often find nothing instead of does not enter; "": it does.
  [[nodiscard]] std::string comes_and_goes(const Stability& found) const;
  /// Earlier effects that the last one has made superfluous leave.
  void drop_superfluous();
  /// Each effect once more against all candidates, the others as they are: a better one takes its
  /// place.
  void exchange();
  /// What is too small beside the others leaves before rivals are compared: a rival would take a
  /// part of theirs.
  void drop_small();
  std::string reason_to_leave(std::size_t i);
  /// The places of the other traces, where several have one of their own.
  void add_places();
  void tell(const std::string& stage, std::size_t i) const;

  const Problem& problem_;
  SetStatistics& statistics_;
  ModelExtender& extender_;
  const Gates& gates_;
  const Progress& progress_;
  std::vector<std::string> excluded_;
  std::vector<std::string> ruled_out_;   // names that do not help beside the others
  std::vector<std::string> taken_back_;  // those of them that were in the set
  bool narrowed_ = false;  // the same effect in fewer cuts: it may be in others as well
  Selection out_;
};

}  // namespace slideway
