#pragma once

#include "slideway/format/format.hpp"

namespace slideway {

// const Format& text_format(); and so on, one for each name in SLIDEWAY_FORMATS.
#define SLIDEWAY_FORMAT(name) const Format& name##_format();
#include "format_list.inc"
#undef SLIDEWAY_FORMAT

}  // namespace slideway
