#include "dictionary.hpp"

#include <algorithm>
#include <optional>

#include "candidate_parts.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/parallel.hpp"
#include "slideway/base/text.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/identify/shape_grid.hpp"
#include "slideway/identify/solve.hpp"
#include "whitened.hpp"

namespace slideway {
namespace {

constexpr int kThinLevel = 2;  // four samples a low-band value show a search what it looks at
constexpr Eigen::Index kAtomsAtATime = 16;

/// A profile with four samples a low-band value, at the middles of equal blocks of the uniform grid
/// that the low band is made on. Means of equal blocks are again the low band for db1, so its
/// columns are those of the whole profile but for what varies inside a quarter, for the last block
/// if it is not whole, and for interpolation in gaps.
struct ThinProfile {
  std::vector<double> positions;
  LowBand low_band;
  double scale = 1.0;
};

std::optional<ThinProfile> thin(const Observation& observation) {
  LowBandOptions options = observation.low_band.options();
  if (options.wavelet != "db1" || options.level <= kThinLevel) return std::nullopt;
  const std::vector<double>& all = observation.profile->positions;
  const Eigen::Index samples = observation.low_band.samples();
  const Eigen::Index stride = Eigen::Index{1} << (options.level - kThinLevel);
  const double scale = std::sqrt(static_cast<double>(stride));
  const auto last = static_cast<double>(samples - 1);
  std::vector<double> positions;
  for (Eigen::Index i = 0; i < samples; i += stride)
    positions.push_back(std::lerp(
        all.front(), all.back(),
        std::min((static_cast<double>(i) + 0.5 * static_cast<double>(stride - 1)) / last, 1.0)));
  options.level = kThinLevel;
  LowBand low_band(options, positions);
  if (low_band.values() != observation.values.size() || low_band.resampled()) return std::nullopt;
  return ThinProfile{std::move(positions), std::move(low_band), scale};
}

/// The fitted observations as a search looks at them.
class Viewer {
 public:
  Viewer(const Model& model, Eigen::Index prior_rows)
      : model_(model), observations_(fitted_observations(model)), rows_(prior_rows) {
    for (const Observation* observation : observations_) {
      thin_.push_back(thin(*observation));
      rows_ += observation->values.size();
    }
  }

  [[nodiscard]] Eigen::Index rows() const { return rows_; }

  /// Of several shapes, side by side.
  /// @param is_fast  what varies inside a quarter of a low-band value counts
  void columns(const ModelTerm& term, std::span<const std::vector<double>> shapes, bool is_fast,
               Eigen::Ref<Eigen::MatrixXd> out) const {
    Eigen::Index row = 0;
    for (std::size_t i = 0; i < observations_.size(); ++i) {
      const Observation& observation = *observations_[i];
      auto rows = out.middleRows(row, observation.values.size());
      row += rows.rows();
      if (!term.acts_on(*observation.profile))
        rows.setZero();
      else if (thin_[i] && !is_fast)
        rows = thin_columns(term, shapes, observation, *thin_[i]);
      else
        rows = low_band_columns_of_shapes(model_, term, observation, shapes);
    }
    out.bottomRows(rows_ - row).setZero();
  }

 private:
  [[nodiscard]] Eigen::MatrixXd thin_columns(const ModelTerm& term,
                                             std::span<const std::vector<double>> shapes,
                                             const Observation& observation,
                                             const ThinProfile& profile) const {
    const Stations stations(profile.positions, observation.profile->setup, model_.machine);
    Eigen::MatrixXd columns(stations.size(), std::ssize(shapes) * term.effect->amplitudes());
    term.effect->columns_of_shapes(stations, shapes, columns);
    return profile.scale * profile.low_band.apply(columns);
  }

