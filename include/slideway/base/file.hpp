#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace slideway {

/// The bytes of a file, mapped read-only; empty files and pipes are read instead.
/// @throws DataError if it is missing, a directory, or cannot be read: "path: what is wrong".
class FileBytes {
 public:
  explicit FileBytes(const std::filesystem::path& path);
  /// @throws DataError  also for a pipe, a socket or a device, which may never end
  static FileBytes of_regular_file(const std::filesystem::path& path);
  ~FileBytes();
  FileBytes(FileBytes&& other) noexcept;
  FileBytes& operator=(FileBytes&& other) noexcept;
  FileBytes(const FileBytes&) = delete;
  FileBytes& operator=(const FileBytes&) = delete;

  [[nodiscard]] std::string_view text() const { return {data_, size_}; }

  /// Gives back the memory of the bytes from `first` up to `last` where they are mapped; they are
  /// read again if they are looked at. For large files that are passed through once.
  void forget(std::size_t first, std::size_t last) const;

 private:
  const char* data_ = nullptr;
  std::size_t size_ = 0;
  bool mapped_ = false;
  std::string owned_;
};

/// SHA-256 of the bytes, 64 lower-case hexadecimal digits (FIPS 180-4).
std::string sha256(std::string_view bytes);

/// The same of a file, whose bytes it forgets behind itself.
std::string sha256(const FileBytes& file);

/// Makes a directory and those above it unless it is there.
/// @throws std::runtime_error naming the path and the cause
void make_directory(const std::filesystem::path& path);

/// A file that is written whole or not at all, whatever signal ends the process meanwhile: a file
/// without a name, which gets it when it is whole. Over an older file a temporary name beside it
/// stands in for a moment, where the file system knows no such files from the start; signals wait
/// as long. Devices and pipes are written directly.
/// @throws std::runtime_error naming the path and the cause; the old file is then untouched.
class WholeFile {
 public:
  explicit WholeFile(std::filesystem::path path);
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  void append(std::string_view bytes);
  /// The file is there from now on.
  void finish();

 private:
  class Target;
  std::filesystem::path path_;
  std::string pending_;  // many small pieces are one write
  std::unique_ptr<Target> target_;
};

/// The same in one go.
void write_file(const std::filesystem::path& path, std::string_view contents);

/// Writes all bytes into an open file; 0, or the number of the error.
int write_all(int file, std::string_view bytes);

/// @throws std::runtime_error "path: cannot be written: cause"
[[noreturn]] void fail_to_write(const std::filesystem::path& path, int error);

}  // namespace slideway
