#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "environment.hpp"
#include "output.hpp"
#include "progress.hpp"
#include "report_command.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/batch/batch.hpp"
#include "slideway/batch/distributed_pool.hpp"
#include "slideway/batch/pool.hpp"
#include "slideway/batch/process_pool.hpp"
#include "slideway/report/layout.hpp"
#include "slideway/report/number.hpp"

namespace slideway {
namespace {
namespace po = boost::program_options;
using Json = nlohmann::ordered_json;

class BatchCommand : public ReportCommand {
 public:
  BatchCommand()
      : ReportCommand("batch", "MANIFEST --out OUT | merge OUT IN... | verify MANIFEST OUT",
                      "Identifies each problem of a manifest; merges, verifies results") {
    add_inputs("MANIFEST", &words_);
    auto options = add_options();
    options("out", po::value(&out_)->value_name("FILE"), "the results, one JSON object a line");
    options("resume", po::bool_switch(&resume_),
            "go on with results that are there; items that failed or changed are done again");
    options("jobs", po::value(&jobs_)->value_name("N"),
            "items at a time (default: the processors; started by MPI: 1 a process)");
    options("shard", po::value(&shard_)->value_name("i/n"),
            "only part i of n, by a hash of the id");
    options("timeout", po::value(&timeout_)->value_name("SECONDS"),
            "end an item that takes longer");
    options("memory", po::value(&memory_)->value_name("MB"),
            "end an item that needs more (default: the machine's, divided by the jobs)");
    options("no-trace", po::bool_switch(&no_trace_), "stop before the closed loop");
    options("full", po::bool_switch(&full_),
            "whole reports in the results, with their curves: some hundred kilobytes an item");
    options("pool", po::value(&pool_)->value_name("machine"),
            "then fit all items of a machine (column 'machine') together, with their trend over "
            "the column 'time'");
    options("data", po::value(&data_)->value_name("DIR"),
            "what ${SLIDEWAY_DATA} in the problem files stands for");
    options("ignore-checksum", po::bool_switch(&ignore_checksum_),
            "read files whose checksum is wrong; the reports then say so");
  }

  int run() override {
    if (words_[0] == "merge") return merge();
    if (words_[0] == "verify") return verify();
    return batch();
  }

 private:
  void check(const po::variables_map& given) override {
    const std::string& first = words_.empty() ? "" : words_[0];
    const auto only = [&](const std::string& what, std::initializer_list<std::string> allowed) {
      for (const auto& [name, value] : given)
        if (!value.defaulted() && name != "MANIFEST" && name != "quiet" &&
            std::find(allowed.begin(), allowed.end(), name) == allowed.end())
          fail("--" + name + " does not belong to batch " + what);
    };
    if (first == "merge") {
      if (words_.size() < 3) fail("merge needs OUT and one or more IN: batch merge OUT IN...");
      only("merge", {});
    } else if (first == "verify") {
      if (words_.size() != 3) fail("verify needs two files: batch verify MANIFEST RESULTS");
      only("verify", {"shard"});
    } else {
      if (words_.size() > 1) fail("too many arguments; accepted: one MANIFEST");
      if (!words_.empty() && given.count("out") == 0) fail("--out RESULTS.jsonl is missing");
    }
    if (words_.empty()) fail("MANIFEST is missing; accepted: a CSV file with a column 'problem'");
    if (given.count("jobs") != 0 && (jobs_ < 1 || jobs_ > 4096)) fail("--jobs: from 1 to 4096");
    const auto above_zero = [](double value) { return std::isfinite(value) && value > 0.0; };
    if (given.count("timeout") != 0 && !(above_zero(timeout_) && timeout_ < 1e7))
      fail("--timeout: a number of seconds above 0 and below 1e7");
    if (given.count("memory") != 0 && !above_zero(memory_))
      fail("--memory: a finite number of megabytes above 0");
    if (!pool_.empty() && pool_ != "machine")
      fail("--pool: '" + printable(pool_) + "' is not accepted; accepted: machine");
    if (!shard_.empty()) checked_shard_ = parsed_shard();
  }

  [[nodiscard]] Shard parsed_shard() const {
    Shard shard;
    const char* const end = shard_.data() + shard_.size();
    const auto index = std::from_chars(shard_.data(), end, shard.index);
    if (index.ec == std::errc() && index.ptr != end && *index.ptr == '/') {
      const auto count = std::from_chars(index.ptr + 1, end, shard.count);
      if (count.ec == std::errc() && count.ptr == end && shard.index >= 1 &&
          shard.index <= shard.count)
        return shard;
    }
    fail("--shard: '" + printable(shard_) + "' is not accepted; accepted: i/n, 1/4 to 4/4");
  }

  [[nodiscard]] std::size_t jobs() const {
    if (jobs_ > 0) return static_cast<std::size_t>(jobs_);
    return is_started_by_mpi() ? 1 : std::max(1U, std::thread::hardware_concurrency());
  }

  [[nodiscard]] WorkerLimits limits() const {
    WorkerLimits limits;
    if (timeout_ > 0.0)
      limits.time =
          std::chrono::ceil<std::chrono::milliseconds>(std::chrono::duration<double>(timeout_));
    const double machine = static_cast<double>(::sysconf(_SC_PHYS_PAGES)) *
                           static_cast<double>(::sysconf(_SC_PAGE_SIZE));
    constexpr double kMegabyte = 1e6;
    limits.memory_bytes = static_cast<std::uint64_t>(
        memory_ > 0.0 ? memory_ * kMegabyte : machine / static_cast<double>(jobs()));
    return limits;
  }