  const Model& model_;
  std::vector<const Observation*> observations_;
  std::vector<std::optional<ThinProfile>> thin_;
  Eigen::Index rows_;
};

/// The fitted profiles an effect acts on.
std::vector<const Setup*> setups_of(const Model& model, const ModelTerm& term) {
  std::vector<const Setup*> out;
  for (const Observation* observation : fitted_observations(model))
    if (term.acts_on(*observation->profile)) out.push_back(&observation->profile->setup);
  return out;
}

/// What the problem lacks for an effect to be looked for, or nothing.
std::string needs(const Model& model, const ModelTerm& term) {
  std::vector<std::string> keys;
  for (const Observation& observation : model.observations) {
    const Setup& setup = observation.profile->setup;
    if (!term.acts_on(*observation.profile)) continue;
    for (const std::string& key : term.effect->lacking(setup))
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
  }
  if (!keys.empty()) return joined(keys);
  const std::vector<const Setup*> shown = setups_of(model, term);
  return shown.empty() ? "a reading that shows it" : joined(term.effect->lacking_together(shown));
}

void lay_out(const Viewer& viewer, ShapeLattice grid, Candidate& candidate) {
  candidate.grid = std::move(grid);
  const Eigen::Index a = candidate.amplitudes(), atoms = candidate.atoms();
  auto columns = std::make_shared<Eigen::MatrixXd>(viewer.rows(), a * atoms);
  parallel_for((atoms + kAtomsAtATime - 1) / kAtomsAtATime, [&](std::size_t block) {
    const Eigen::Index first = static_cast<Eigen::Index>(block) * kAtomsAtATime;
    const Eigen::Index count = std::min(kAtomsAtATime, atoms - first);
    const auto shapes =
        std::span(candidate.grid.points())
            .subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(count));
    viewer.columns(candidate.term, shapes, candidate.is_fast,
                   columns->middleCols(first * a, count * a));
  });
  candidate.rows = {{0, viewer.rows()}};
  candidate.columns = std::move(columns);
}

/// Axes of the shapes but those of a higher order.
std::vector<std::vector<double>> lower_axes(const Candidate& candidate,
                                            const std::vector<std::vector<double>>& axes) {
  std::vector<std::vector<double>> out;
  for (std::size_t s = 0; s < axes.size(); ++s)
    if (!candidate.term.effect->shapes()[s].higher_order) out.push_back(axes[s]);
  return out;
}

/// Where an effect differs from an earlier one by shapes of a higher order alone, both have the
/// same columns on the grid, and share them.
bool shares_columns(const std::vector<std::vector<double>>& axes, const Candidate& earlier,
                    const Candidate& candidate) {
  return earlier.effect_name() == candidate.effect_name() &&
         earlier.term.profiles == candidate.term.profiles &&
         earlier.amplitudes() == candidate.amplitudes() && !earlier.raises_degree &&
         !candidate.raises_degree && axes.size() > earlier.grid.axes().size() &&
         lower_axes(candidate, axes) == lower_axes(earlier, earlier.grid.axes());
}

/// Adds a candidate whose effect is set, with what it takes to be named.
void add(const Model& model, const Viewer& viewer, Candidate candidate, Dictionary& out) {
  const ModelTerm& term = candidate.term;
  candidate.takes = joined(term.effect->lacking_to_be_told(setups_of(model, term)));
  if (!candidate.takes.empty()) out.not_testable.push_back({term.name, candidate.takes});
  std::vector<std::vector<double>> axes = shape_axes(model, term);
  const auto earlier = std::ranges::find_if(
      out.candidates, [&](const Candidate& each) { return shares_columns(axes, each, candidate); });
  if (earlier == out.candidates.end()) {
    lay_out(viewer, ShapeLattice(std::move(axes)), candidate);
  } else {
    candidate.grid = ShapeLattice(std::move(axes));
    candidate.columns = earlier->columns;
    candidate.rows = earlier->rows;
  }
  out.candidates.push_back(std::move(candidate));
}

/// Those of an error of an instrument are looked for with each instrument.
std::vector<EffectOptions> hypotheses_of(const Effect& effect, const EffectOptions* declared,
                                         const Model& model) {
  std::vector<EffectOptions> hypotheses = effect.hypotheses(declared), out;
  if (!effect.description().of_instrument) return hypotheses;
  std::vector<const Profile*> profiles;
  for (const Observation& observation : model.observations)
    if (effect.applies_to(observation.profile->setup)) profiles.push_back(observation.profile);
  for (const EffectOptions& options : hypotheses)
    std::ranges::move(of_each_instrument(options, profiles), std::back_inserter(out));
  return out;
}

/// The hypotheses about an effect: it is missing, or it needs more terms than the one declared of
/// that name. None where the problem declares several of it.
void add_hypotheses(const Model& model, const Problem& problem, const std::string& name,
                    const Viewer& viewer, Dictionary& out) {
  const auto of_name = [&](const DeclaredEffect& effect) { return effect.name == name; };
  const auto declared = std::ranges::find_if(problem.effects, of_name);
  const bool any = declared != problem.effects.end();
  if (std::ranges::count_if(problem.effects, of_name) > 1) return;
  const auto hypotheses = hypotheses_of(specimen(name), any ? &declared->options : nullptr, model);
  const auto lacking = specimen(name).lacking_of_machine(model.range);
  if (!hypotheses.empty() && !lacking.empty())
    return out.not_testable.push_back({name, joined(lacking) + " in [machine]"});
  std::string missing;
  bool added = false;
  for (const EffectOptions& options : hypotheses) {
    Candidate candidate;
    candidate.term.name = term_name(name, options.profiles);
    candidate.term.profiles = options.profiles;
    candidate.options = options;
    candidate.options.above.reset();
    candidate.raises_degree = any;
    try {
      candidate.term.effect = make_effect(name, options, model.machine, model.range);
      missing = needs(model, candidate.term);
    } catch (const UsageError& error) {  // the machine lacks what the effect needs
      missing = error.what();
    }
    if (!missing.empty()) continue;
    add(model, viewer, std::move(candidate), out);
    added = true;
  }
  if (!added && !missing.empty()) out.not_testable.push_back({name, missing});
}

/// An effect that is looked for with the options the problem gives it, and simpler ones.
void add_own(const Model& model, const Problem& problem, const DeclaredEffect& own,
             const Viewer& viewer, Dictionary& out) {
  if (std::ranges::count(problem.effects, own.name, &DeclaredEffect::name) > 0) return;
  Candidate candidate;
  candidate.term.name = term_name(own.name, own.options.profiles);
  candidate.term.profiles = own.options.profiles;
  candidate.options = own.options;
  candidate.options.simpler.clear();
  candidate.term.effect = make_effect(own.name, own.options, model.machine, model.range);
  const std::string missing = needs(model, candidate.term);
  if (!missing.empty()) return out.not_testable.push_back({candidate.term.name, missing});
  add(model, viewer, candidate, out);
  candidate.is_simpler = true;
  for (const EffectFactory& simpler : own.options.simpler) {
    candidate.options.own = simpler;
    candidate.term.effect = make_effect(own.name, candidate.options, model.machine, model.range);
    add(model, viewer, candidate, out);
  }
}

/// The effects of one rate at those of lines that are too fast for the low band.
void add_fast(const Model& model, const Viewer& viewer, const std::vector<FastLine>& lines,
              Dictionary& out) {
  if (lines.empty()) return;
  std::vector<Candidate> fast;
  for (const Candidate& each : out.candidates)
    for (ShapeLattice& grid : shapes_of_lines(model, each.term, lines)) {
      Candidate& own = fast.emplace_back(each);
      own.is_fast = true;
      lay_out(viewer, std::move(grid), own);
    }
  std::ranges::move(fast, std::back_inserter(out.candidates));
}

}  // namespace

