#pragma once

#include "slideway/identify/model.hpp"
#include "slideway/identify/result.hpp"

namespace slideway {

/// Holds the squareness of the fit against the run-out measurement of Eq. (21), θ = (r + p) / L, as
/// an E_n number: |difference| / sqrt(U_fit² + U_indirect²), consistent up to 1.
///
/// A run-out tells the size of the angle, not its sign: the magnitudes are compared.
SquarenessCheck check_squareness(const Model& model, const std::optional<Runout>& runout,
                                 const ModelResult& fit);

}  // namespace slideway
