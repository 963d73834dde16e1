#include <algorithm>
#include <cmath>

#include "repeats.hpp"
#include "slideway/base/distribution.hpp"
#include "slideway/identify/agreement.hpp"
#include "slideway/identify/linear_algebra.hpp"
#include "slideway/identify/noise_model.hpp"

namespace slideway {

Eigen::MatrixXd slow_parts(const Linearisation& linear, const std::vector<Eigen::VectorXd>& of_each,
                           const std::vector<std::size_t>& group, const Gates& gates) {
  const Observation& first = *linear.observations[group.front()];
  std::vector<std::vector<Eigen::Index>> matches;
  for (const std::size_t i : group)
    matches.push_back(matched_values(first, *linear.observations[i], gates));
  std::vector<Eigen::Index> rows;
  for (Eigen::Index row = 0; row < first.values.size(); ++row)
    if (std::ranges::all_of(matches, [&](const auto& match) { return match[row] >= 0; }))
      rows.push_back(row);
  Eigen::MatrixXd parts(std::ssize(rows), std::ssize(group));
  for (std::size_t k = 0; k < group.size(); ++k)
    for (std::size_t r = 0; r < rows.size(); ++r)
      parts(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(k)) =
          of_each[group[k]][matches[k][rows[r]]];
  const Eigen::MatrixXd levelling = orthonormal(first.nuisances(rows, Eigen::all));
  Gates finer = gates;
  finer.values_per_cosine = gates.values_per_repeated_cosine;
  Eigen::MatrixXd cosines =
      slow_cosines(std::ssize(rows), slow_cosine_count(std::ssize(rows), finer));
  project_out(levelling, cosines);
  return orthonormal(std::move(cosines)).transpose() * parts;
}

RepeatBeside::RepeatBeside(const Eigen::MatrixXd& parts, Eigen::Index which, double factor)
    : off(parts.rows(), parts.cols()) {
  const auto count = static_cast<double>(parts.cols());
  const Eigen::VectorXd mean = (parts.rowwise().sum() - parts.col(which)) / (count - 1.0);
  off.col(0) = std::sqrt((count - 1.0) / count) * (factor * parts.col(which) - mean);
  for (Eigen::Index k = 0, next = 1; k < parts.cols(); ++k)
    if (k != which) off.col(next++) = parts.col(k) - mean;
}

double freedom_of(const Eigen::MatrixXd& deviations) {
  Eigen::VectorXd spectrum = deviations.rowwise().squaredNorm();
  for (Eigen::Index first = 0, count = 1; first < spectrum.size(); first += count, count *= 2) {
    auto octave = spectrum.segment(first, std::min(count, spectrum.size() - first));
    octave.setConstant(octave.mean());
  }
  return std::pow(spectrum.sum(), 2) / spectrum.squaredNorm();
}

namespace {

/// Probability that noise makes one of m repeats differ as much from the others. Both mean squares
/// have the spectrum of the noise. All repeats show it, this one too: two others alone would now
/// and then show less of a slow noise than there is.
double probability_beside(const Eigen::MatrixXd& parts, Eigen::Index which) {
  const RepeatBeside beside(parts, which);
  const auto others = static_cast<double>(parts.cols() - 2);
  const double expected = beside.others() / others;
  if (!(expected > 0.0)) return beside.own() > 0.0 ? 0.0 : 1.0;
  const double freedom = freedom_of(parts.colwise() - parts.rowwise().mean());
  const double rest = others * freedom;
  return beta_share(0.5 * rest, 0.5 * freedom, rest / (rest + freedom * beside.own() / expected));
}

}  // namespace

double probability_beside_repeats(const Linearisation& linear, std::size_t profile,
                                  const Gates& gates) {
  std::vector<std::size_t> group{profile};
  for (std::size_t i = 0; i < linear.observations.size(); ++i)
    if (i != profile && are_repeats(*linear.observations[profile], *linear.observations[i], gates))
      group.push_back(i);
  if (group.size() < kLeastRepeats) return 1.0;
  const Eigen::MatrixXd parts = slow_parts(linear, linear.residuals, group, gates);
  return parts.rows() == 0 ? 1.0 : probability_beside(parts, 0);
}

std::vector<OddRepeat> odd_repeats(const Linearisation& linear, const Gates& gates) {
  std::vector<OddRepeat> out;
  for (std::vector<std::size_t> group : repeat_groups(linear, gates)) {
    while (group.size() >= kLeastRepeats) {
      const Eigen::MatrixXd parts = slow_parts(linear, linear.residuals, group, gates);
      if (parts.rows() == 0) break;
      OddRepeat odd;
      Eigen::Index which = 0;
      for (Eigen::Index k = 0; k < parts.cols(); ++k) {
        const double p =
            std::min(1.0, static_cast<double>(parts.cols()) * probability_beside(parts, k));
        if (p < odd.p_value) odd = {group[static_cast<std::size_t>(k)], p}, which = k;
      }
      if (!(odd.p_value < gates.disagreement_p)) break;
      out.push_back(odd);
      group.erase(group.begin() + which);
    }
  }
  return out;
}

}  // namespace slideway