bool is_of_place(const Candidate& candidate) {
  const Description& own = candidate.term.effect->description();
  const auto is_as_of_face = [&](const std::string& other) {
    return specimen(other).description().of_face;
  };
  return own.of_face || (own.variable == IndependentVariable::trace &&
                         std::ranges::any_of(own.confounded_effects, is_as_of_face));
}

Eigen::MatrixXd Candidate::columns_around(Eigen::Index atom) const {
  const std::vector<Eigen::Index> atoms = grid.around(atom);
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(columns->rows(), std::ssize(atoms) * amplitudes());
  for (std::size_t i = 0; i < atoms.size(); ++i)
    for (const RowRange& run : rows)
      out.block(run.first, static_cast<Eigen::Index>(i) * amplitudes(), run.count, amplitudes()) =
          columns->block(run.first, atoms[i] * amplitudes(), run.count, amplitudes());
  return out;
}

void lay_out(const Model& model, Eigen::Index prior_rows, Candidate& candidate) {
  lay_out(model, prior_rows, ShapeLattice(shape_axes(model, candidate.term)), candidate);
}

void lay_out(const Model& model, Eigen::Index prior_rows, ShapeLattice grid, Candidate& candidate) {
  lay_out(Viewer(model, prior_rows), std::move(grid), candidate);
}

