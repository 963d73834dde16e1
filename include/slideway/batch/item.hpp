#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "slideway/batch/manifest.hpp"

namespace slideway {

/// What holds for all items of a batch.
struct ItemOptions {
  std::optional<std::filesystem::path> data_dir;  // as read_problem() has it
  bool closes_loop = true;
  bool ignore_checksum = false;
  bool is_whole = false;  // the line has the whole report, with its curves
};

/// How an item ended, in the words of its line: "ok", or the cause why it failed.
namespace status {
inline constexpr const char* kOk = "ok";
inline constexpr const char* kBadProblem = "bad_problem";     // exit code 2 of `identify`
inline constexpr const char* kBadData = "bad_data";           // exit code 3
inline constexpr const char* kFailed = "failed";              // exit code 1
inline constexpr const char* kOutOfMemory = "out_of_memory";  // beyond the limit of a worker
inline constexpr const char* kTimeout = "timeout";            // beyond the time given
inline constexpr const char* kCrashed = "crashed";            // a signal ended the worker
}  // namespace status

/// What a result depends on, besides the program.
struct Fingerprint {
  /// SHA-256 of the profile files' SHA-256s, one a line, in the problem's order; empty where a file
  /// cannot be read.
  std::string input_sha256;
  /// SHA-256 of the problem file's SHA-256, of what overrides it by key, and of the options.
  std::string options_hash;
};

/// The fingerprint of an item whose files are there. @throws UsageError, DataError
Fingerprint fingerprint(const ManifestItem& item, const ItemOptions& options);

/// Identifies an item. @return its line of the results; whatever is wrong with it is in there
std::string identify_item(const ManifestItem& item, const ItemOptions& options);

/// The line of an item that ended without one.
std::string failed_line(const std::string& id, const std::string& status,
                        const std::string& reason);

/// The version in every line.
std::string results_version();

}  // namespace slideway
