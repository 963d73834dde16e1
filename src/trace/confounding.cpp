#include "slideway/trace/confounding.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "dictionary.hpp"
#include "slideway/base/parallel.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/identify/solve.hpp"

namespace slideway {
namespace {

constexpr double kTaken = 1e-6;  // of a column: what levelling leaves of one that it can make
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

/// A candidate of all profiles, levelled.
struct Rival {
  const Candidate* candidate;
  Eigen::MatrixXd columns;
};

Lookalike held_against(const std::vector<Stretch>& all, const Rival& rival,
                       const Eigen::VectorXd& y) {
  const Eigen::Index amplitudes = rival.candidate->amplitudes();
  Lookalike out{rival.candidate->effect_name(), largest_share(rival.columns, amplitudes, y), 0.0,
                ""};
  for (const Stretch& rows : all) {
    const double alone = largest_share(rival.columns.middleRows(rows.first, rows.count), amplitudes,
                                       y.segment(rows.first, rows.count));
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

/// Of the effects of these names, in order.
std::vector<Confounding> confounding_of(const Problem& problem,
                                        const std::vector<Profile>& profiles,
                                        const std::vector<std::string>& effects) {
  Problem bare = problem;
  bare.effects.clear();
  bare.trace.candidates = effect_names();
  bare.trace.own = problem.own_effects;
  const Model model = build_model(bare, profiles);
  const Dictionary dictionary = make_dictionary(model, bare, 0);
  const std::vector<Stretch> all = stretches_of(model);
  std::vector<Rival> whole;
  for (const Candidate& candidate : dictionary.candidates)
    if (candidate.stands_for_effect())
      whole.push_back({&candidate, levelled(all, *candidate.columns)});
  std::vector<Confounding> out;
  for (const std::string& effect : effects) {
    Confounding& confounding = out.emplace_back(Confounding{effect, "", {}});
    const auto untestable = std::ranges::find(dictionary.not_testable, effect, &Untestable::effect);
    if (untestable != dictionary.not_testable.end()) confounding.needs = untestable->needs;
    const auto at = std::ranges::find_if(
        whole, [&](const Rival& each) { return each.candidate->effect_name() == effect; });
    if (at == whole.end()) continue;
    const Candidate& asked = *at->candidate;
    const Eigen::VectorXd raw = stacked_columns(model, asked.term, asked.grid.middle(), 0).col(0);
    const Eigen::VectorXd y = levelled(all, raw);
    if (!(y.norm() > kTaken * raw.norm())) continue;
    std::vector<Lookalike> lookalikes(whole.size());
    parallel_for(whole.size(), [&](std::size_t i) {
      if (whole[i].candidate->effect_name() != effect)
        lookalikes[i] = held_against(all, whole[i], y);
    });
    confounding.lookalikes = sorted(std::move(lookalikes));
  }
  return out;
}

std::vector<std::string> own_names(const Problem& problem) {
  std::vector<std::string> names;
  for (const DeclaredEffect& own : problem.own_effects) names.push_back(own.name);
  return names;
}

}  // namespace

std::vector<Confounding> confounding_of(const Problem& problem,
                                        const std::vector<Profile>& profiles) {
  return confounding_of(problem, profiles, own_names(problem));
}

std::vector<Confounding> confounding_of_all(const Problem& problem,
                                            const std::vector<Profile>& profiles) {
  std::vector<std::string> names = effect_names();
  std::ranges::move(own_names(problem), std::back_inserter(names));
  return confounding_of(problem, profiles, names);
}

}  // namespace slideway
