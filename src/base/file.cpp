#include "slideway/base/file.hpp"

#include <fcntl.h>
#include <openssl/evp.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"

namespace slideway {
namespace {

namespace fs = std::filesystem;

std::string cause(int error) { return std::generic_category().message(error); }

// Closes its file descriptor.
class Descriptor {
 public:
  Descriptor() = default;
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  [[nodiscard]] int number() const { return number_; }
  // 0 or errno.
  int open(const fs::path& path, int flags) {
    number_ = ::open(path.c_str(), flags | O_CLOEXEC, 0666);
    return number_ < 0 ? errno : 0;
  }
  // 0 or errno; a full disk may be reported only here.
  int close() { return number_ < 0 || ::close(std::exchange(number_, -1)) == 0 ? 0 : errno; }

 private:
  int number_ = -1;
};

// Files up to this size are read, so that nothing that happens to them later matters; larger ones
// are mapped, so that they need not fit in memory.
constexpr std::size_t kMostRead = 1 << 26;

std::string read_all(int file, std::size_t expected, const fs::path& path) {
  std::string bytes;
  bytes.reserve(expected);
  std::array<char, 65536> chunk;
  for (;;) {
    const ssize_t count = ::read(file, chunk.data(), chunk.size());
    if (count > 0)
      bytes.append(chunk.data(), static_cast<std::size_t>(count));
    else if (count == 0)
      return bytes;
    else if (errno != EINTR)
      throw DataError(path.string() + ": cannot be read: " + cause(errno));
  }
}

bool is_unchanged(const struct stat& before, int file) {
  struct stat now {};
  return ::fstat(file, &now) == 0 && now.st_size == before.st_size &&
         now.st_mtim.tv_sec == before.st_mtim.tv_sec &&
         now.st_mtim.tv_nsec == before.st_mtim.tv_nsec;
}

// Blocks all signals during its lifetime.
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

// Makes a temporary file in the target's folder by `make(name)`. Returns 0 or errno.
template <typename Make>
int make_beside(const fs::path& target, const Make& make, fs::path& temporary) {
  const std::string stem = ".slideway." + std::to_string(::getpid()) + ".";
  int error = EEXIST;
  for (int attempt = 0; attempt < 100 && error == EEXIST; ++attempt) {
    temporary = target.parent_path() / (stem + std::to_string(attempt) + ".tmp");
    error = make(temporary);
  }
  return error;
}

fs::path folder_of(const fs::path& target) {
  return target.has_parent_path() ? target.parent_path() : ".";
}

// 0 or errno; 0 where the file system has nothing to synchronise.
int synchronise(int file) {
  return ::fsync(file) == 0 || errno == EINVAL || errno == ENOTSUP ? 0 : errno;
}

int synchronise_names(const fs::path& folder) {
  Descriptor names;
  if (const int error = names.open(folder, O_RDONLY | O_DIRECTORY); error != 0) return error;
  return synchronise(names.number());
}

int rename_over(const fs::path& temporary, const fs::path& target) {
  if (::rename(temporary.c_str(), target.c_str()) == 0) return 0;
  const int error = errno;
  ::unlink(temporary.c_str());
  return error;
}

class Sha256 {
 public:
  Sha256() : context_(::EVP_MD_CTX_new(), &::EVP_MD_CTX_free) {
    require(context_ != nullptr &&
            ::EVP_DigestInit_ex(context_.get(), ::EVP_sha256(), nullptr) == 1);
  }
  void add(std::string_view bytes) {
    require(::EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()) == 1);
  }
  std::string digits() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned size = 0;
    require(::EVP_DigestFinal_ex(context_.get(), digest.data(), &size) == 1);
    return hexadecimal(std::span(digest).first(size));
  }

 private:
  static void require(bool done) {
    if (!done) throw std::runtime_error("SHA-256 is not available in this OpenSSL");
  }

  std::unique_ptr<EVP_MD_CTX, decltype(&::EVP_MD_CTX_free)> context_;
};

// A device, a pipe, or a link to an open file of the process: /dev/stdout may be a regular file
// with other writers, which a rename would replace.
bool is_stream(const fs::path& path, const struct stat& status) {
  if (!S_ISREG(status.st_mode)) return true;
  const std::string whole = fs::absolute(path).lexically_normal().string();
  return fs::is_symlink(path) && (whole.starts_with("/dev/") || whole.starts_with("/proc/"));
}

}  // namespace

FileBytes::FileBytes(const fs::path& path) {
  Descriptor file;
  struct stat status {};
  if (file.open(path, O_RDONLY) != 0 || ::fstat(file.number(), &status) != 0)
    throw DataError(path.string() + ": cannot be read: " + cause(errno));
  if (S_ISDIR(status.st_mode)) throw DataError(path.string() + ": is a directory, expected a file");
  const bool has_size = S_ISREG(status.st_mode) && status.st_size > 0;  // not a file of /proc
  size_ = has_size ? static_cast<std::size_t>(status.st_size) : 0;
  if (size_ > kMostRead) {
    void* const memory = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, file.number(), 0);
    if (memory != MAP_FAILED) {
      ::madvise(memory, size_, MADV_SEQUENTIAL);
      data_ = static_cast<const char*>(memory);
      mapped_ = true;
      return;
    }
  }
  owned_ = read_all(file.number(), std::min(size_, kMostRead), path);
  if (has_size && (owned_.size() != size_ || !is_unchanged(status, file.number())))
    throw DataError(path.string() + ": was changed while it was read");
  data_ = owned_.data();
  size_ = owned_.size();
}

