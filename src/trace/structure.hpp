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

/// Size, place and form of what is left.
Unnamed describe(const Structure& structure, const Whitened& data, const Linearisation& linear);

}  // namespace slideway
