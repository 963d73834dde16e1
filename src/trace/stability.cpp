#include "stability.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "other_level.hpp"
#include "slideway/base/parallel.hpp"
#include "slideway/base/random.hpp"
#include "slideway/identify/linear_algebra.hpp"

namespace slideway {
namespace {

constexpr std::size_t kMostProfiles = 8;     // that are left out in turn
constexpr Eigen::Index kBlocks[] = {16, 8};  // of a profile
constexpr int kNoiseDraws = 8;               // of the noise
constexpr std::uint64_t kStabilitySeed = 19790615;
constexpr double kShown = 0.5;  // of the effect's square in one profile: the others show too little

using Rows = std::vector<Eigen::Index>;

/// The white columns of every candidate of a search, side by side.
class Choice {
 public:
  explicit Choice(const SearchRound& round) : round_(round) {
    const Whitened& data = round.data;
    Eigen::Index count = 0;
    for (const TestedCandidate& each : round.tested) {
      first_.push_back(count);
      count += each.refined.columns.cols();
    }
    first_.push_back(count);
    columns_.resize(data.rows(), count);
    for (std::size_t c = 0; c < round.tested.size(); ++c)
      columns_.middleCols(first_[c], first_[c + 1] - first_[c]) = round.tested[c].refined.columns;
    data.whiten(columns_);
  }

  /// Name of the candidate of least BIC in these rows of the data, the effect's own if none is
  /// better by more than a tie; kNothing: none pays. Gains are those of as many rows as all: a part
  /// differs by what it shows, not by being small.
  [[nodiscard]] std::string in(const Eigen::VectorXd& residual, const Rows& rows,
                               const std::string& own_name, double tie) const {
    Eigen::MatrixXd columns(std::ssize(rows), columns_.cols() + 1);
    columns << columns_(rows, Eigen::all), residual(rows);
    const Eigen::VectorXd before = columns.colwise().norm();
    columns = round_.data.outside_in(rows, std::move(columns));
    clear_rounding(columns, before);
    const auto rest = columns.rightCols(1);
    const auto count = static_cast<double>(residual.size());
    const double log_count = std::log(count), to_all = count / static_cast<double>(rows.size());
    Ballot ballot(own_name);
    for (std::size_t c = 0; c < round_.tested.size(); ++c) {
      const Refined& refined = round_.tested[c].refined;
      if (!round_.tested[c].is_possible()) continue;
      const Eigen::MatrixXd own =
          orthonormal(columns.middleCols(first_[c], first_[c + 1] - first_[c]));
      const double bic =
          static_cast<double>(refined.candidate->unknowns(refined.projection.rank)) * log_count +
          refined.candidate->choice - to_all * (own.transpose() * rest).squaredNorm();
      ballot.add(round_.tested[c].name(), bic);
    }
    return ballot.chosen(tie);
  }

 private:
  const SearchRound& round_;
  Eigen::MatrixXd columns_;
  std::vector<Eigen::Index> first_;
};

/// Rows of all profiles with the priors' below, those of a profile that `keeps` (profile, row of
/// it).
template <typename Keeps>
Rows rows_where(const Whitened& data, Keeps&& keeps) {
  Rows out;
  for (std::size_t i = 0; i < data.observations(); ++i)
    for (Eigen::Index k = 0; k < data.count(i); ++k)
      if (keeps(i, k)) out.push_back(data.first_row(i) + k);
  for (Eigen::Index row = data.values(); row < data.rows(); ++row) out.push_back(row);
  return out;
}

std::vector<Rows> parts_of(const Whitened& data, const Eigen::VectorXd& shown) {
  std::vector<Rows> out;
  const std::size_t profiles = data.observations();
  for (std::size_t i = 0; profiles > 1 && i < std::min(profiles, kMostProfiles); ++i) {
    const double own = shown.segment(data.first_row(i), data.count(i)).squaredNorm();
    if (own > kShown * shown.squaredNorm()) continue;
    out.push_back(rows_where(data, [&](std::size_t p, Eigen::Index) { return p != i; }));
  }
  for (const Eigen::Index blocks : kBlocks)
    for (Eigen::Index half = 0; half < 2; ++half)
      out.push_back(rows_where(data, [&](std::size_t p, Eigen::Index k) {
        return (k * blocks / std::max<Eigen::Index>(data.count(p), 1)) % 2 == half;
      }));
  return out;
}

}  // namespace

Stability stability(const SearchRound& round, const TestedCandidate& effect, const Gates& gates,
                    const FittedModel* fitted) {
  const Choice choice(round);
  const Whitened& data = round.data;
  const std::vector<Rows> parts = parts_of(data, effect.fitted);
  const Rows all = rows_where(data, [](std::size_t, Eigen::Index) { return true; });
  std::vector<std::string> chosen(parts.size() + kNoiseDraws);
  parallel_for(chosen.size(), [&](std::size_t k) {
    if (k < parts.size()) {
      chosen[k] = choice.in(data.residual(), parts[k], effect.name(), gates.tie_bic);
      return;
    }
    RandomStream random(kStabilitySeed + k - parts.size(), "stability");
    Eigen::VectorXd drawn = effect.fitted;
    for (double& value : drawn) value += random.normal();
    chosen[k] = choice.in(drawn, all, effect.name(), gates.tie_bic);
  });
  if (fitted)
    for (std::string& name : chosen_at_other_levels(*fitted, round, effect))
      chosen.push_back(std::move(name));
  const auto is_it = [&](const std::string& name) {
    return std::ranges::any_of(round.tested, [&](const TestedCandidate& each) {
      return each.name() == name &&
             each.refined.candidate->effect_name() == effect.refined.candidate->effect_name();
    });
  };
  Stability out;
  out.share = static_cast<double>(std::ranges::count_if(chosen, is_it)) /
              static_cast<double>(chosen.size());
  std::map<std::string, int> votes;
  for (const std::string& name : chosen)
    if (!is_it(name)) ++votes[name];
  if (!votes.empty())
    out.other = std::ranges::max_element(votes, {}, [](const auto& v) { return v.second; })->first;
  return out;
}

}  // namespace slideway
