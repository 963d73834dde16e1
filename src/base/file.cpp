#include "slideway/base/file.hpp"

#include <fcntl.h>
#include <openssl/evp.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "slideway/base/error.hpp"

namespace slideway {
namespace {

namespace fs = std::filesystem;

std::string cause(int error) { return std::generic_category().message(error); }

// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  [[nodiscard]] int number() const { return number_; }
  // 0, or what went wrong (a full disk may tell only here).
  int close() { return number_ < 0 || ::close(std::exchange(number_, -1)) == 0 ? 0 : errno; }

 private:
  int number_;
};

std::string read_all(int file, const fs::path& path) {
  std::string bytes;
  std::array<char, 65536> chunk;
  for (;;) {
    const ssize_t count = ::read(file, chunk.data(), chunk.size());
    if (count > 0)
      bytes.append(chunk.data(), static_cast<std::size_t>(count));
    else if (count == 0)
      return bytes;
    else if (errno != EINTR)
      throw DataError(path.string() + ": can not be read: " + cause(errno));
  }
}

// 0, or what went wrong.
int write_all(const Descriptor& file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(file.number(), bytes.data(), bytes.size());
    if (count >= 0)
      bytes.remove_prefix(static_cast<std::size_t>(count));
    else if (errno != EINTR)
      return errno;
  }
  return 0;
}

// Signals wait as long as it lives.
class SignalsHeld {
 public:
  SignalsHeld() {
    sigset_t all;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~SignalsHeld() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsHeld(const SignalsHeld&) = delete;
  SignalsHeld& operator=(const SignalsHeld&) = delete;

 private:
  sigset_t before_{};
};

// Makes a temporary file beside the target by `make(name)`, 0 or an error, and gives it the
// target's name. Both under held signals, or one could leave the temporary file behind.
template <typename Make>
int replace(const fs::path& target, const Make& make) {
  const SignalsHeld held;
  const std::string stem = ".slideway." + std::to_string(::getpid()) + ".";
  int error = EEXIST;
  for (int attempt = 0; attempt < 100 && error == EEXIST; ++attempt) {
    const fs::path temporary = target.parent_path() / (stem + std::to_string(attempt) + ".tmp");
    error = make(temporary);
    if (error == 0 && ::rename(temporary.c_str(), target.c_str()) != 0) {
      error = errno;
      ::unlink(temporary.c_str());
    }
  }
  return error;
}

// A name for a file that has none: at once where the name is free.
int give_name(const Descriptor& file, const fs::path& target) {
  const std::string nameless = "/proc/self/fd/" + std::to_string(file.number());
  const auto link = [&](const fs::path& name) {
    const int flags = AT_SYMLINK_FOLLOW;
    return ::linkat(AT_FDCWD, nameless.c_str(), AT_FDCWD, name.c_str(), flags) == 0 ? 0 : errno;
  };
  const int error = link(target);
  return error == EEXIST ? replace(target, link) : error;
}

// For file systems where a file needs a name from the start.
int write_named(const fs::path& target, std::string_view contents, std::optional<mode_t> mode) {
  return replace(target, [&](const fs::path& name) {
    Descriptor file(::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (file.number() < 0) return errno;
    if (mode) ::fchmod(file.number(), *mode & 07777U);
    int error = write_all(file, contents);
    if (const int at_close = file.close(); error == 0) error = at_close;
    if (error != 0) ::unlink(name.c_str());
    return error;
  });
}

[[noreturn]] void fail_to_write(const fs::path& path, int error) {
  throw std::runtime_error(path.string() + ": can not be written: " + cause(error));
}

// A device, a pipe, or a name for something the process holds open: /dev/stdout may end at a
// regular file, which a rename would cut off from its other writers.
bool is_stream(const fs::path& path, const struct stat& status) {
  if (!S_ISREG(status.st_mode)) return true;
  const std::string whole = fs::absolute(path).lexically_normal().string();
  return fs::is_symlink(path) && (whole.starts_with("/dev/") || whole.starts_with("/proc/"));
}

void write_through(const fs::path& path, std::string_view contents) {
  Descriptor file(::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC));
  int error = file.number() < 0 ? errno : write_all(file, contents);
  if (error == 0) error = file.close();
  if (error != 0) fail_to_write(path, error);
}

}  // namespace

FileBytes::FileBytes(const fs::path& path) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  struct stat status {};
  if (file.number() < 0 || ::fstat(file.number(), &status) != 0)
    throw DataError(path.string() + ": can not be read: " + cause(errno));
  if (S_ISDIR(status.st_mode)) throw DataError(path.string() + ": is a directory, expected a file");
  if (S_ISREG(status.st_mode) && status.st_size > 0) {
    size_ = static_cast<std::size_t>(status.st_size);
    void* const memory = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, file.number(), 0);
    if (memory != MAP_FAILED) {
      ::madvise(memory, size_, MADV_SEQUENTIAL);
      data_ = static_cast<const char*>(memory);
      mapped_ = true;
      return;
    }
  }
  owned_ = read_all(file.number(), path);
  data_ = owned_.data();
  size_ = owned_.size();
}

FileBytes::~FileBytes() {
  if (mapped_) ::munmap(const_cast<char*>(data_), size_);
}

FileBytes::FileBytes(FileBytes&& other) noexcept { *this = std::move(other); }

FileBytes& FileBytes::operator=(FileBytes&& other) noexcept {
  if (this == &other) return *this;
  if (mapped_) ::munmap(const_cast<char*>(data_), size_);
  size_ = std::exchange(other.size_, 0);
  mapped_ = std::exchange(other.mapped_, false);
  owned_ = std::move(other.owned_);  // a short string moves with its bytes
  data_ = std::exchange(other.data_, nullptr);
  if (!mapped_) data_ = owned_.data();
  return *this;
}

std::string sha256(std::string_view bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1)
    throw std::runtime_error("SHA-256 is not available in this OpenSSL");
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (unsigned i = 0; i < size; ++i) {
    text += kDigits[digest[i] >> 4U];
    text += kDigits[digest[i] & 15U];
  }
  return text;
}

void make_directory(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (fs::is_directory(path)) return;
  throw std::runtime_error(path.string() + ": can not be made a directory: " +
                           (error ? error.message() : cause(ENOTDIR)));
}

void write_file(const fs::path& path, std::string_view contents) {
  struct stat status {};
  const bool exists = ::stat(path.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) fail_to_write(path, EISDIR);
  if (exists && is_stream(path, status)) return write_through(path, contents);

  const fs::path target = exists ? fs::canonical(path) : path;  // a link stays a link
  const fs::path folder = target.has_parent_path() ? target.parent_path() : ".";
  const Descriptor file(::open(folder.c_str(), O_WRONLY | O_TMPFILE | O_CLOEXEC, 0666));
  int error = file.number() < 0 ? errno : 0;
  if (error == 0) {
    if (exists) ::fchmod(file.number(), status.st_mode & 07777U);
    error = write_all(file, contents);
    if (error == 0) error = give_name(file, target);
  }
  if (error == EOPNOTSUPP || error == EISDIR || error == ENOENT)  // no O_TMPFILE, or no /proc
    error = write_named(target, contents, exists ? std::optional(status.st_mode) : std::nullopt);
  if (error != 0) fail_to_write(path, error);
}

}  // namespace slideway
