#pragma once

#include <string>

namespace slideway {

/// A text of this room with the escape sequences of a terminal in it: headings (the lines at the
/// left margin, but for the box) bold, verdicts green, yellow or red. Without the sequences it is
/// the same text.
std::string with_emphasis(const std::string& text);

}  // namespace slideway
