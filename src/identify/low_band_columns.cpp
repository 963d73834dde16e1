#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "slideway/identify/model.hpp"
#include "slideway/signal/low_band_parts.hpp"

namespace slideway {
namespace {

// Samples whose columns stay in the cache: no power of two, by which all would share its lines.
constexpr Eigen::Index kBlock = 500;

Stations part_of(const Profile& profile, const Machine& machine, Eigen::Index first,
                 Eigen::Index count) {
  const std::span<const double> positions = profile.positions;
  return {positions.subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(count)),
          profile.setup, machine};
}

}  // namespace

double low_band_scale(const Observation& observation) {
  return std::sqrt(static_cast<double>(observation.low_band.samples()) /
                   static_cast<double>(observation.values.size()));
}

Eigen::MatrixXd low_band_columns(const Model& model, const ModelTerm& term,
                                 const Observation& observation, std::span<const double> shape) {
  const Profile& profile = *observation.profile;
  const Eigen::Index amplitudes = term.effect->amplitudes();
  if (!term.acts_on(profile)) return Eigen::MatrixXd::Zero(observation.values.size(), amplitudes);
  const auto fill = [&](Eigen::Index first, const Eigen::Ref<Eigen::MatrixXd>& rows) {
    term.effect->columns(part_of(profile, model.machine, first, rows.rows()), shape, rows);
  };
  return apply_in_parts(observation.low_band, std::ssize(profile.positions), amplitudes, fill);
}

Eigen::MatrixXd low_band_images(const Model& model, const ModelTerm& term,
                                const std::vector<Prior>& values, const Observation& observation) {
  const Eigen::MatrixXd columns = low_band_columns(model, term, observation, {});
  Eigen::VectorXd of_values(std::ssize(values)), of_uncertainties(std::ssize(values));
  for (std::size_t p = 0; p < values.size(); ++p) {
    const auto k = static_cast<Eigen::Index>(p);
    of_values[k] = values[p].value;
    of_uncertainties[k] = values[p].standard_uncertainty;
  }
  Eigen::MatrixXd out(columns.rows(), 2 * columns.cols());
  out << columns * term.effect->from_parameters(of_values).asDiagonal(),
      columns * term.effect->from_parameters(of_uncertainties).asDiagonal();
  return out;
}

Eigen::MatrixXd low_band_columns_of_shapes(const Model& model, const ModelTerm& term,
                                           const Observation& observation,
                                           std::span<const std::vector<double>> shapes) {
  const Profile& profile = *observation.profile;
  const Eigen::Index count = std::ssize(shapes) * term.effect->amplitudes();
  if (!term.acts_on(profile)) return Eigen::MatrixXd::Zero(observation.values.size(), count);
  const auto fill = [&](Eigen::Index first, Eigen::Ref<Eigen::MatrixXd> rows) {
    term.effect->columns_of_shapes(part_of(profile, model.machine, first, rows.rows()), shapes,
                                   rows);
  };
  return apply_in_parts(observation.low_band, std::ssize(profile.positions), count, fill);
}

namespace {

/// The low band of what `reduce` makes of the derivatives by all shapes: `width` columns a shape.
template <typename Reduce>
Eigen::MatrixXd changes_with_shapes(const Model& model, const ModelTerm& term,
                                    const Observation& observation, std::span<const double> shape,
                                    Eigen::Index width, const Reduce& reduce) {
  const Profile& profile = *observation.profile;
  const Effect& effect = *term.effect;
  const Eigen::Index amplitudes = effect.amplitudes(), shapes = std::ssize(shape);
  if (!term.acts_on(profile))
    return Eigen::MatrixXd::Zero(observation.values.size(), shapes * width);
  const auto fill = [&](Eigen::Index first, Eigen::Ref<Eigen::MatrixXd> rows) {
    Eigen::MatrixXd derivatives;
    for (Eigen::Index done = 0; done < rows.rows(); done += kBlock) {
      const Eigen::Index count = std::min(kBlock, rows.rows() - done);
      derivatives.resize(count, shapes * amplitudes);
      effect.derivatives(part_of(profile, model.machine, first + done, count), shape, derivatives);
      reduce(derivatives, rows.middleRows(done, count));
    }
  };
  Eigen::MatrixXd out =
      apply_in_parts(observation.low_band, std::ssize(profile.positions), shapes * width, fill);
  const double reach = 0.5 * (profile.setup.last_mm - profile.setup.first_mm) /
                       static_cast<double>(observation.values.size());
  for (Eigen::Index s = 0; s < shapes; ++s) {
    if (!effect.shapes()[s].stepwise) continue;
    std::vector<double> below(shape.begin(), shape.end()), above = below;
    below[s] -= reach;
    above[s] += reach;
    Eigen::MatrixXd change = Eigen::MatrixXd::Zero(out.rows(), shapes * amplitudes);
    change.middleCols(s * amplitudes, amplitudes) =
        (low_band_columns(model, term, observation, above) -
         low_band_columns(model, term, observation, below)) /
        (2.0 * reach);
    Eigen::MatrixXd reduced(out.rows(), out.cols());
    reduce(change, reduced);
    out.middleCols(s * width, width) = reduced.middleCols(s * width, width);
  }
  return out;
}

}  // namespace

Eigen::MatrixXd low_band_derivatives(const Model& model, const ModelTerm& term,
                                     const Observation& observation,
                                     std::span<const double> shape) {
  const Eigen::Index amplitudes = term.effect->amplitudes();
  const auto as_they_are = [](const Eigen::MatrixXd& derivatives, Eigen::Ref<Eigen::MatrixXd> out) {
    out = derivatives;
  };
  return changes_with_shapes(model, term, observation, shape, amplitudes, as_they_are);
}

Eigen::MatrixXd low_band_slopes(const Model& model, const ModelTerm& term,
                                const Observation& observation, std::span<const double> shape,
                                const Eigen::VectorXd& amplitudes) {
  const auto of_sum = [&](const Eigen::MatrixXd& derivatives, Eigen::Ref<Eigen::MatrixXd> out) {
    for (Eigen::Index s = 0; s < out.cols(); ++s)
      out.col(s).noalias() =
          derivatives.middleCols(s * amplitudes.size(), amplitudes.size()) * amplitudes;
  };
  return changes_with_shapes(model, term, observation, shape, 1, of_sum);
}

void effect_signal(const Model& model, const ModelTerm& term, const Profile& profile,
                   const Eigen::VectorXd& amplitudes, std::span<const double> shape,
                   Eigen::Index first, Eigen::Ref<Eigen::VectorXd> signal) {
  if (!term.acts_on(profile)) return void(signal.setZero());
  Eigen::MatrixXd columns;
  for (Eigen::Index done = 0; done < signal.size(); done += kBlock) {
    const Eigen::Index count = std::min(kBlock, signal.size() - done);
    columns.resize(count, term.effect->amplitudes());
    term.effect->columns(part_of(profile, model.machine, first + done, count), shape, columns);
    signal.segment(done, count).noalias() = columns * amplitudes;
  }
}

Eigen::VectorXd effect_signal(const Model& model, const ModelTerm& term, const Profile& profile,
                              const Eigen::VectorXd& amplitudes, std::span<const double> shape) {
  Eigen::VectorXd signal(std::ssize(profile.positions));
  effect_signal(model, term, profile, amplitudes, shape, 0, signal);
  return signal;
}

}  // namespace slideway
