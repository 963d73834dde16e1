#include "slideway/base/error.hpp"

namespace slideway {
namespace {

bool continues(char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U; }

}  // namespace

std::string bounded_message(const std::string& message) {
  constexpr std::size_t kTail = kLongestMessage / 3;  // what is accepted stands at the end
  if (message.size() <= kLongestMessage) return message;
  std::size_t head = kLongestMessage - kTail, tail = message.size() - kTail;
  while (head > 0 && continues(message[head])) --head;
  while (tail < message.size() && continues(message[tail])) ++tail;
  return message.substr(0, head) + " ... " + message.substr(tail);
}

}  // namespace slideway
