#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "slideway/identify/fit.hpp"
#include "slideway/identify/model.hpp"

namespace slideway {

/// An effect as a curve: rows that are multiplied with (amplitudes, shapes).
struct ComparedCurve {
  std::string what;
  Eigen::MatrixXd rows;
  bool of_slide = false;
};

/// Every effect of the model as a curve of profile `a` and, for the slide, the travel `a` and `b`
/// have in common. Not of effects of which each cut has its own size.
[[nodiscard]] std::vector<ComparedCurve> compared_curves(const Model& model, const Solution& fit,
                                                         std::size_t a, std::size_t b);

/// (Amplitudes, shapes) of the effects of which each cut has its own size: those say nothing of
/// whether cuts agree.
[[nodiscard]] std::vector<Eigen::Index> columns_of_each_cut(const Model& model,
                                                            const Solution& fit);

}  // namespace slideway
