#pragma once

#include <functional>
#include <map>
#include <string>

#include "slideway/batch/results.hpp"
#include "slideway/batch/task_pool.hpp"

namespace slideway {

struct BatchOptions {
  std::filesystem::path out;
  Shard shard;
  bool resumes = false;
};

struct BatchSummary {
  std::size_t present = 0;  // kept from before: same inputs, options and version
  StatusCounts counts;      // of all items of the shard, kept ones included
  struct Failure {
    std::string id, reason;
  };
  std::map<std::string, Failure> first;  // of every cause, by the manifest's order
};

/// Progress callback: called after every result, and at least once a second.
using BatchProgress = std::function<void(const BatchSummary& so_far, std::size_t total)>;

/// Runs a task of run_batch() in a worker: one item of the same manifest.
std::string run_task(const Manifest& manifest, const ItemOptions& options, const std::string& task);

/// Identifies every item of the shard and writes one line for each. A line depends on its item
/// alone, not on the worker, the order or the outcome of other items. With `resumes`, lines that
/// are "ok" and have the same fingerprint and version are kept; all other items are run again.
/// @throws UsageError          the results exist and `resumes` is false, or they hold ids that are
///                             not among the items
/// @throws std::runtime_error  the results cannot be written
BatchSummary run_batch(const Manifest& manifest, const BatchOptions& options, TaskPool& pool,
                       const BatchProgress& progress = {});

}  // namespace slideway
