#pragma once

#include "process.hpp"
#include "slideway/trace/trace.hpp"
#include "whitened.hpp"

namespace slideway {

/// The process without a name that the data support most, over all process_variables().
struct Structure {
  Unnamed description;                   // variable and evidence only
  std::vector<Eigen::MatrixXd> columns;  // its cosines, per fitted profile
  Process process;
};
Structure find_structure(const Model& model, const Whitened& data, const Linearisation& linear);

/// Log evidence of the best process of the slide, of the time, of the distance or of the trace that
/// several faces have in common, over noise alone, nats; 0 where there are not two, or where the
/// noise of the fit is that beside a structure (FitNoise). Noise of a long memory explains a
/// structure in each of them by itself, not in all of them at once.
double shared_evidence(const FittedModel& fitted);

/// Size, place and form of what is left.
/// @param wave  the low band of a wave besides, stacked; empty: none
Unnamed describe(const FittedModel& fitted, const Structure& structure, const Whitened& data,
                 const Eigen::VectorXd& wave);

/// What a variable of a process is called in a formula.
struct Clock {
  const char *symbol, *name, *unit;  // "r", "x", "mm"
  double per_unit;                   // readings of the process
  IndependentVariable variable;
};
/// That of what is left; the trace position where it is of one profile alone.
const Clock& clock_of(const Unnamed& unnamed);

}  // namespace slideway
