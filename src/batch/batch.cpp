#include "slideway/batch/batch.hpp"

#include <charconv>
#include <system_error>
#include <unordered_map>
#include <unordered_set>

#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"

namespace slideway {
namespace {

constexpr char kIdentify = 'i', kFingerprint = 'f';

std::string task(char what, std::size_t item) { return what + std::to_string(item); }

std::size_t item_of(const std::string& task) {
  std::size_t item = 0;
  std::from_chars(task.data() + 1, task.data() + task.size(), item);
  return item;
}

std::string text_of(const Fingerprint& print) {
  return print.input_sha256 + " " + print.options_hash;
}

std::string fingerprint_text(const ManifestItem& item, const ItemOptions& options) {
  try {
    return text_of(fingerprint(item, options));
  } catch (const std::exception&) {
    return "none";  // the line of the item says why
  }
}

/// Runs one task for each item, in any order.
void run_tasks(
    TaskPool& pool, char what, const std::vector<std::size_t>& items,
    const std::function<void(std::size_t item, TaskResult&)>& done,
    const std::function<void()>& progress = [] {}) {
  constexpr std::chrono::seconds kProgressInterval{1};
  for (auto next = items.begin(); next != items.end() || pool.pending() > 0;) {
    while (next != items.end() && pool.has_idle()) pool.submit(task(what, *next++));
    for (TaskResult& result : pool.collect(kProgressInterval)) done(item_of(result.task), result);
    progress();
  }
}

bool is_current(const ResultHead& head) {
  return head.status == status::kOk && head.version == results_version();
}

bool is_there(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored) &&
         std::filesystem::file_size(path, ignored) > 0;
}

class Batch {
 public:
  Batch(const Manifest& manifest, const BatchOptions& options, TaskPool& pool,
        const BatchProgress& progress)
      : manifest_(&manifest), options_(&options), pool_(&pool), progress_(&progress) {
    for (std::size_t i = 0; i < manifest.items.size(); ++i)
      if (options.shard.holds(manifest.items[i].id)) items_.push_back(i);
  }

  BatchSummary run() {
    if (!options_->resumes && is_there(options_->out))
      throw UsageError(options_->out.string() +
                       ": is there already; accepted: --resume, or another name");
    ResultsFile results(options_->out);
    if (options_->resumes) resume(results);
    const std::size_t total = summary_.present + items_.size();
    run_tasks(
        *pool_, kIdentify, items_,
        [&](std::size_t item, TaskResult& result) { results.append(line_of(item, result)); },
        [&] {
          if (*progress_) (*progress_)(summary_, total);
        });
    return std::move(summary_);
  }

 private:
  /// Keeps the lines that are current, and removes their items from those to run.
  void resume(ResultsFile& results) {
    std::unordered_map<std::string, std::size_t> by_id;
    for (const std::size_t item : items_) by_id.emplace(manifest_->items[item].id, item);
    std::unordered_map<std::size_t, std::string> prints;
    std::size_t lines = 0;
    lines += read_results(options_->out, [&](const ResultHead& head, std::string_view) {
      ++lines;
      const auto item = by_id.find(head.id);
      if (item == by_id.end())
        throw UsageError(options_->out.string() + ": holds the id '" + printable(head.id, 60) +
                         "', which is not among the items; accepted: the manifest and the --shard "
                         "it was begun with, or another name");
      if (is_current(head)) prints.emplace(item->second, text_of(head.print));
    });
    std::vector<std::size_t> candidates;
    for (const std::size_t item : items_)
      if (prints.contains(item)) candidates.push_back(item);
    std::unordered_set<std::string> kept;
    run_tasks(*pool_, kFingerprint, candidates, [&](std::size_t item, const TaskResult& result) {
      if (result.reply == prints.at(item)) kept.insert(manifest_->items[item].id);
    });
    if (lines > kept.size())
      results.keep([&](const ResultHead& head) {
        return kept.contains(head.id) && is_current(head) &&
               prints.at(by_id.at(head.id)) == text_of(head.print);
      });
    std::erase_if(items_,
                  [&](std::size_t item) { return kept.contains(manifest_->items[item].id); });
    summary_.present = kept.size();
    if (!kept.empty()) summary_.counts[status::kOk] = kept.size();
  }

  std::string line_of(std::size_t item, TaskResult& result) {
    const std::string& id = manifest_->items[item].id;
    if (!result.reply) result.reply = failed_line(id, result.cause, result.reason);
    // The head suffices: this program wrote the line.
    const ResultHead head = parse_head(*result.reply).value();
    ++summary_.counts[head.status];
    if (head.status != status::kOk) {
      const auto [at, is_new] = first_.emplace(head.status, item);
      if (is_new || item < at->second) {
        at->second = item;
        summary_.first[head.status] = {id, head.reason};
      }
    }
    return std::move(*result.reply);
  }

  const Manifest* manifest_;
  const BatchOptions* options_;
  TaskPool* pool_;
  const BatchProgress* progress_;
  std::vector<std::size_t> items_;
  std::map<std::string, std::size_t> first_;  // item that failed first, by status
  BatchSummary summary_;
};

}  // namespace

std::string run_task(const Manifest& manifest, const ItemOptions& options,
                     const std::string& task) {
  const ManifestItem& item = manifest.items.at(item_of(task));
  return task[0] == kFingerprint ? fingerprint_text(item, options) : identify_item(item, options);
}

BatchSummary run_batch(const Manifest& manifest, const BatchOptions& options, TaskPool& pool,
                       const BatchProgress& progress) {
  return Batch(manifest, options, pool, progress).run();
}

}  // namespace slideway
