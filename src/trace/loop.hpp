#pragma once

#include "slideway/trace/details.hpp"
#include "slideway/trace/trace.hpp"

namespace slideway {

/// close_loop() that also hands out the model it ends with.
/// @param last_model  may be null; left alone where no effect was added
TraceResult close_loop(const Problem& problem, const std::vector<Profile>& profiles,
                       const Progress& progress, std::optional<Fitted>* last_model);

}  // namespace slideway
