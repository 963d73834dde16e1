#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace slideway {

/// The bytes of a file. A regular file of more than 64 MiB is mapped, all else is read.
/// @throws DataError  "path: what is wrong" if it is missing, is a directory, cannot be read, or
/// was
///                    changed while it was read
class FileBytes {
 public:
  explicit FileBytes(const std::filesystem::path& path);
  /// @throws DataError  also for a pipe, a socket or a device, which may never end
  static FileBytes of_regular_file(const std::filesystem::path& path);
  /// The same, but a pipe or a terminal may be named where the process has it open: /dev/stdin.
  static FileBytes of_file_or_stdin(const std::filesystem::path& path);
  ~FileBytes();
  FileBytes(FileBytes&& other) noexcept;
  FileBytes& operator=(FileBytes&& other) noexcept;
  FileBytes(const FileBytes&) = delete;
  FileBytes& operator=(const FileBytes&) = delete;

  [[nodiscard]] std::string_view text() const { return {data_, size_}; }

  /// Releases the mapped pages between `first` and `last`; a later access reads them again. For
  /// large files that are read once.
  void forget(std::size_t first, std::size_t last) const;

 private:
  const char* data_ = nullptr;
  std::size_t size_ = 0;
  bool mapped_ = false;
  std::string owned_;
};

/// SHA-256 of the bytes, 64 lower-case hexadecimal digits (FIPS 180-4).
std::string sha256(std::string_view bytes);

/// SHA-256 of a file, whose pages are released after use.
std::string sha256(const FileBytes& file);

/// Makes a directory and its parents if they do not exist.
/// @throws std::runtime_error naming the path and the cause
void make_directory(const std::filesystem::path& path);

/// A file that is written completely or not at all, also if a signal ends the process or the power
/// fails. The bytes go to an unnamed file (O_TMPFILE), which is linked when it is complete and on
/// the disk. To replace an existing file, or on a file system without unnamed files, a temporary
/// name is used and renamed while signals are blocked. Devices and pipes are written directly.
/// @throws std::runtime_error  "path: cannot be written: cause"; an older file is then unchanged
class WholeFile {
 public:
  explicit WholeFile(std::filesystem::path path);
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  void append(std::string_view bytes);
  /// Makes the file visible under its name.
  void finish();

 private:
  class Target;
  std::filesystem::path path_;
  std::string pending_;  // buffer for small pieces
  std::unique_ptr<Target> target_;
};

/// Writes a whole file.
void write_file(const std::filesystem::path& path, std::string_view contents);

/// Writes all bytes to a file descriptor. @return 0 or errno
int write_all(int file, std::string_view bytes);

/// @throws std::runtime_error "path: cannot be written: cause"
[[noreturn]] void fail_to_write(const std::filesystem::path& path, int error);

}  // namespace slideway
