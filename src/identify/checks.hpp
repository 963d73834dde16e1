#pragma once

#include "slideway/identify/fit.hpp"

namespace slideway {

/// What a careful reader would check next to the fitted numbers: the second-order term Eq. (5)
/// neglects, whether a slide could make the fitted straightness, how uncertainties were scaled.
void add_checks(const Model& model, const Solution& fit, ModelResult& out);

}  // namespace slideway
