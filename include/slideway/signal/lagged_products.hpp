#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

namespace slideway {

/// Σ_t x_t y_(t+k) for k = first ... first + count - 1, over all t for which both exist.
/// REQUIRES x and y of one length.
std::vector<double> lagged_products(std::span<const double> x, std::span<const double> y,
                                    std::ptrdiff_t first, std::size_t count);

/// A matrix as blocks of columns, each with all rows.
using ColumnParts = std::vector<Eigen::Ref<const Eigen::MatrixXd>>;

/// Σ_t x_t' x_(t-k) of a matrix with rows x_t, over t from most_lag on, for k = 0 ... most_lag.
/// REQUIRES 0 <= most_lag <= rows.
std::vector<Eigen::MatrixXd> lagged_grams(const ColumnParts& parts, Eigen::Index most_lag);

}  // namespace slideway
