#include "workspace.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <system_error>
#include <utility>

#include "http_server.hpp"
#include "secret.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/file.hpp"

namespace slideway {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMostName = 64, kMostEnding = 8;
constexpr std::size_t kNameBytes = 8;
constexpr const char* kTemporary = ".slideway-serve";

bool is_safe(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
         c == '_' || c == '.';
}

/// Letters that German and French names have, without their marks.
std::string without_marks(std::string text) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 12> kPlain{{{"ä", "ae"},
                                                                                  {"ö", "oe"},
                                                                                  {"ü", "ue"},
                                                                                  {"Ä", "Ae"},
                                                                                  {"Ö", "Oe"},
                                                                                  {"Ü", "Ue"},
                                                                                  {"ß", "ss"},
                                                                                  {"µ", "u"},
                                                                                  {"é", "e"},
                                                                                  {"è", "e"},
                                                                                  {"à", "a"},
                                                                                  {"ç", "c"}}};
  for (const auto& [letter, plain] : kPlain)
    for (std::size_t at = 0; (at = text.find(letter, at)) != std::string::npos;)
      text.replace(at, letter.size(), plain);
  return text;
}

bool is_safe_name(const std::string& name) {
  return !name.empty() && name.size() <= kMostName && name[0] != '.' &&
         std::ranges::all_of(name, is_safe);
}

fs::file_status own_status(const fs::path& path) {
  std::error_code ignored;
  return fs::symlink_status(path, ignored);
}

/// The names in a folder that `wanted` says, newest first.
template <typename Wanted>
std::vector<std::string> newest(const fs::path& folder, std::size_t most, const Wanted& wanted) {
  std::vector<std::pair<fs::file_time_type, std::string>> found;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    if (is_safe_name(name) && wanted(entry.path()))
      found.emplace_back(entry.last_write_time(ignored), name);
  }
  std::ranges::sort(found, std::greater<>());
  if (found.size() > most) found.resize(most);
  std::vector<std::string> names;
  for (auto& [time, name] : found) names.push_back(std::move(name));
  return names;
}

bool is_run(const fs::path& path) {
  return fs::is_directory(own_status(path)) &&
         (is_plain_file(path / run_file::kProblem) || is_plain_file(path / run_file::kResult));
}

bool is_batch(const fs::path& path) { return path.extension() == ".jsonl" && is_plain_file(path); }

}  // namespace

std::string safe_name(std::string_view text) {
  std::string name;
  const std::size_t slash = text.find_last_of("/\\");
  for (const char c : without_marks(std::string(text.substr(slash + 1))))  // npos + 1 is 0
    if (is_safe(c))
      name += c;
    else if (!name.ends_with('_'))
      name += '_';
  name.erase(0, std::min(name.find_first_not_of("._-"), name.size()));
  if (name.size() > kMostName) {
    const std::string ending = fs::path(name).extension().string();
    name = ending.size() <= kMostEnding ? name.substr(0, kMostName - ending.size()) + ending
                                        : name.substr(0, kMostName);
  }
  if (name.empty()) return "data";
  for (const char* own : {run_file::kProblem, run_file::kResult, run_file::kPage})
    if (name == own) return "data-" + name;
  return name;
}

bool is_plain_file(const fs::path& path) { return fs::is_regular_file(own_status(path)); }

std::string bytes_of(const fs::path& path) {
  if (!is_plain_file(path)) throw HttpFailure(404, path.filename().string() + " is not there");
  const FileBytes bytes = FileBytes::of_regular_file(path);
  if (bytes.text().size() > kMostBytesOfFile)
    throw HttpFailure(413, path.filename().string() + " is larger than " +
                               std::to_string(kMostBytesOfFile >> 20) + " MiB");
  return std::string(bytes.text());
}

Workspace::Workspace(const fs::path& folder) {
  make_directory(folder);
  folder_ = fs::canonical(folder);
  temporary_ = folder_ / kTemporary;
  lock_ = ::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (lock_ < 0 || ::flock(lock_, LOCK_EX | LOCK_NB) != 0) {
    if (lock_ >= 0) ::close(lock_);
    throw UsageError("serve: another slideway serve has " + folder_.string() +
                     "; accepted: another DIR");
  }
  fs::remove_all(temporary_);
  make_directory(temporary_);
  fs::permissions(temporary_, fs::perms::owner_all);
}

Workspace::~Workspace() {
  std::error_code ignored;
  fs::remove_all(temporary_, ignored);
  ::close(lock_);
}

fs::path Workspace::temporary() const {
  fs::path made = temporary_ / random_hexadecimal(kNameBytes);
  make_directory(made);
  return made;
}

std::string Workspace::publish(const fs::path& temporary, const std::string& wanted) const {
  constexpr int kMostAlike = 10'000;
  for (int i = 1; i <= kMostAlike; ++i) {
    std::string number = std::to_string(-i);
    if (i == 1) number.clear();
    std::string name = wanted.substr(0, kMostName - number.size()) + number;
    const fs::path place = folder_ / name;
    if (::renameat2(AT_FDCWD, temporary.c_str(), AT_FDCWD, place.c_str(), RENAME_NOREPLACE) == 0)
      return name;
    if (errno != EEXIST) fail_to_write(place, errno);
  }
  throw HttpFailure(409, "too many runs are called " + wanted);
}

std::vector<std::string> Workspace::runs() const { return newest(folder_, kMostRuns, is_run); }
std::vector<std::string> Workspace::batches() const { return newest(folder_, kMostRuns, is_batch); }

fs::path Workspace::run(const std::string& name) const {
  if (!is_safe_name(name) || !is_run(folder_ / name)) throw HttpFailure(404, "no such run");
  return folder_ / name;
}

fs::path Workspace::batch(const std::string& name) const {
  if (!is_safe_name(name) || !is_batch(folder_ / name)) throw HttpFailure(404, "no such results");
  return folder_ / name;
}

}  // namespace slideway
