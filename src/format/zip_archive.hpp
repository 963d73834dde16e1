#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>

/// Zip archives in memory, read with distrust.
namespace slideway {

class ZipArchive {
 public:
  /// @throws DataError  not a zip archive, cut off, names that lead out of the archive, the same
  ///                    name twice, archives within it
  explicit ZipArchive(std::string_view bytes);
  ~ZipArchive();
  ZipArchive(const ZipArchive&) = delete;
  ZipArchive& operator=(const ZipArchive&) = delete;

  [[nodiscard]] bool contains(const std::string& name) const;

  /// A file of the archive, its own checksum verified, read in pieces.
  /// @throws DataError  missing, damaged, encrypted, larger than `most` bytes, or blown up: more
  ///                    than 1 MiB and 100 times its compressed size
  [[nodiscard]] std::string read(const std::string& name, std::size_t most) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// An archive of files (name, contents), uncompressed, dated 1980-01-01: the same bytes every time.
std::string zip_archive(std::span<const std::pair<std::string, std::string>> files);

}  // namespace slideway
