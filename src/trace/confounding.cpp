#include "slideway/trace/confounding.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "dictionary.hpp"
#include "slideway/base/parallel.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/identify/solve.hpp"

namespace slideway {
namespace {

constexpr double kAlike = 0.9;   // of the square: a lookalike from here on
constexpr double kRidge = 1e-9;  // of a Gram matrix: columns that levelling has taken

/// The rows of one observation among those of all.
struct Stretch {
  const Observation* observation;
  Eigen::Index first, count;
};

std::vector<Stretch> stretches_of(const Model& model) {
  std::vector<Stretch> out;
  Eigen::Index first = 0;
  for (const Observation* observation : fitted_observations(model)) {
    out.push_back({observation, first, observation->values.size()});
    first += observation->values.size();
  }
  return out;
}

Eigen::MatrixXd levelled(const std::vector<Stretch>& all, Eigen::MatrixXd columns) {
  for (const Stretch& rows : all)
    columns.middleRows(rows.first, rows.count) =
        slideway::levelled(*rows.observation, columns.middleRows(rows.first, rows.count));
  return columns;
}

/// The largest share of y that `amplitudes` neighbouring columns make, over all such sets.
double largest_share(const Eigen::MatrixXd& columns, Eigen::Index amplitudes,
                     const Eigen::VectorXd& y) {
  const double size = y.squaredNorm();
  double largest = 0.0;
  for (Eigen::Index j = 0; size > 0.0 && j < columns.cols(); j += amplitudes) {
    const auto set = columns.middleCols(j, amplitudes);
    const Eigen::MatrixXd gram = set.transpose() * set;
    const Eigen::VectorXd product = set.transpose() * y;
    const Eigen::VectorXd scale = gram.diagonal().cwiseSqrt();
    if (!(scale.maxCoeff() > 0.0)) continue;
    const Eigen::VectorXd inverse = (scale.array() > 0.0).select(scale.cwiseInverse(), 0.0);
    Eigen::MatrixXd unit = inverse.asDiagonal() * gram * inverse.asDiagonal();
    unit.diagonal().array() += kRidge;
    const Eigen::VectorXd b = inverse.asDiagonal() * product;
    largest = std::max(largest, b.dot(unit.ldlt().solve(b)) / size);
  }
  return std::min(largest, 1.0);
}

Lookalike held_against(const std::vector<Stretch>& all, const Candidate& rival,
                       const Eigen::VectorXd& y) {
  const Eigen::MatrixXd columns = levelled(all, *rival.columns);
  Lookalike out{rival.effect_name(), largest_share(columns, rival.amplitudes(), y), 0.0, ""};
  for (const Stretch& rows : all) {
    const double alone = largest_share(columns.middleRows(rows.first, rows.count),
                                       rival.amplitudes(), y.segment(rows.first, rows.count));
    if (alone <= out.largest_alone) continue;
    out.largest_alone = alone;
    out.profile = rows.observation->profile->name;
  }
  return out;
}

/// Of several hypotheses about one effect the most alike; falling, and those that matter.
std::vector<Lookalike> sorted(std::vector<Lookalike> all) {
  std::ranges::stable_sort(all, std::ranges::greater(), &Lookalike::share);
  std::vector<Lookalike> out;
  for (Lookalike& each : all)
    if (std::max(each.share, each.largest_alone) >= kAlike &&
        std::ranges::count(out, each.effect, &Lookalike::effect) == 0)
      out.push_back(std::move(each));
  return out;
}

}  // namespace

std::vector<Confounding> confounding_of(const Problem& problem,
                                        const std::vector<Profile>& profiles) {
  Problem bare = problem;
  bare.effects.clear();
  bare.trace.candidates = effect_names();
  bare.trace.own = problem.own_effects;
  const Model model = build_model(bare, profiles);
  const Dictionary dictionary = make_dictionary(model, bare, 0);
  const std::vector<Stretch> all = stretches_of(model);
  std::vector<const Candidate*> whole;
  for (const Candidate& candidate : dictionary.candidates)
    if (candidate.term.profiles.empty()) whole.push_back(&candidate);
  std::vector<Confounding> out;
  for (const DeclaredEffect& own : problem.own_effects) {
    Confounding& confounding = out.emplace_back(Confounding{own.name, "", {}});
    const auto untestable =
        std::ranges::find(dictionary.not_testable, own.name, &Untestable::effect);
    if (untestable != dictionary.not_testable.end()) confounding.needs = untestable->needs;
    const auto at = std::ranges::find_if(
        whole, [&](const Candidate* each) { return each->effect_name() == own.name; });
    if (at == whole.end()) continue;
    const Eigen::MatrixXd columns =
        levelled(all, stacked_columns(model, (*at)->term, (*at)->grid.middle(), 0));
    std::vector<Lookalike> lookalikes(whole.size());
    parallel_for(whole.size(), [&](std::size_t i) {
      if (whole[i] != *at) lookalikes[i] = held_against(all, *whole[i], columns.col(0));
    });
    confounding.lookalikes = sorted(std::move(lookalikes));
  }
  return out;
}

}  // namespace slideway
