#pragma once

#include <vector>

#include "shape_lattice.hpp"
#include "slideway/identify/fit.hpp"

namespace slideway {

/// A wave in the samples of a profile that is too fast for the low band: fewer than
/// Gates::values_per_cycle values a cycle. The low band folds it to another rate.
struct FastLine {
  const Profile* profile = nullptr;
  double cycles = 0.0;  // over the trace
};

/// Those that stand out of the noise beside them (Gates::significance, of all rates of a trace) in
/// the spectrum of what the model leaves of the samples, but for those of feed marks; the strongest
/// of each profile. None of a profile whose low band is the samples, that has gaps, or that has
/// fewer than 256 samples.
std::vector<FastLine> fast_lines(const Model& model, const Solution& fit);

/// The shapes at which an effect of one rate makes each of such lines, with those beside them; none
/// where it is no effect of one rate or makes none of them.
std::vector<ShapeLattice> shapes_of_lines(const Model& model, const ModelTerm& term,
                                          const std::vector<FastLine>& lines);

}  // namespace slideway
