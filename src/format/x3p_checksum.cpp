#include "x3p_checksum.hpp"

#include <openssl/evp.h>

#include <array>
#include <span>
#include <stdexcept>

#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"

namespace slideway {

std::string md5(std::string_view bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_md5(), nullptr) != 1)
    throw std::runtime_error("MD5, the checksum of X3P, is not available in this OpenSSL");
  return hexadecimal(std::span(digest).first(size));
}

void ChecksumGate::check(std::string_view bytes, std::string_view digits, const std::string& part) {
  std::string given(digits);
  for (char& c : given)
    if (c >= 'A' && c <= 'F') c = static_cast<char>(c - 'A' + 'a');
  const std::string found = md5(bytes);
  if (given == found) return;
  const std::string wrong = given.empty() ? part + ": the file gives no MD5 checksum"
                                          : part + ": the MD5 checksum is " + found +
                                                ", the file says '" + printable(given, 32) + "'";
  if (!ignore_) throw DataError(wrong + "; to read it nevertheless, ignore the checksum");
  decisions_.push_back(wrong + "; read nevertheless, as asked");
}

}  // namespace slideway
