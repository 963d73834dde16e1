#include "widening.hpp"

#include <algorithm>
#include <cmath>

#include "response.hpp"
#include "slideway/identify/linear_algebra.hpp"

namespace slideway {
namespace {

Eigen::VectorXd amplitudes_of(const ModelTerm& term, const Estimate& estimate) {
  return estimate.amplitudes.segment(term.first_amplitude, term.effect->amplitudes());
}

Eigen::VectorXd own_shapes(const ModelTerm& term, const Estimate& estimate) {
  return estimate.shapes.segment(term.first_shape, std::ssize(term.effect->shapes()));
}

/// What is moved of the numbers of `without`, as changes of those of `fitted`, a column each.
Eigen::MatrixXd carried(const FittedModel& fitted, const FittedModel& without,
                        const Eigen::MatrixXd& moved) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(fitted.fit.linear.prior_rows.cols(), moved.cols());
  const auto copy = [&](Eigen::Index to, Eigen::Index from, Eigen::Index count) {
    out.middleRows(to, count) = moved.middleRows(from, count);
  };
  for (const ModelTerm& term : fitted.model.terms) {
    const auto other = std::ranges::find(without.model.terms, term.name, &ModelTerm::name);
    if (other == without.model.terms.end()) continue;
    copy(term.first_amplitude, other->first_amplitude,
         std::min(term.effect->amplitudes(), other->effect->amplitudes()));
    copy(fitted.model.amplitudes() + term.first_shape,
         without.model.amplitudes() + other->first_shape,
         std::min(std::ssize(term.effect->shapes()), std::ssize(other->effect->shapes())));
  }
  return out;
}

/// Change of the numbers of a model if it were another one, which lacks one of its effects, and
/// what is moved there by what takes its place, a column each.
Eigen::MatrixXd differences(const FittedModel& fitted, const FittedModel& without,
                            const Eigen::MatrixXd& moved) {
  Eigen::MatrixXd out = -carried(fitted, without, moved);
  const auto change = [&](Eigen::Index to, const Eigen::VectorXd& now,
                          const Eigen::VectorXd& then) {
    out.middleRows(to, now.size()).colwise() -= now;
    const Eigen::Index common = std::min(now.size(), then.size());
    out.middleRows(to, common).colwise() += then.head(common);
  };
  for (const ModelTerm& term : fitted.model.terms) {
    const auto other = std::ranges::find(without.model.terms, term.name, &ModelTerm::name);
    if (other == without.model.terms.end()) continue;
    change(term.first_amplitude, amplitudes_of(term, fitted.fit.estimate),
           amplitudes_of(*other, without.fit.estimate));
    change(fitted.model.amplitudes() + term.first_shape, own_shapes(term, fitted.fit.estimate),
           own_shapes(*other, without.fit.estimate));
  }
  return out;
}

constexpr double kEffectOverReadings = 2.0;  // others of the model may take half of an effect

/// By how much signals, a column each, are to be made smaller to be no larger together than so many
/// times the levelled readings of any profile: what is larger hides behind the model by coincidence
/// alone.
double share_within_readings(const Linearisation& linear, const Eigen::MatrixXd& signals,
                             double most = 1.0) {
  double share = 1.0;
  Eigen::Index row = 0;
  for (const Observation* observation : linear.observations) {
    const Eigen::MatrixXd own = signals.middleRows(row, observation->values.size());
    row += own.rows();
    const double size = levelled(*observation, own).norm();
    if (size > 0.0)
      share = std::min(share, most * levelled(*observation, observation->values).norm() / size);
  }
  return share;
}

/// The same, for the model's changes by them to be no larger than so many times what it leaves.
double share_that_hides(const Solution& fit, const Eigen::MatrixXd& changes, double most) {
  double hidden = 0.0, left = 0.0;
  for (std::size_t i = 0; i < fit.noise.size(); ++i) {
    const Observation& observation = *fit.linear.observations[i];
    const auto in_noise = [&](const Eigen::MatrixXd& columns) {
      return (levelled(observation, columns) / fit.noise[i].standard_deviation()).squaredNorm();
    };
    hidden += in_noise(fit.linear.columns[i] * changes);
    left += in_noise(fit.linear.residuals[i]);
  }
  return hidden > most * most * left ? most * std::sqrt(left / hidden) : 1.0;
}

/// What a candidate makes in the readings.
Eigen::VectorXd signal_of(const Linearisation& linear, const Refined& refined) {
  const Eigen::VectorXd signal = refined.columns * refined.projection.amplitudes;
  return share_within_readings(linear, signal, kEffectOverReadings) * signal;
}

}  // namespace

void Widening::add(const Eigen::MatrixXd& more) { append_columns(changes, more); }

void Widening::add_absence(const FittedModel& fitted, const FittedModel& without) {
  add(differences(fitted, without, Eigen::VectorXd::Zero(without.fit.linear.prior_rows.cols())));
}

void Widening::add_rivals(const FittedModel& fitted, const FittedModel& without,
                          const std::vector<const TestedCandidate*>& rivals) {
  if (rivals.empty()) return;
  Eigen::MatrixXd signals(rivals.front()->refined.columns.rows(), std::ssize(rivals));
  for (std::size_t j = 0; j < rivals.size(); ++j)
    signals.col(static_cast<Eigen::Index>(j)) = signal_of(without.fit.linear, rivals[j]->refined);
  add(differences(fitted, without, response(without.fit, signals)));
  for (const TestedCandidate* rival : rivals) add_bend(fitted, without, rival->refined);
}

void Widening::add_bend(const FittedModel& fitted, const FittedModel& without,
                        const Refined& rival) {
  Departures by = rival.candidate->term.effect->departures();
  if (!by.of_law) return;
  ModelTerm term = rival.candidate->term;
  for (std::unique_ptr<Effect>& part : by.parts) {
    term.effect = std::move(part);
    const Eigen::MatrixXd bend =
        fitted.model.gates.drift_bend * rival.projection.amplitudes[0] *
        stacked_columns(without.model, term, rival.shape, without.fit.linear.prior_rows.rows());
    append_columns(process, carried(fitted, without, response(without.fit, bend)));
  }
}

double Widening::variance(const Eigen::RowVectorXd& row) const {
  const double change = changes.cols() > 0 ? (row * changes).cwiseAbs().maxCoeff() : 0.0;
  return (row * process).squaredNorm() + change * change / 3.0;
}

Widening widening(const Model& model, const Solution& fit, const Structure& structure,
                  const std::vector<TestedCandidate>& refused) {
  Widening out(fit.linear.prior_rows.cols());
  const Eigen::MatrixXd process = stack(fit.linear, structure.columns[0].cols(),
                                        [&](std::size_t i) { return structure.columns[i]; }) *
                                  structure.process.sizes.asDiagonal();
  const Eigen::MatrixXd moved = response(fit, process);
  out.process = std::min(share_within_readings(fit.linear, process),
                         share_that_hides(fit, moved, model.gates.most_hidden)) *
                moved;
  for (const TestedCandidate& each : refused) {
    if (each.refined.delta_bic > -model.gates.delta_bic || !each.is_possible()) continue;
    out.add(response(fit, signal_of(fit.linear, each.refined)));
  }
  return out;
}

}  // namespace slideway
