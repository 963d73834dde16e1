#pragma once

#include "slideway/identify/fit.hpp"

namespace slideway {

/// What the numbers of a slide's form leave open: the degree, what lies between its stations and
/// knots, whose form it is.
void explain_form(const Model& model, const Solution& fit, ModelResult& out);

}  // namespace slideway
