#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "slideway/batch/item.hpp"

namespace slideway {

/// What stands in a line of the results before its report.
struct ResultHead {
  std::string id, status, reason;
  Fingerprint print;
  std::string version;
  std::string machine = {}, time = {};  // as the manifest has them
};

/// The head of a line of the results; none if it has not all that a line has.
std::optional<ResultHead> parse_head(std::string_view line);

/// Calls back for every line of a results file that is whole, a JSON object with all that a line
/// has. @return how many lines are not, a last one without its newline included
/// @throws DataError  if the file cannot be read
std::size_t read_results(
    const std::filesystem::path& path,
    const std::function<void(const ResultHead& head, std::string_view line)>& each);

/// The results file while a batch runs: a line is appended by one write, so that whatever ends the
/// program, all lines before are whole.
class ResultsFile {
 public:
  /// Makes the file, or goes on behind what is there.
  /// @throws std::runtime_error  it cannot be written
  /// @throws UsageError          another run is writing it
  explicit ResultsFile(std::filesystem::path path);
  ~ResultsFile();
  ResultsFile(const ResultsFile&) = delete;
  ResultsFile& operator=(const ResultsFile&) = delete;

  /// @throws std::runtime_error  the line cannot be written; the file is then as before
  void append(std::string_view line);

  /// Leaves only the lines that are wanted, the first of an id, by a new file in the old one's
  /// place. Nothing is written where that changes nothing.
  void keep(const std::function<bool(const ResultHead& head)>& wanted);

 private:
  void open();

  std::filesystem::path path_;
  int file_ = -1;
};

/// What a merge found.
struct MergeSummary {
  std::size_t lines = 0;     // written
  std::size_t repeated = 0;  // left out: there in a better or an equal line
  std::size_t torn = 0;      // left out: not whole
};

/// Writes the lines of all results into one file, by id. Of lines with one id, one that is "ok"
/// stays.
/// @throws DataError  two different "ok" lines of one id
MergeSummary merge_results(const std::filesystem::path& out,
                           const std::vector<std::filesystem::path>& in);

/// How many items ended how.
using StatusCounts = std::map<std::string, std::size_t>;
std::size_t all_of(const StatusCounts& counts);
std::size_t failed_of(const StatusCounts& counts);

/// Checks that every id of the manifest (in this shard) stands exactly once in the results and no
/// other does. @throws DataError  it is not so: how many, and the first
StatusCounts verify_results(const Manifest& manifest, const Shard& shard,
                            const std::filesystem::path& results);

}  // namespace slideway
