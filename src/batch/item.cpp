#include "slideway/batch/item.hpp"

#include <algorithm>
#include <new>
#include <nlohmann/json.hpp>
#include <utility>

#include "slideway/base/error.hpp"
#include "slideway/base/file.hpp"
#include "slideway/report/report.hpp"
#include "slideway/trace/analysis.hpp"

namespace slideway {
namespace {

using Json = nlohmann::ordered_json;

Json or_null(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

/// The line up to where a result would begin.
std::string head(const std::string& id, const std::string& status, const std::string& reason,
                 const Fingerprint& print, const std::string& machine = "",
                 const std::string& time = "") {
  Json json = {{"id", id},
               {"status", status},
               {"reason", or_null(reason)},
               {"input_sha256", or_null(print.input_sha256)},
               {"options_hash", or_null(print.options_hash)},
               {"version", results_version()}};
  if (!machine.empty()) json["machine"] = machine;
  if (!time.empty()) json["time"] = time;
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  text.pop_back();
  return text;
}

std::string without_result(const std::string& id, const std::string& status,
                           const std::string& reason, const Fingerprint& print) {
  return head(id, status, reason, print) + ",\"evidence\":null,\"report\":null}\n";
}

std::string options_hash(const ManifestItem& item, const ItemOptions& options) {
  std::vector<Override> overrides = item.overrides;
  std::sort(overrides.begin(), overrides.end(),
            [](const Override& a, const Override& b) { return a.key < b.key; });
  std::string text = sha256(FileBytes::of_regular_file(item.problem).text()) + "\n";
  for (const Override& override : overrides) text += override.key + " = " + override.value + "\n";
  if (!options.closes_loop) text += "--no-trace\n";
  if (options.ignore_checksum) text += "--ignore-checksum\n";
  if (options.is_whole) text += "--full\n";
  return sha256(text);
}

std::string evidence_text(const Evidence& evidence) {
  return Json{{"parameters", evidence.parameters},
              {"units", evidence.units},
              {"rows", evidence.rows},
              {"values", evidence.values}}
      .dump();
}

Problem problem_of(const ManifestItem& item, const ItemOptions& options) {
  Problem problem = read_problem(item.problem, options.data_dir, item.overrides);
  for (ProfileEntry& entry : problem.profiles)
    entry.source.request.ignore_checksum = options.ignore_checksum;
  return problem;
}

/// @param print  what is known of the item, for the line of one that fails
std::string identified(const ManifestItem& item, const ItemOptions& options, Fingerprint& print) {
  const Problem problem = problem_of(item, options);
  print.options_hash = options_hash(item, options);
  const std::vector<Profile> profiles = read_profiles(problem);
  std::string inputs;
  for (const Profile& profile : profiles) inputs += profile.sha256 + "\n";
  print.input_sha256 = sha256(inputs);
  Analysis analysis = analyse(problem, profiles,
                              {.closes_loop = options.closes_loop,
                               .with_details = options.is_whole,
                               .with_curves = options.is_whole,
                               .with_evidence = true});
  const std::string evidence = evidence_text(*analysis.evidence);
  return head(item.id, status::kOk, "", print, item.machine, item.time) +
         ",\"evidence\":" + evidence + ",\"report\":" +
         (options.is_whole ? json_line(analysis) : json_brief(std::move(analysis))) + "}\n";
}

}  // namespace

std::string results_version() { return SLIDEWAY_VERSION; }

Fingerprint fingerprint(const ManifestItem& item, const ItemOptions& options) {
  std::string inputs;
  for (const ProfileEntry& entry : problem_of(item, options).profiles)
    inputs += sha256(FileBytes::of_regular_file(entry.source.path)) + "\n";
  return {sha256(inputs), options_hash(item, options)};
}

std::string identify_item(const ManifestItem& item, const ItemOptions& options) {
  Fingerprint print;
  const auto failed = [&](const char* status, const std::string& reason) {
    return without_result(item.id, status, reason, print);
  };
  try {
    return identified(item, options, print);
  } catch (const UsageError& error) {
    return failed(status::kBadProblem,
                  "line " + std::to_string(item.line) + " of the manifest: " + error.what());
  } catch (const DataError& error) {
    return failed(status::kBadData, error.what());
  } catch (const std::bad_alloc&) {
    return failed(status::kOutOfMemory, "out of memory");
  } catch (const std::exception& error) {
    return failed(status::kFailed, error.what());
  }
}

std::string failed_line(const std::string& id, const std::string& status,
                        const std::string& reason) {
  return without_result(id, status, reason, {});
}

}  // namespace slideway
