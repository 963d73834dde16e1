#pragma once

#include <cstddef>
#include <string>

namespace slideway {

/// So many bytes from the system's generator, in hexadecimal digits: what nobody can guess.
std::string random_hexadecimal(std::size_t bytes);

}  // namespace slideway
