#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace slideway {

/// The bytes of a file, mapped read-only; empty files and pipes are read instead.
/// @throws DataError if it is missing, a directory, or can not be read: "path: what is wrong".
class FileBytes {
 public:
  explicit FileBytes(const std::filesystem::path& path);
  ~FileBytes();
  FileBytes(FileBytes&& other) noexcept;
  FileBytes& operator=(FileBytes&& other) noexcept;
  FileBytes(const FileBytes&) = delete;
  FileBytes& operator=(const FileBytes&) = delete;

  [[nodiscard]] std::string_view text() const { return {data_, size_}; }

 private:
  const char* data_ = nullptr;
  std::size_t size_ = 0;
  bool mapped_ = false;
  std::string owned_;
};

/// SHA-256 of the bytes, 64 lower-case hexadecimal digits (FIPS 180-4).
std::string sha256(std::string_view bytes);

/// Makes a directory and those above it unless it is there.
/// @throws std::runtime_error naming the path and the cause
void make_directory(const std::filesystem::path& path);

/// Writes a file whole or not at all, whatever signal ends the process meanwhile: a file without a
/// name, which gets it when it is whole. Over an older file, or where the file system knows no such
/// files, a temporary name beside it stands in, and signals wait. Devices and pipes are written
/// directly.
/// @throws std::runtime_error naming the path and the cause; the old file is then untouched.
void write_file(const std::filesystem::path& path, std::string_view contents);

}  // namespace slideway
