#pragma once

#include <string>

#include "drawn_problem.hpp"

namespace slideway {

/// A JSON text with one to eight of its values replaced, left out, repeated, or moved to another
/// place.
std::string draw_json(Draw& draw, const std::string& sound);

/// The report of a problem that is always the same, with all that a report can hold.
const std::string& sound_report();

/// The line of a batch's results that a problem of its own gets.
std::string sound_line(const std::string& id);

}  // namespace slideway
