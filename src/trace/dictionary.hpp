#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fast_lines.hpp"
#include "shape_lattice.hpp"
#include "slideway/identify/model.hpp"
#include "slideway/identify/solve.hpp"
#include "whitened.hpp"

namespace slideway {

/// An effect that may be missing, with its columns at every shape the search looks at.
struct Candidate {
  ModelTerm term;
  EffectOptions options;
  bool raises_degree = false;  // of the declared effect; the columns are the terms that one lacks
  ShapeLattice grid;           // its points are the atoms
  std::string takes;           // Effect::lacking_to_be_told(); empty: it may be named
  bool coarse = false;         // the grid: shapes are refined over all of it
  bool is_fast = false;        // its shapes are those of fast_lines()
  bool is_simpler = false;     // another one of its name has more shapes
  bool is_searched = true;     // false: each surface has a form of its own, looked for alone
  /// Stacked rows by (#amplitudes * #atoms), not whitened; shared with the same effect in some
  /// profiles alone.
  std::shared_ptr<const Eigen::MatrixXd> columns;
  std::vector<std::size_t> part;  // the fitted observations it acts on alone; empty: all
  double choice = 0.0;  // price of choosing that part among those that show it, as BIC counts
  std::vector<RowRange> rows;  // of the columns, those it acts on

  [[nodiscard]] const std::string& name() const { return term.name; }  // "step[feed2]"
  /// Of all profiles; of several of one name, that with the whole of its shapes.
  [[nodiscard]] bool stands_for_effect() const {
    return term.profiles.empty() && !is_fast && !is_simpler;
  }
  [[nodiscard]] const std::string& effect_name() const { return term.effect->description().name; }
  [[nodiscard]] Eigen::Index amplitudes() const { return term.effect->amplitudes(); }
  [[nodiscard]] Eigen::Index atoms() const { return std::ssize(grid.points()); }
  /// Stacked columns of an atom and of its neighbours on the grid, for a shape between them.
  [[nodiscard]] Eigen::MatrixXd columns_around(Eigen::Index atom) const;
  /// Free numbers: the amplitudes that the model does not span, and the shapes.
  [[nodiscard]] Eigen::Index unknowns(Eigen::Index rank) const {
    return rank + std::ssize(term.effect->shapes());
  }
};

/// Whether every cut has the effect: feed marks.
inline bool is_kinematic(const Candidate& candidate) {
  return candidate.term.effect->description().kinematic;
}

/// Whether somebody logged the cause.
inline bool is_measured(const Candidate& candidate) {
  return candidate.term.effect->description().measured;
}

/// The one profile it acts on alone, by its place among those fitted.
inline std::optional<std::size_t> only(const Candidate& candidate) {
  return candidate.part.size() == 1 ? std::optional(candidate.part.front()) : std::nullopt;
}

/// Whether it is of the place of a trace on the workpiece: a trace off centre, or a step of the
/// spindle, which is exactly as that.
bool is_of_place(const Candidate& candidate);

/// Those a search looks at.
using Candidates = std::vector<const Candidate*>;

struct Untestable {
  std::string effect, needs;
};

/// The candidates of a problem, ready to be held against residuals.
struct Dictionary {
  std::vector<Candidate> candidates;
  std::vector<Untestable> not_testable;
};

/// The hypotheses of every candidate effect about itself (Effect::hypotheses), and each that is no
/// carriage's also in a part of the profiles: in each alone, where several show it; in the traces
/// of one surface, where one of them cannot have it without the others.
/// @param prior_rows  rows of zeros below the observations', one per prior of the model
/// @param lines       of the samples, too fast for the low band, where an effect of one rate is
///                    looked for besides
Dictionary make_dictionary(const Model& model, const Problem& problem, Eigen::Index prior_rows,
                           const std::vector<FastLine>& lines = {});

/// Gives a candidate whose effect is set the grid of its shapes and the columns there.
void lay_out(const Model& model, Eigen::Index prior_rows, Candidate& candidate);
/// The same on a grid of one's own.
void lay_out(const Model& model, Eigen::Index prior_rows, ShapeLattice grid, Candidate& candidate);

/// Columns of an effect at several shapes side by side, stacked, as a search looks at them.
Eigen::MatrixXd searched_columns(const Model& model, const ModelTerm& term,
                                 std::span<const std::vector<double>> shapes);

/// Low-band columns of an effect under one another for all fitted observations, prior rows zero.
Eigen::MatrixXd stacked_columns(const Model& model, const ModelTerm& term,
                                std::span<const double> shape, Eigen::Index prior_rows);

/// The rows of each fitted observation.
std::vector<Eigen::MatrixXd> by_profile(const Linearisation& linear,
                                        const Eigen::MatrixXd& stacked);

/// The same for low_band_slopes().
Eigen::MatrixXd stacked_slopes(const Model& model, const ModelTerm& term,
                               std::span<const double> shape, const Eigen::VectorXd& amplitudes,
                               Eigen::Index prior_rows);

}  // namespace slideway
