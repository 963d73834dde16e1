#include "secret.hpp"

#include <sys/random.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "slideway/base/text.hpp"

namespace slideway {

std::string random_hexadecimal(std::size_t bytes) {
  std::vector<unsigned char> random(bytes);
  if (::getrandom(random.data(), bytes, 0) != static_cast<ssize_t>(bytes))
    throw std::runtime_error("getrandom: " + std::generic_category().message(errno));
  return hexadecimal(random);
}

}  // namespace slideway
