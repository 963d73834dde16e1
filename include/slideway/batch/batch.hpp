#pragma once

#include <functional>
#include <map>
#include <string>

#include "slideway/batch/hands.hpp"
#include "slideway/batch/results.hpp"

namespace slideway {

struct BatchOptions {
  std::filesystem::path out;
  Shard shard;
  bool resumes = false;
};

struct BatchSummary {
  std::size_t present = 0;  // already there, of the same inputs, options and version
  StatusCounts counts;      // of all items of the shard, those included
  struct Failure {
    std::string id, reason;
  };
  std::map<std::string, Failure> first;  // of every cause, by the manifest's order
};

/// Told how far it is, of how many items: with every answer, and every second between them.
using BatchProgress = std::function<void(const BatchSummary& so_far, std::size_t total)>;

/// What a task of run_batch() is: for those who do the work. A task is about one item of the same
/// manifest.
std::string do_task(const Manifest& manifest, const ItemOptions& options, const std::string& task);

/// Has every item of the shard identified, and writes a line each. The lines depend on nothing but
/// the item: not on who did them, in which order, or what became of others. With `resumes` a line
/// stays that is "ok" and has the same fingerprint and version; all others are made again.
/// @throws UsageError          the results are there and it does not resume, or hold ids that are
///                             not among the items
/// @throws std::runtime_error  the results cannot be written
BatchSummary run_batch(const Manifest& manifest, const BatchOptions& options, Hands& hands,
                       const BatchProgress& progress = {});

}  // namespace slideway
