#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace slideway {

/// What a run's folder holds, and a data file is not called.
namespace run_file {
inline constexpr const char* kProblem = "problem.toml";
inline constexpr const char* kResult = "result.json";
inline constexpr const char* kPage = "report.html";
}  // namespace run_file

/// A name of letters, digits, "-", "_" and "." that leads nowhere else, at most 64 long, its ending
/// kept: "../a b.csv" is "a_b.csv". Never empty, never one of a run's own files.
std::string safe_name(std::string_view text);

/// A regular file, not a symbolic link.
bool is_plain_file(const std::filesystem::path& path);

/// What no file of a run is larger than.
inline constexpr std::uintmax_t kMostBytesOfFile = std::uintmax_t{256} << 20;

/// The bytes of a plain file. @throws HttpFailure  404; 413: larger than
/// kMostBytesOfFile
std::string bytes_of(const std::filesystem::path& path);

/// The folder that is served: one folder a run, and results of batches. Its temporary folders are
/// in one that is removed at the end and at the next start.
class Workspace {
 public:
  /// @throws UsageError  another server has it  @throws std::runtime_error  it cannot be written
  explicit Workspace(const std::filesystem::path& folder);
  ~Workspace();
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  /// Makes an empty folder whose name nobody can guess.
  [[nodiscard]] std::filesystem::path temporary() const;

  /// Moves a whole run into its place under `wanted`, or "wanted-2", ... @return its name
  [[nodiscard]] std::string publish(const std::filesystem::path& temporary,
                                    const std::string& wanted) const;

  /// Newest first, at most kMostRuns: folders with a problem or a result, files of results.
  [[nodiscard]] std::vector<std::string> runs() const;
  [[nodiscard]] std::vector<std::string> batches() const;

  /// The folder of a run; a file of a batch. @throws HttpFailure  404
  [[nodiscard]] std::filesystem::path run(const std::string& name) const;
  [[nodiscard]] std::filesystem::path batch(const std::string& name) const;

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

 private:
  static constexpr std::size_t kMostRuns = 500;

  std::filesystem::path folder_, temporary_;
  int lock_ = -1;
};

}  // namespace slideway
