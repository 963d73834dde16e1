#include <algorithm>

#include "copies.hpp"
#include "position_units.hpp"
#include "problem_section.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/identify/problem_tree.hpp"
#include "slideway/profile/given.hpp"

namespace slideway {
namespace {

void check_names(const Problem& problem, const GivenTraces& given) {
  std::vector<std::string> names;
  for (const ProfileEntry& entry : problem.profiles) names.push_back(entry.profile.name);
  for (const auto& [name, trace] : given)
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw UsageError(problem.path.string() + ": numbers for '" + printable(name) +
                       "', which is no [[profile]]" + did_you_mean(name, names) +
                       "; accepted: " + joined(names, " "));
}

void take_or_read(const ProfileEntry& entry, const GivenTraces& given, const ReadProgress& progress,
                  Profile& profile) {
  if (const auto at = given.find(entry.profile.name); at != given.end())
    return take_profile(entry.source, at->second, profile);
  if (entry.source.path.empty())
    throw UsageError("profile '" + entry.profile.name + "': no numbers; accepted: arrays, or file");
  read_profile(entry.source, profile, progress);
}

/// Which part of all files has been read, told by each.
class FilesRead {
 public:
  FilesRead(const Problem& problem, const ReadProgress& progress) : progress_(progress) {
    for (const ProfileEntry& entry : problem.profiles) all_ += size_of(entry);
  }

  [[nodiscard]] ReadProgress within(const ProfileEntry& entry) const {
    if (!progress_ || all_ == 0.0) return {};
    return
        [this, size = size_of(entry)](double share) { progress_((before_ + share * size) / all_); };
  }
  void finish(const ProfileEntry& entry) { before_ += size_of(entry); }

 private:
  /// 0 of what is no regular file.
  static double size_of(const ProfileEntry& entry) {
    std::error_code error;
    const auto size = std::filesystem::file_size(entry.source.path, error);
    return error ? 0.0 : static_cast<double>(size);
  }

  const ReadProgress& progress_;
  double all_ = 0.0, before_ = 0.0;  // bytes
};

/// Where a key of a profile stands; of a key left out, where its table begins.
Fault at_key(const Problem& problem, const ProfileEntry& entry, const std::string& key) {
  const bool is_there = entry.lines.contains(key);
  const auto at = entry.lines.find(is_there ? key : "");
  const int line = at != entry.lines.end() ? at->second : 0;
  return {.message = "", .file = problem.path.string(), .line = line, .key = is_there ? key : ""};
}

/// "problem.toml:12: profile.center_mm: what is wrong"
Fault placed(const Problem& problem, const ProfileEntry& entry, const KeyError& error) {
  Fault out = at_key(problem, entry, error.key);
  out.message = out.file + (out.line > 0 ? ":" + std::to_string(out.line) : "") + ": profile." +
                error.key + ": '" + entry.profile.name + "': " + error.what();
  return out;
}

/// @throws DataError, FaultError
void read_entry(const Problem& problem, const ProfileEntry& entry, const GivenTraces& given,
                const ReadProgress& progress, Profile& profile) {
  try {
    take_or_read(entry, given, progress, profile);
  } catch (const DataError& error) {
    throw DataError("profile '" + entry.profile.name + "': " + error.what());
  } catch (const KeyError& error) {
    throw FaultError(placed(problem, entry, error));
  } catch (const UsageError& error) {
    throw FaultError({.message = problem.path.string() + ": " + error.what()});
  }
}

}  // namespace

std::vector<Profile> read_profiles(const Problem& problem, const ReadProgress& progress) {
  return read_profiles(problem, GivenTraces{}, progress);
}

std::vector<Profile> read_profiles(const Problem& problem, const GivenTraces& given,
                                   const ReadProgress& progress) {
  check_names(problem, given);
  FilesRead files(problem, progress);
  std::vector<Profile> profiles;
  for (const ProfileEntry& entry : problem.profiles) {
    profiles.push_back(entry.profile);
    read_entry(problem, entry, given, files.within(entry), profiles.back());
    files.finish(entry);
  }
  hold_out_copies(profiles);
  note_other_position_units(profiles);
  return profiles;
}

std::vector<Profile> read_profiles(const Problem& problem, Faults& faults) {
  std::vector<Profile> profiles;
  for (const ProfileEntry& entry : problem.profiles) {
    Profile profile = entry.profile;
    try {
      read_entry(problem, entry, {}, {}, profile);
      profiles.push_back(std::move(profile));
    } catch (const FaultError& error) {
      faults.push_back(error.fault);
    } catch (const DataError& error) {
      Fault fault = at_key(problem, entry, "file");
      fault.message = error.what();
      fault.is_of_data = true;
      faults.push_back(std::move(fault));
    }
  }
  hold_out_copies(profiles);
  note_other_position_units(profiles);
  return profiles;
}

}  // namespace slideway