FileBytes FileBytes::of_regular_file(const fs::path& path) {
  std::error_code ignored;  // the constructor reports what is missing
  const fs::file_status status = fs::status(path, ignored);
  if (fs::is_other(status))
    throw DataError(path.string() + ": is a pipe or a device, expected a file");
  return FileBytes(path);
}

FileBytes FileBytes::of_file_or_stdin(const fs::path& path) {
  const std::string whole = fs::absolute(path).lexically_normal().string();
  const bool is_open =
      whole == "/dev/stdin" || whole.starts_with("/dev/fd/") || whole.starts_with("/proc/self/fd/");
  std::error_code ignored;
  const bool is_device = fs::is_character_file(path, ignored) && ::isatty(STDIN_FILENO) == 0;
  return is_open && !is_device ? FileBytes(path) : of_regular_file(path);
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

void FileBytes::forget(std::size_t first, std::size_t last) const {
  static const auto kPage = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  first = first / kPage * kPage;
  last = last / kPage * kPage;
  if (mapped_ && first < last)
    ::madvise(const_cast<char*>(data_) + first, last - first, MADV_DONTNEED);
}

std::string sha256(std::string_view bytes) {
  Sha256 sum;
  sum.add(bytes);
  return sum.digits();
}

std::string sha256(const FileBytes& file) {
  constexpr std::size_t kPart = 1 << 23;
  Sha256 sum;
  const std::string_view bytes = file.text();
  for (std::size_t at = 0; at < bytes.size(); at += kPart) {
    sum.add(bytes.substr(at, kPart));
    if (at + kPart < bytes.size()) file.forget(at, at + kPart);
  }
  return sum.digits();
}

void make_directory(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (fs::is_directory(path)) return;
  throw std::runtime_error(path.string() + ": cannot be made a directory: " +
                           (error ? error.message() : cause(ENOTDIR)));
}

// Where the bytes go until the file is complete. Functions that can fail return 0 or errno.
class WholeFile::Target {
 public:
  ~Target() {
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
  }
  int open(const fs::path& path);
  int write(std::string_view bytes) { return write_all(file_.number(), bytes); }
  int finish();

 private:
  int give_name();

  Descriptor file_;
  fs::path target_;     // empty: written directly
  fs::path temporary_;  // on file systems without O_TMPFILE
  std::optional<SignalsHeld> held_;
};

int WholeFile::Target::open(const fs::path& path) {
  struct stat status {};
  const bool exists = ::stat(path.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) return EISDIR;
  if (exists && is_stream(path, status)) return file_.open(path, O_WRONLY | O_APPEND);

  target_ = exists ? fs::canonical(path) : path;  // a link stays a link
  int error = ::access("/proc/self/fd", F_OK) == 0
                  ? file_.open(folder_of(target_), O_WRONLY | O_TMPFILE)
                  : EOPNOTSUPP;
  if (error == EOPNOTSUPP || error == EISDIR) {
    held_.emplace();
    error = make_beside(
        target_,
        [this](const fs::path& name) { return file_.open(name, O_WRONLY | O_CREAT | O_EXCL); },
        temporary_);
    if (error != 0) temporary_.clear();
  }
  if (error == 0 && exists) ::fchmod(file_.number(), status.st_mode & 07777U);
  return error;
}

// Links the unnamed file directly if the name is free.
int WholeFile::Target::give_name() {
  const std::string nameless = "/proc/self/fd/" + std::to_string(file_.number());
  const auto link = [&](const fs::path& name) {
    const int flags = AT_SYMLINK_FOLLOW;
    return ::linkat(AT_FDCWD, nameless.c_str(), AT_FDCWD, name.c_str(), flags) == 0 ? 0 : errno;
  };
  if (const int error = link(target_); error != EEXIST) return error;
  const SignalsHeld held;
  fs::path temporary;
  const int error = make_beside(target_, link, temporary);
  return error == 0 ? rename_over(temporary, target_) : error;
}

// The bytes are on the disk before the name is, the name before the file counts as written.
int WholeFile::Target::finish() {
  if (target_.empty()) return file_.close();
  if (const int error = synchronise(file_.number()); error != 0) return error;
  if (temporary_.empty())
    if (const int error = give_name(); error != 0) return error;
  if (const int error = file_.close(); error != 0) return error;
  if (!temporary_.empty())
    if (const int error = rename_over(std::exchange(temporary_, {}), target_); error != 0)
      return error;
  return synchronise_names(folder_of(target_));
}

WholeFile::WholeFile(fs::path path) : path_(std::move(path)), target_(std::make_unique<Target>()) {
  if (const int error = target_->open(path_); error != 0) fail_to_write(path_, error);
}

WholeFile::~WholeFile() = default;

void WholeFile::append(std::string_view bytes) {
  constexpr std::size_t kAtATime = 1 << 20;
  int error = 0;
  if (pending_.size() + bytes.size() >= kAtATime) {
    error = target_->write(std::exchange(pending_, {}));
    if (error == 0) error = target_->write(bytes);
  } else {
    pending_ += bytes;
  }
  if (error != 0) fail_to_write(path_, error);
}

void WholeFile::finish() {
  int error = target_->write(std::exchange(pending_, {}));
  if (error == 0) error = target_->finish();
  if (error != 0) fail_to_write(path_, error);
}

void write_file(const fs::path& path, std::string_view contents) {
  WholeFile file(path);
  file.append(contents);
  file.finish();
}

int write_all(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(file, bytes.data(), bytes.size());
    if (count >= 0)
      bytes.remove_prefix(static_cast<std::size_t>(count));
    else if (errno != EINTR)
      return errno;
  }
  return 0;
}

void fail_to_write(const fs::path& path, int error) {
  throw std::runtime_error(path.string() + ": cannot be written: " + cause(error));
}

}  // namespace slideway