Dictionary make_dictionary(const Model& model, const Problem& problem, Eigen::Index prior_rows,
                           const std::vector<FastLine>& lines) {
  Dictionary out;
  const Viewer viewer(model, prior_rows);
  std::vector<Candidate> alone;
  for (const std::string& name : problem.trace.candidates)
    add_hypotheses(model, problem, name, viewer, out);
  for (const DeclaredEffect& own : problem.trace.own) add_own(model, problem, own, viewer, out);
  add_fast(model, viewer, lines, out);
  for (Candidate& whole : out.candidates) {
    std::vector<Candidate> parts = in_parts(model, whole);
    whole.is_searched = !has_forms_of_its_own(model, whole, parts);
    std::ranges::move(parts, std::back_inserter(alone));
  }
  std::ranges::move(alone, std::back_inserter(out.candidates));
  std::erase_if(out.candidates, [&](const Candidate& each) {
    return !each.raises_degree &&
           std::ranges::count(model.terms, each.name(), &ModelTerm::name) > 0;
  });
  return out;
}

Eigen::MatrixXd searched_columns(const Model& model, const ModelTerm& term,
                                 std::span<const std::vector<double>> shapes) {
  const Viewer viewer(model, 0);
  Eigen::MatrixXd out(viewer.rows(), std::ssize(shapes) * term.effect->amplitudes());
  viewer.columns(term, shapes, false, out);
  return out;
}

Eigen::MatrixXd stacked_columns(const Model& model, const ModelTerm& term,
                                std::span<const double> shape, Eigen::Index prior_rows) {
  const auto observations = fitted_observations(model);
  return stack(observations, prior_rows, term.effect->amplitudes(), [&](std::size_t i) {
    return low_band_columns(model, term, *observations[i], shape);
  });
}

std::vector<Eigen::MatrixXd> by_profile(const Linearisation& linear,
                                        const Eigen::MatrixXd& stacked) {
  std::vector<Eigen::MatrixXd> out;
  Eigen::Index first = 0;
  for (const Observation* each : linear.observations) {
    out.emplace_back(stacked.middleRows(first, each->values.size()));
    first += each->values.size();
  }
  return out;
}

Eigen::MatrixXd stacked_slopes(const Model& model, const ModelTerm& term,
                               std::span<const double> shape, const Eigen::VectorXd& amplitudes,
                               Eigen::Index prior_rows) {
  const auto observations = fitted_observations(model);
  return stack(observations, prior_rows, std::ssize(shape), [&](std::size_t i) {
    return low_band_slopes(model, term, *observations[i], shape, amplitudes);
  });
}

}  // namespace slideway
