#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "slideway/identify/fit.hpp"
#include "slideway/identify/problem.hpp"
#include "slideway/trace/trace.hpp"

/// What to measure next: cuts and traces that could be made, tried on paper.
namespace slideway {

inline constexpr std::string_view kPlanSchema = "slideway.plan/1";
/// How the reason begins of a design that determines what is not: NextCut::reason.
inline constexpr std::string_view kDetermines = "determines ";

/// A cut or trace that can be made.
struct CutToCome {
  std::string what;  // "a cut at 8 mm/min"
  std::string like;  // the profile it differs from in that; "": none
  /// Everything but values: positions and setup as they will be.
  Profile profile;
  std::optional<double> cost, time_min;
};

/// The planned cuts of a problem. Without any, what a workshop can make of the first fitted face:
/// once more, at other feeds and speeds, the other way, traced at other azimuths or over the whole
/// diameter, at other levels Z, with another overhang; or of the first reading of a slide: once
/// more, backwards, at another speed. None takes longer than the longest cut there is, or an hour.
/// @throws UsageError  no fitted profile is there to begin with
std::vector<CutToCome> cuts_to_come(const Problem& problem, const std::vector<Profile>& profiles);

/// A wanted quantity: its U as it is and as it will be, none where it is not determined.
struct PlannedQuantity {
  std::string name, symbol, unit;
  std::optional<double> U_now, U_planned;
};

/// The detection limit of an effect, none where the model hides it at any size.
struct PlannedLimit {
  std::string effect, parameter, unit, at;
  std::string same_as;  // parameters of the model that hide it now; "": none do
  std::optional<double> now, planned;
};

/// Two effects that the present profiles do not tell apart. Numbers are the size, in detection
/// limits of today, from which on the effect is told from its rival; none: at no size.
struct PlannedPair {
  std::string effect, rival;
  std::optional<double> now, planned;
  bool told_apart = false;
};

/// Some cuts and what they bring.
struct PlannedDesign {
  std::vector<std::string> cuts;
  std::vector<std::string> criteria;  // by which a set is the best of its size: "D", "A"
  std::string reason;                 // in words
  double score = 0.0;                 // ranking_score()
  double d_gain = 0.0;                // of D-optimality
  double a_share = 1.0;               // of A-optimality
  std::optional<double> cost, time_min;
  std::vector<PlannedQuantity> quantities;
  std::vector<PlannedLimit> limits;
  std::vector<PlannedPair> pairs;
  std::vector<std::string> testable;  // effects that can be looked for, which they cannot now
};

struct PlannedCutSummary {
  std::string name, what, like;
  std::optional<double> cost, time_min;
};

struct Plan {
  std::string schema{kPlanSchema};
  std::string version, title;
  std::vector<PlannedCutSummary> cuts;
  std::vector<PlannedDesign> alone;  // best first
  std::vector<PlannedDesign> sets;   // of two and of three, each the best by a criterion
  std::vector<std::string> notes;
};

/// Fits the model that the closed loop ends with to the profiles there are and tries every cut on
/// paper: its columns are known, its noise is that of the profiles there are, and no value of it is
/// needed.
///
/// With u a standard uncertainty of a wanted quantity (the parameters of the carriages that no
/// convention fixes; where there are none, all), C their covariance and n their number:
///
///   d_gain   ln(det C now / det C planned) / (2 n): mean logarithm of what U falls by (D-optimal)
///   a_share  mean of (u planned / u now)²                                            (A-optimal)
///   score    d_gain + mean ln(limit now / planned) over the effects
///                   + mean ln(size told apart now / planned) over the pairs
///
/// A quantity that is not determined now counts as a hundred times what it will be, an effect that
/// is hidden or not told apart at any size as ten times, and no size counts as falling by more.
/// Sets of two and three are found by greedy exchange (Fedorov 1972): the best cut is added, then
/// each is exchanged for a better one as long as there is one; by the score with d_gain, and by
/// a_share. REQUIRES at least one cut.
/// @throws UsageError, DataError  as identify()
Plan plan_cuts(const Problem& problem, const std::vector<Profile>& profiles,
               const std::vector<CutToCome>& cuts, const Progress& progress = {});

/// The problem with the cuts as [[profile]] entries, as a file in `directory`; comments say what to
/// measure.
/// @throws UsageError  the problem file can no longer be read
std::string planned_problem_text(const Problem& problem, const std::vector<CutToCome>& cuts,
                                 const std::filesystem::path& directory);

}  // namespace slideway
