#pragma once

#include <string>

#include "slideway/identify/fault.hpp"
#include "slideway/trace/check.hpp"

namespace slideway {

/// A fault with the line it stands on and a mark under what is wrong, in at most 80 columns.
std::string fault_text(const Fault& fault);

/// What `slideway check` says: faults, or what was read, assumed, and can be determined.
std::string check_text(const ProblemCheck& check);

/// The same as JSON, schema "slideway.check/1".
std::string check_json(const ProblemCheck& check);

}  // namespace slideway
