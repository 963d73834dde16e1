#include "search.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <thread>

#include "slideway/base/distribution.hpp"
#include "slideway/base/parallel.hpp"

namespace slideway {
namespace {

/// Part of a column's square outside the model below which it is the model's own (b_2 and cup).
constexpr double kSpanned = 1e-9;
constexpr Eigen::Index kColumnsAtATime = 64;

/// Pseudo-inverse square root of a Gram matrix scaled by the columns' sizes before projection:
/// |R c|² is the gain of products c.
struct GramRoot {
  Eigen::MatrixXd root;  // rank by a
  Eigen::Index rank = 0;
};

GramRoot root_of(const Eigen::MatrixXd& gram, const Eigen::VectorXd& squares) {
  const Eigen::VectorXd unit =
      squares.unaryExpr([](double s) { return s > 0.0 ? 1.0 / std::sqrt(s) : 0.0; });
  GramRoot out;
  if (gram.cols() == 1) {
    out.rank = gram(0, 0) > kSpanned * squares[0] ? 1 : 0;
    out.root = Eigen::MatrixXd::Constant(out.rank, 1, 0.0);
    if (out.rank == 1) out.root(0, 0) = 1.0 / std::sqrt(gram(0, 0));
    return out;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(unit.asDiagonal() * gram *
                                                             unit.asDiagonal());
  out.rank = (eigen.eigenvalues().array() > kSpanned).count();
  out.root = eigen.eigenvalues().tail(out.rank).cwiseSqrt().cwiseInverse().asDiagonal() *
             eigen.eigenvectors().rightCols(out.rank).transpose() * unit.asDiagonal();
  return out;
}

/// What columns show in one profile, or in several together: the sums.
struct InProfiles {
  Eigen::MatrixXd grams;     // of each atom, side by side, without what is free in a profile alone
  Eigen::MatrixXd shared;    // products with what is free in profiles together
  Eigen::VectorXd squares;   // of the white columns
  Eigen::MatrixXd products;  // with every residual

  InProfiles& operator+=(const InProfiles& other) {
    grams += other.grams, shared += other.shared;
    squares += other.squares, products += other.products;
    return *this;
  }
};

/// In single precision, of columns made one long: a power of x may exceed its range.
Eigen::MatrixXd products_of(const Eigen::MatrixXd& columns, const Eigen::VectorXd& squares,
                            const Eigen::Ref<const Eigen::MatrixXf>& residuals) {
  const Eigen::VectorXd sizes = squares.cwiseSqrt();
  const Eigen::MatrixXf unit =
      (columns * sizes.unaryExpr([](double s) { return s > 0.0 ? 1.0 / s : 0.0; }).asDiagonal())
          .cast<float>();
  return sizes.asDiagonal() * Eigen::MatrixXf(unit.transpose() * residuals).cast<double>();
}

Eigen::MatrixXd products_of(const Eigen::MatrixXd& columns, const Eigen::VectorXd&,
                            const Eigen::Ref<const Eigen::MatrixXd>& residuals) {
  return columns.transpose() * residuals;
}

/// @param a          columns an atom
/// @param residuals  of all profiles; the products have their precision
template <typename Residuals>
InProfiles in_profile(const Whitened& data, std::size_t profile, Eigen::MatrixXd columns,
                      Eigen::Index a, const Residuals& residuals) {
  const Whitened::Seen seen = data.seen_in(profile, std::move(columns));
  const Eigen::MatrixXd& white = seen.white;
  InProfiles out{.grams = Eigen::MatrixXd(a, white.cols()),
                 .shared = seen.shared,
                 .squares = white.colwise().squaredNorm().transpose(),
                 .products = {}};
  for (Eigen::Index at = 0; at < white.cols(); at += a) {
    const auto atom = white.middleCols(at, a), own = seen.own.middleCols(at, a);
    out.grams.middleCols(at, a) = atom.transpose() * atom - own.transpose() * own;
  }
  out.products = products_of(white, out.squares,
                             residuals.middleRows(data.first_row(profile), data.count(profile)));
  return out;
}

/// The fitted observations a candidate acts on.
std::vector<std::size_t> profiles_of(const Whitened& data, const Candidate& candidate) {
  if (!candidate.part.empty()) return candidate.part;
  std::vector<std::size_t> all(data.observations());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

/// Candidates of the same columns, each in some profiles: what a profile shows is made once.
using Family = std::vector<std::size_t>;

std::vector<Family> families_of(const Candidates& candidates) {
  std::vector<Family> out;
  std::map<const Eigen::MatrixXd*, std::size_t> place;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    const auto [at, is_new] = place.try_emplace(candidates[c]->columns.get(), out.size());
    if (is_new) out.emplace_back();
    out[at->second].push_back(c);
  }
  return out;
}

/// Atoms of a family.
struct Block {
  const Family* family;
  Eigen::Index first, count;
};

/// Calls use(candidate, atom, root, products of its columns with every residual) for the atoms of
/// one block.
template <typename Residuals, typename Use>
void for_block(const Whitened& data, const Candidates& candidates, const Block& block,
               const Residuals& residuals, Use&& use) {
  const Candidate& any = *candidates[block.family->front()];
  const Eigen::Index a = any.amplitudes();
  std::vector<std::optional<InProfiles>> shown(data.observations());
  for (const std::size_t c : *block.family) {
    std::optional<InProfiles> sum;
    for (const std::size_t i : profiles_of(data, *candidates[c])) {
      if (!shown[i])
        shown[i] = in_profile(
            data, i,
            any.columns->block(data.first_row(i), block.first * a, data.count(i), block.count * a),
            a, residuals);
      if (sum)
        *sum += *shown[i];
      else
        sum = shown[i];
    }
    if (!sum) continue;
    for (Eigen::Index j = 0; j < block.count; ++j) {
      const auto shared = sum->shared.middleCols(j * a, a);
      const Eigen::MatrixXd gram = sum->grams.middleCols(j * a, a) - shared.transpose() * shared;
      use(c, block.first + j, root_of(gram, sum->squares.segment(j * a, a)),
          sum->products.middleRows(j * a, a));
    }
  }
}

/// @param squares  of the columns, before what the model spans was taken out
Projection solved(Projection normal, const Eigen::VectorXd& squares) {
  const GramRoot root = root_of(normal.gram, squares);
  normal.rank = root.rank;
  normal.amplitudes = root.root.transpose() * (root.root * normal.products);
  normal.gain = (root.root * normal.products).squaredNorm();
  return normal;
}

std::vector<Block> blocks_of(const Candidates& candidates, const std::vector<Family>& families) {
  std::vector<Block> out;
  for (const Family& family : families) {
    const Candidate& any = *candidates[family.front()];
    const Eigen::Index most = std::max<Eigen::Index>(1, kColumnsAtATime / any.amplitudes());
    for (Eigen::Index first = 0; first < any.atoms(); first += most)
      out.push_back({&family, first, std::min(most, any.atoms() - first)});
  }
  return out;
}

/// Whether the readings do not carry every term of a higher degree: it would only be undetermined.
bool lacks_terms(const Candidate& candidate, Eigen::Index rank) {
  return candidate.raises_degree && rank < candidate.amplitudes();
}

}  // namespace

double penalty(const Whitened& data, Eigen::Index unknowns) {
  return static_cast<double>(unknowns) * std::log(static_cast<double>(data.values()));
}

double penalty(const Whitened& data, const Candidate& candidate, Eigen::Index rank) {
  return penalty(data, candidate.unknowns(rank)) + candidate.choice;
}

Priority priority_of(const Candidate& candidate, double delta_bic) {
  constexpr double kStep = 0.1;  // of a difference in BIC: that of one optimum found twice
  const std::vector<Parameter>& parameters = candidate.term.effect->parameters();
  const auto first = std::ranges::min_element(parameters, {}, &Parameter::gauge);
  return {std::round(delta_bic / kStep), first == parameters.end() ? 0 : first->gauge};
}

void sort_by_priority(std::vector<Finding>& findings) {
  std::ranges::stable_sort(findings, {}, [](const Finding& each) {
    return priority_of(*each.candidate, each.delta_bic);
  });
}

std::vector<Finding> search(const Whitened& data, const Candidates& candidates) {
  const std::vector<Family> families = families_of(candidates);
  const std::vector<Block> blocks = blocks_of(candidates, families);
  std::vector<std::map<std::size_t, Finding>> best(blocks.size());  // by candidate
  parallel_for(blocks.size(), [&](std::size_t b) {
    for_block(data, candidates, blocks[b], data.residual(),
              [&](std::size_t c, Eigen::Index atom, const GramRoot& root, const auto& products) {
                const double gain = (root.root * products).squaredNorm();
                const double bic = penalty(data, *candidates[c], root.rank) - gain;
                const Finding found{candidates[c], atom, gain, bic, root.rank};
                if (root.rank == 0 || lacks_terms(*candidates[c], root.rank)) return;
                const auto [at, is_first] = best[b].try_emplace(c, found);
                if (bic < at->second.delta_bic) at->second = found;
              });
  });
  std::vector<Finding> out;
  for (const Candidate* candidate : candidates) out.push_back({candidate, 0, 0.0, INFINITY, 0});
  for (const auto& of_block : best)
    for (const auto& [c, found] : of_block)
      if (found.delta_bic < out[c].delta_bic) out[c] = found;
  return out;
}

double noise_beside_line(const Whitened& data, const Finding& line, const Eigen::VectorXd& rest,
                         const Gates& gates) {
  constexpr Eigen::Index kNearest = 6, kFarthest = 30;  // atoms: 2 to 10 cycles over the reading
  constexpr double kAtomsACycle = 3.0, kFewest = 6.0;   // cycles
  const Candidate& candidate = *line.candidate;
  if (candidate.grid.axes().size() != 1) return 1.0;
  double sum = 0.0, amplitudes = 0.0, atoms = 0.0;
  const auto add = [&](Eigen::Index first, Eigen::Index end) {
    first = std::max<Eigen::Index>(first, 0), end = std::min(end, candidate.atoms());
    if (first >= end) return;
    const Family alone{0};
    for_block(data, {&candidate}, {&alone, first, end - first}, rest,
              [&](std::size_t, Eigen::Index, const GramRoot& root, const auto& products) {
                sum += (root.root * products).squaredNorm();
                amplitudes += static_cast<double>(root.rank);
                atoms += 1.0;
              });
  };
  add(line.atom - kFarthest, line.atom - kNearest + 1);
  add(line.atom + kNearest, line.atom + kFarthest + 1);
  if (atoms < kFewest * kAtomsACycle || amplitudes == 0.0) return 1.0;
  const double freedom = amplitudes / kAtomsACycle, level = sum / amplitudes;
  return chi_squared_tail(freedom, freedom * level) < gates.significance ? level : 1.0;
}

Projection project(const Whitened& data, const Eigen::MatrixXd& columns) {
  const auto in = [&](std::size_t i) {
    return in_profile(data, i, columns.middleRows(data.first_row(i), data.count(i)), columns.cols(),
                      data.residual());
  };
  InProfiles sum = in(0);
  for (std::size_t i = 1; i < data.observations(); ++i) sum += in(i);
  return solved({.gram = sum.grams - sum.shared.transpose() * sum.shared, .products = sum.products},
                sum.squares);
}

Projection project_in(const Whitened& data, std::size_t profile, const Eigen::MatrixXd& columns) {
  const Whitened::Shown shown = data.shown_in(profile, columns);
  return solved(
      {.gram = shown.gram - shown.shared.transpose() * shown.shared, .products = shown.products},
      shown.gram.diagonal());
}

Eigen::MatrixXd left_beside(const Whitened& data, const Candidate& candidate,
                            const Eigen::MatrixXd& outside) {
  const std::vector<Family> alone{{0}};
  const Eigen::RowVectorXd squares = outside.colwise().squaredNorm();
  Eigen::MatrixXd out(outside.cols(), candidate.atoms());
  for (const Block& block : blocks_of({&candidate}, alone))
    for_block(data, {&candidate}, block, outside,
              [&](std::size_t, Eigen::Index atom, const GramRoot& root, const auto& products) {
                out.col(atom) =
                    (squares - (root.root * products).colwise().squaredNorm()).transpose();
              });
  return out;
}

Eigen::VectorXd largest_gains(const Whitened& data, const Candidates& candidates,
                              const Eigen::MatrixXf& residuals,
                              const std::function<void(double)>& told) {
  const std::vector<Family> families = families_of(candidates);
  const std::vector<Block> blocks = blocks_of(candidates, families);
  const std::thread::id caller = std::this_thread::get_id();
  Eigen::MatrixXd best = Eigen::MatrixXd::Constant(residuals.cols(), blocks.size(), -INFINITY);
  parallel_for(blocks.size(), [&](std::size_t b) {
    if (told && std::this_thread::get_id() == caller)
      told(static_cast<double>(b) / static_cast<double>(blocks.size()));
    for_block(
        data, candidates, blocks[b], residuals,
        [&](std::size_t c, Eigen::Index, const GramRoot& root, const auto& products) {
          if (root.rank == 0) return;
          const double cost = penalty(data, *candidates[c], root.rank);
          best.col(b) = best.col(b).cwiseMax(
              ((root.root * products).colwise().squaredNorm().array() - cost).matrix().transpose());
        });
  });
  if (told) told(1.0);
  return best.rowwise().maxCoeff();
}

}  // namespace slideway