  int batch() const {
    keep_input(words_[0], out_);
    keep(words_[0]);
    const Manifest manifest = read_manifest(words_[0]);
    keep_items(manifest);
    if (!pool_.empty()) check_pool(manifest);
    const ItemOptions item{data_directory(data_), !no_trace_, ignore_checksum_, full_};
    // Before MPI starts, which does not support processes that fork.
    ProcessPool local(
        jobs(), [&](const std::string& task) { return run_task(manifest, item, task); }, limits());
    const std::unique_ptr<Transport> transport = mpi_transport();
    if (transport && transport->rank() > 0) {
      serve_tasks(local, *transport, jobs() + 1);
      return kDone;
    }
    const BatchSummary summary = [&] {
      std::optional<DistributedPool> all_ranks;
      if (transport) all_ranks.emplace(local, *transport);
      TaskPool& pool = all_ranks ? static_cast<TaskPool&>(*all_ranks) : local;
      const ProgressLine line(!is_quiet());
      return run_batch(manifest, {out_, checked_shard_, resume_}, pool,
                       [&](const BatchSummary& so_far, std::size_t total) {
                         line.show(batch_progress(so_far, total, line.elapsed()));
                       });
    }();
    std::vector<PooledMachine> machines;
    if (!pool_.empty()) machines = pool_machines(manifest, out_);
    const bool are_dates = read_times(manifest).are_dates;
    report([&] { return text(summary) + pooled_text(machines, are_dates); },
           [&] { return json(summary, pooled_json(machines, are_dates)); });
    return failed_of(summary.counts) > 0 ? kFailedItems : kDone;
  }

  void keep_items(const Manifest& manifest) const {
    keep_apart(out_);
    std::set<std::filesystem::path> files;
    for (const ManifestItem& item : manifest.items) {
      if (!files.contains(item.problem))
        for (std::filesystem::path& file : files_of(item.problem, data_directory(data_)))
          files.insert(std::move(file));
      for (const Override& override : item.overrides)
        if (override.key.ends_with(".file"))
          files.insert(item.problem.parent_path() / override.value);
    }
    for (const std::filesystem::path& file : files) {
      keep_input(file, out_);
      keep(file);
    }
  }

  /// Checks the columns for --pool before the items are run.
  static void check_pool(const Manifest& manifest) {
    static_cast<void>(read_times(manifest));
    for (const ManifestItem& item : manifest.items)
      if (!item.machine.empty()) return;
    throw DataError(manifest.path.string() + ": names no machine; accepted: a column 'machine'");
  }

  [[nodiscard]] std::string text(const BatchSummary& summary) const {
    const std::size_t all = all_of(summary.counts), failed = failed_of(summary.counts);
    std::string line =
        counted(all, "item") + " in " + out_ + ": " + std::to_string(all - failed) + " ok";
    if (summary.present > 0) line += " (" + std::to_string(summary.present) + " from before)";
    std::string out = paragraph("", line + ", " + std::to_string(failed) + " failed");
    for (const auto& [status, first] : summary.first)
      out += paragraph("  " + status + " ", std::to_string(summary.counts.at(status)) +
                                                ", the first '" + printable(first.id, 60) +
                                                "': " + printable(first.reason, 400));
    return out;
  }

  [[nodiscard]] std::string json(const BatchSummary& summary, const std::string& machines) const {
    Json counts = Json::object(), first = Json::object();
    for (const auto& [status, count] : summary.counts) counts[status] = count;
    for (const auto& [status, failure] : summary.first)
      first[status] = {{"id", failure.id}, {"reason", failure.reason}};
    Json out = {{"schema", "slideway.batch/1"},
                {"version", results_version()},
                {"items", all_of(summary.counts)},
                {"from_before", summary.present},
                {"failed", failed_of(summary.counts)},
                {"counts", counts},
                {"first", first}};
    if (!pool_.empty()) out["machines"] = Json::parse(machines);
    return document_text(out);
  }

  int merge() const {
    const std::vector<std::filesystem::path> in(words_.begin() + 2, words_.end());
    for (const std::filesystem::path& path : in) keep_input(path, words_[1]);
    const MergeSummary summary = merge_results(words_[1], in);
    std::string line = counted(summary.lines, "item") + " in " + words_[1];
    if (summary.repeated > 0) line += ", " + std::to_string(summary.repeated) + " repeated";
    if (summary.torn > 0) line += ", " + std::to_string(summary.torn) + " torn lines left out";
    if (!is_quiet()) print(paragraph("", line));
    return kDone;
  }

  int verify() const {
    const StatusCounts counts = verify_results(read_manifest(words_[1]), checked_shard_, words_[2]);
    const std::size_t all = all_of(counts), failed = failed_of(counts);
    std::string line =
        counted(all, "item") + ", each once: " + std::to_string(all - failed) + " ok";
    for (const auto& [status, count] : counts)
      if (status != status::kOk) line += ", " + std::to_string(count) + " " + status;
    if (!is_quiet()) print(paragraph("", line));
    return failed == 0 ? kDone : kFailedItems;
  }

  std::vector<std::string> words_;
  std::string out_, shard_, data_, pool_;
  Shard checked_shard_;
  int jobs_ = 0;
  double timeout_ = 0.0, memory_ = 0.0;
  bool resume_ = false, no_trace_ = false, ignore_checksum_ = false, full_ = false;
};

}  // namespace

std::unique_ptr<Command> make_batch() { return std::make_unique<BatchCommand>(); }

}  // namespace slideway
