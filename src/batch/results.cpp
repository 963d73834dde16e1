#include "slideway/batch/results.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "slideway/base/error.hpp"
#include "slideway/base/file.hpp"
#include "slideway/base/text.hpp"

namespace slideway {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

std::optional<std::string> text(const Json& json, const char* key) {
  const auto at = json.find(key);
  if (at == json.end()) return std::nullopt;
  if (at->is_null()) return "";
  if (!at->is_string()) return std::nullopt;
  return at->get<std::string>();
}

/// The head of a line that is whole.
std::optional<ResultHead> head_of(std::string_view line) {
  return line.ends_with('\n') && Json::accept(line) ? parse_head(line) : std::nullopt;
}

using EachLine = std::function<void(const ResultHead&, std::string_view)>;

std::size_t each_line(std::string_view text, const EachLine& each) {
  std::size_t torn = 0;
  while (!text.empty()) {
    const std::size_t newline = text.find('\n');
    const std::string_view line = text.substr(0, std::min(newline, text.size() - 1) + 1);
    text.remove_prefix(line.size());
    if (const std::optional<ResultHead> head = head_of(line))
      each(*head, line);
    else
      ++torn;
  }
  return torn;
}

}  // namespace

std::optional<ResultHead> parse_head(std::string_view line) {
  // In a text the quotes would have a backslash before them: this is where the head ends.
  const std::size_t end = line.find(",\"evidence\":");
  if (end == std::string_view::npos) return std::nullopt;
  const Json json = Json::parse(std::string(line.substr(0, end)) + "}", nullptr, false);
  if (!json.is_object()) return std::nullopt;
  const auto id = text(json, "id"), status = text(json, "status"), reason = text(json, "reason"),
             input = text(json, "input_sha256"), options = text(json, "options_hash"),
             version = text(json, "version");
  if (!id || id->empty() || !status || status->empty() || !reason || !input || !options || !version)
    return std::nullopt;
  return ResultHead{.id = *id,
                    .status = *status,
                    .reason = *reason,
                    .print = {*input, *options},
                    .version = *version,
                    .machine = text(json, "machine").value_or(""),
                    .time = text(json, "time").value_or("")};
}

std::size_t read_results(const fs::path& path, const EachLine& each) {
  return each_line(FileBytes::of_file_or_stdin(path).text(), each);
}

ResultsFile::ResultsFile(fs::path path) : path_(std::move(path)) { open(); }

ResultsFile::~ResultsFile() { ::close(file_); }

void ResultsFile::open() {
  file_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (file_ < 0) fail_to_write(path_, errno);
  if (::flock(file_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  ::close(file_);
  throw UsageError(path_.string() +
                   ": another run is writing it; accepted: another name, or wait for its end");
}

void ResultsFile::append(std::string_view line) {
  const off_t before = ::lseek(file_, 0, SEEK_END);
  if (const int error = write_all(file_, line); error != 0) {
    // What is left of a torn line would be passed over anyway.
    if (before >= 0) static_cast<void>(!::ftruncate(file_, before));
    fail_to_write(path_, error);
  }
}

void ResultsFile::keep(const std::function<bool(const ResultHead&)>& wanted) {
  std::unordered_set<std::string> kept;
  const auto is_kept = [&](const ResultHead& head) {
    return wanted(head) && kept.insert(head.id).second;
  };
  std::size_t dropped = 0;
  dropped += read_results(path_, [&](const ResultHead& head, std::string_view) {
    if (!is_kept(head)) ++dropped;
  });
  if (dropped == 0) return;
  kept.clear();
  WholeFile replacement(path_);
  read_results(path_, [&](const ResultHead& head, std::string_view line) {
    if (is_kept(head)) replacement.append(line);
  });
  replacement.finish();
  ::close(file_);
  open();
}

MergeSummary merge_results(const fs::path& out, const std::vector<fs::path>& in) {
  struct Place {
    std::size_t file = 0;
    std::string_view line;  // in the file
    bool is_ok = false;
  };
  std::vector<FileBytes> bytes;
  for (const fs::path& path : in) bytes.push_back(FileBytes::of_file_or_stdin(path));
  MergeSummary summary;
  std::map<std::string, Place> places;
  for (std::size_t file = 0; file < in.size(); ++file)
    summary.torn +=
        each_line(bytes[file].text(), [&](const ResultHead& head, std::string_view line) {
          const Place place{file, line, head.status == status::kOk};
          const auto [at, is_new] = places.emplace(head.id, place);
          if (is_new) return;
          ++summary.repeated;
          Place& there = at->second;
          if (there.is_ok && place.is_ok && there.line != place.line)
            throw DataError("id '" + printable(head.id, 60) + "' has one result in " +
                            in[there.file].string() + " and another in " + in[file].string());
          if (!there.is_ok && place.is_ok) there = place;
        });
  WholeFile replacement(out);
  for (const auto& [id, place] : places) replacement.append(place.line);
  replacement.finish();
  summary.lines = places.size();
  return summary;
}

std::size_t all_of(const StatusCounts& counts) {
  std::size_t sum = 0;
  for (const auto& [status, count] : counts) sum += count;
  return sum;
}

std::size_t failed_of(const StatusCounts& counts) {
  const auto ok = counts.find(status::kOk);
  return all_of(counts) - (ok == counts.end() ? 0 : ok->second);
}

StatusCounts verify_results(const Manifest& manifest, const Shard& shard, const fs::path& results) {
  std::unordered_map<std::string, std::size_t> seen;
  for (const ManifestItem& item : manifest.items)
    if (shard.holds(item.id)) seen.emplace(item.id, 0);
  StatusCounts counts;
  std::string first_foreign;
  std::size_t foreign = 0, missing = 0, repeated = 0;
  const std::size_t torn = read_results(results, [&](const ResultHead& head, std::string_view) {
    const auto at = seen.find(head.id);
    if (at == seen.end()) {
      if (foreign++ == 0) first_foreign = head.id;
    } else {
      ++at->second;
      ++counts[head.status];
    }
  });
  std::string first_missing, first_repeated;
  for (const ManifestItem& item : manifest.items) {
    const auto at = seen.find(item.id);
    if (at == seen.end()) continue;
    if (at->second == 0 && missing++ == 0) first_missing = item.id;
    if (at->second > 1 && repeated++ == 0) first_repeated = item.id;
  }
  std::vector<std::string> faults;
  const auto fault = [&](std::size_t count, const char* what, const std::string& first) {
    if (count == 0) return;
    faults.push_back(std::to_string(count) + what +
                     (first.empty() ? "" : " (first '" + printable(first, 60) + "')"));
  };
  fault(missing, " missing", first_missing);
  fault(repeated, " more than once", first_repeated);
  fault(foreign, " not in the manifest", first_foreign);
  fault(torn, torn == 1 ? " torn line" : " torn lines", "");
  if (!faults.empty())
    throw DataError(results.string() + ": " + std::to_string(seen.size()) +
                    " ids expected, each once; " + joined(faults));
  return counts;
}

}  // namespace slideway
