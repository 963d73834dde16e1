#include "search.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <thread>
#include <type_traits>

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

/// Products of columns with the rows of residuals that they stand in.
template <typename Columns, typename Residuals>
Columns products_of(std::span<const RowRange> rows, const Columns& columns,
                    const Residuals& residuals) {
  Columns out = Columns::Zero(columns.cols(), residuals.cols());
  Eigen::Index from = 0;
  for (const RowRange& run : rows) {
    out += columns.middleRows(from, run.count).transpose() *
           residuals.middleRows(run.first, run.count);
    from += run.count;
  }
  return out;
}

/// The same in single precision, of columns made one long: a power of x may exceed its range.
Eigen::MatrixXd products_in_single(std::span<const RowRange> rows, const Eigen::MatrixXd& columns,
                                   const Eigen::VectorXd& squares,
                                   const Eigen::MatrixXf& residuals) {
  const Eigen::VectorXd sizes = squares.cwiseSqrt();
  const Eigen::MatrixXf unit =
      (columns * sizes.unaryExpr([](double s) { return s > 0.0 ? 1.0 / s : 0.0; }).asDiagonal())
          .cast<float>();
  return sizes.asDiagonal() * products_of(rows, unit, residuals).cast<double>();
}

/// Calls use(atom, root, products of its columns with every residual) for the atoms of one block.
/// The products have the precision of the residuals.
template <typename Residuals, typename Use>
void for_block(const Whitened& data, const Candidate& candidate, Eigen::Index first,
               Eigen::Index count, const Residuals& residuals, Use&& use) {
  const Eigen::Index a = candidate.amplitudes();
  Eigen::MatrixXd columns = candidate.columns_of(first, count);
  data.whiten(candidate.rows, columns);
  const Eigen::MatrixXd inside = data.inside(candidate.rows, columns);
  const Eigen::VectorXd squares = columns.colwise().squaredNorm().transpose();
  Eigen::MatrixXd products;
  if constexpr (std::is_same_v<Residuals, Eigen::MatrixXf>)
    products = products_in_single(candidate.rows, columns, squares, residuals);
  else
    products = products_of(candidate.rows, columns, residuals);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto own = columns.middleCols(i * a, a);
    const auto spanned = inside.middleCols(i * a, a);
    const Eigen::MatrixXd gram = own.transpose() * own - spanned.transpose() * spanned;
    use(first + i, root_of(gram, squares.segment(i * a, a)), products.middleRows(i * a, a));
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

struct Block {
  std::size_t candidate;
  Eigen::Index first, count;
};

std::vector<Block> blocks_of(const Candidates& candidates) {
  std::vector<Block> out;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    const Eigen::Index most =
        std::max<Eigen::Index>(1, kColumnsAtATime / candidates[c]->amplitudes());
    for (Eigen::Index first = 0; first < candidates[c]->atoms(); first += most)
      out.push_back({c, first, std::min(most, candidates[c]->atoms() - first)});
  }
  return out;
}

}  // namespace

double penalty(const Whitened& data, Eigen::Index unknowns) {
  return static_cast<double>(unknowns) * std::log(static_cast<double>(data.values()));
}

double penalty(const Whitened& data, const Candidate& candidate, Eigen::Index rank) {
  return penalty(data, candidate.unknowns(rank)) + candidate.choice;
}

std::vector<Finding> search(const Whitened& data, const Candidates& candidates) {
  const std::vector<Block> blocks = blocks_of(candidates);
  std::vector<Finding> best(blocks.size());
  parallel_for(blocks.size(), [&](std::size_t b) {
    const Block& block = blocks[b];
    const Candidate& candidate = *candidates[block.candidate];
    best[b] = {&candidate, block.first, -1.0, INFINITY, 0};
    for_block(data, candidate, block.first, block.count, data.residual(),
              [&](Eigen::Index atom, const GramRoot& root, const auto& products) {
                const double gain = (root.root * products).squaredNorm();
                const double bic = penalty(data, candidate, root.rank) - gain;
                if (root.rank > 0 && bic < best[b].delta_bic)
                  best[b] = {&candidate, atom, gain, bic, root.rank};
              });
  });
  std::vector<Finding> out;
  for (const Candidate* candidate : candidates) out.push_back({candidate, 0, 0.0, INFINITY, 0});
  for (std::size_t b = 0; b < blocks.size(); ++b)
    if (best[b].delta_bic < out[blocks[b].candidate].delta_bic) out[blocks[b].candidate] = best[b];
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
    for_block(data, candidate, first, end - first, rest,
              [&](Eigen::Index, const GramRoot& root, const auto& products) {
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
  Eigen::MatrixXd white = columns;
  data.whiten(white);
  const Eigen::MatrixXd inside = data.inside({{RowRange{0, data.rows()}}}, white);
  return solved({.gram = white.transpose() * white - inside.transpose() * inside,
                 .products = white.transpose() * data.residual()},
                white.colwise().squaredNorm().transpose());
}

Projection project_in(const Whitened& data, std::size_t profile, const Eigen::MatrixXd& columns) {
  const Whitened::Shown shown = data.shown_in(profile, columns);
  return solved(
      {.gram = shown.gram - shown.shared.transpose() * shown.shared, .products = shown.products},
      shown.gram.diagonal());
}

Eigen::VectorXd largest_gains(const Whitened& data, const Candidates& candidates,
                              const Eigen::MatrixXf& residuals,
                              const std::function<void(double)>& told) {
  const std::vector<Block> blocks = blocks_of(candidates);
  const std::thread::id caller = std::this_thread::get_id();
  Eigen::MatrixXd best = Eigen::MatrixXd::Constant(residuals.cols(), blocks.size(), -INFINITY);
  parallel_for(blocks.size(), [&](std::size_t b) {
    if (told && std::this_thread::get_id() == caller)
      told(static_cast<double>(b) / static_cast<double>(blocks.size()));
    const Candidate& candidate = *candidates[blocks[b].candidate];
    for_block(
        data, candidate, blocks[b].first, blocks[b].count, residuals,
        [&](Eigen::Index, const GramRoot& root, const auto& products) {
          if (root.rank == 0) return;
          const double cost = penalty(data, candidate, root.rank);
          best.col(b) = best.col(b).cwiseMax(
              ((root.root * products).colwise().squaredNorm().array() - cost).matrix().transpose());
        });
  });
  if (told) told(1.0);
  return best.rowwise().maxCoeff();
}

}  // namespace slideway
