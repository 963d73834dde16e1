#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "slideway/effects/effect.hpp"
#include "slideway/identify/gates.hpp"
#include "slideway/identify/problem.hpp"
#include "slideway/signal/low_band.hpp"

namespace slideway {

/// One effect of the model with the place of its numbers among all: linear amplitudes and shape
/// parameters of all effects are numbered through, effect by effect.
struct ModelTerm {
  std::string name;  // term_name() of the effect: "squareness", "step[feed2]"
  std::shared_ptr<const Effect> effect;
  std::vector<Prior> priors;
  Eigen::Index first_amplitude = 0;
  Eigen::Index first_shape = 0;
  Eigen::Index first_parameter = 0;
  std::vector<std::string> profiles = {};  // those it acts in; empty: all

  /// Whether it acts in a profile, and the reading sees it.
  [[nodiscard]] bool acts_on(const Profile& profile) const;
};

/// Name of an effect in a model, with the profiles it is confined to: "step[feed2]",
/// "step[feed2,feed3]".
std::string term_name(const std::string& effect, const std::vector<std::string>& profiles);

/// The options of an effect that has a size of its own with each instrument that read these
/// profiles: with one instrument as they are.
std::vector<EffectOptions> of_each_instrument(const EffectOptions& options,
                                              const std::vector<const Profile*>& profiles);

/// The shape parameters of a term among those of all terms.
inline std::span<const double> shapes_of(const ModelTerm& term, const Eigen::VectorXd& shapes) {
  return {shapes.data() + term.first_shape, term.effect->shapes().size()};
}

/// One profile as the fit sees it: its low band and the columns of its own nuisances in it.
struct Observation {
  const Profile* profile = nullptr;
  LowBand low_band;
  Eigen::VectorXd values;     // #values
  Eigen::MatrixXd nuisances;  // #values by 0, 1 or 2: offset, tilt of the trace; then left_out()
  std::vector<std::string> nuisance_names;

  /// How many values are left out of the fit, each by a nuisance of its own without a name.
  [[nodiscard]] Eigen::Index left_out() const {
    return nuisances.cols() - std::ssize(nuisance_names);
  }
};

/// Least and greatest slide coordinate of a profile's readings (of a base: its centre). mm
struct SlideRange {
  double least = 0.0, greatest = 0.0;
};
SlideRange slide_range(const Profile& profile, const Machine& machine);

/// What is left of columns in an observation's low band when what is free in the trace (offset,
/// tilt) is taken out by least squares; their means are taken out too, values that are left out of
/// the fit become 0.
Eigen::MatrixXd levelled(const Observation& observation, Eigen::MatrixXd columns);

/// Leaves low-band values of an observation out of every fit. @return true if one was not yet
bool leave_out(Observation& observation, const std::vector<Eigen::Index>& values);

/// Those that are left out, rising.
std::vector<Eigen::Index> left_out_values(const Observation& observation);

/// The declared model and the data it is held against.
struct Model {
  Machine machine;
  TravelRange range;  // of all profiles
  std::vector<ModelTerm> terms;
  std::vector<Observation>
      observations;  // one per profile, fit and holdout, in the problem's order
  Gates gates;
  bool complete = false;  // taken to be: its noise is noise_if_complete(), else noise_under()

  [[nodiscard]] Eigen::Index amplitudes() const;
  [[nodiscard]] Eigen::Index shapes() const;
  [[nodiscard]] Eigen::Index parameters() const;
  /// "squareness.dbeta_xz"
  [[nodiscard]] std::vector<std::string> parameter_names() const;
  /// The first term that is this error of the carriages, or null.
  [[nodiscard]] const ModelTerm* find_term(MotionError error) const;
};

/// What the fitted profiles measured of the slide, a bridge from foot to foot. REQUIRES one.
/// @param term  those it acts on alone; null: all
SlideRange measured_travel(const Model& model, const ModelTerm* term = nullptr);

/// Builds effects (with an inner basis for the travel of the profiles) and the low bands. The
/// profiles must outlive the model.
/// @param most_values  of a profile's low band: its level is raised until it has no more
/// @throws UsageError  an effect lacks the metadata of its variable, named by profile and key
/// @throws DataError   fewer samples than 2^level
Model build_model(const Problem& problem, const std::vector<Profile>& profiles,
                  std::size_t most_values = std::numeric_limits<std::size_t>::max());

/// Puts one more effect into a model. @throws UsageError as build_model().
void append_term(Model& model, const DeclaredEffect& declared, const TravelRange& range);

/// Makes the effect of a term anew with other options, its priors kept. REQUIRES a term of that
/// name.
void remake_term(Model& model, const std::string& name, const EffectOptions& options);

/// Low-band value of a height (slope) of 1 that varies slowly: the root of samples a value.
double low_band_scale(const Observation& observation);

/// Columns of one effect in the low band of one observation: #values by #amplitudes; zero where the
/// reading cannot see the effect.
Eigen::MatrixXd low_band_columns(const Model& model, const ModelTerm& term,
                                 const Observation& observation, std::span<const double> shape);

/// What each of the parameters of an effect without shapes does to that low band, one column each:
/// its value, and behind those its standard uncertainty.
Eigen::MatrixXd low_band_images(const Model& model, const ModelTerm& term,
                                const std::vector<Prior>& values, const Observation& observation);

/// The same of several shapes, side by side.
Eigen::MatrixXd low_band_columns_of_shapes(const Model& model, const ModelTerm& term,
                                           const Observation& observation,
                                           std::span<const std::vector<double>> shapes);

/// The same for the derivatives of the columns by each shape, side by side: #values by #shapes
/// #amplitudes; for a stepwise shape the difference over one low-band value, which is what the data
/// resolve.
Eigen::MatrixXd low_band_derivatives(const Model& model, const ModelTerm& term,
                                     const Observation& observation, std::span<const double> shape);

/// How what an effect with these amplitudes adds changes with each of its shapes: #values by
/// #shapes.
Eigen::MatrixXd low_band_slopes(const Model& model, const ModelTerm& term,
                                const Observation& observation, std::span<const double> shape,
                                const Eigen::VectorXd& amplitudes);

/// What an effect with these amplitudes adds to every sample of a profile, mm or rad.
Eigen::VectorXd effect_signal(const Model& model, const ModelTerm& term, const Profile& profile,
                              const Eigen::VectorXd& amplitudes, std::span<const double> shape);

/// The same for as many samples from `first` on as `signal` has.
void effect_signal(const Model& model, const ModelTerm& term, const Profile& profile,
                   const Eigen::VectorXd& amplitudes, std::span<const double> shape,
                   Eigen::Index first, Eigen::Ref<Eigen::VectorXd> signal);

}  // namespace slideway
