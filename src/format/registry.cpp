#include "registry.hpp"

#include <array>

namespace slideway {

std::span<const Format* const> formats() {
  static const std::array kAll{
#define SLIDEWAY_FORMAT(name) &name##_format(),
#include "format_list.inc"
#undef SLIDEWAY_FORMAT
  };
  return kAll;
}

}  // namespace slideway
