#pragma once

#include <Eigen/Core>
#include <functional>

#include "slideway/signal/low_band.hpp"

namespace slideway {

/// Columns of rows.rows() samples from `first` on. Called from several threads at once.
using FillColumns = std::function<void(Eigen::Index first, Eigen::Ref<Eigen::MatrixXd> rows)>;

/// low_band.apply() on `count` columns of `samples` values, which `fill` makes a part at a time, so
/// that memory does not grow with the samples and all is done while a part is in the cache. The
/// same to the last bit as on the whole columns, which are made where the ends of the boundary know
/// of one another (periodic ones, antireflect).
Eigen::MatrixXd apply_in_parts(const LowBand& low_band, Eigen::Index samples, Eigen::Index count,
                               const FillColumns& fill);

}  // namespace slideway
