#include "draft_session.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "http_server.hpp"
#include "json_text.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/file.hpp"
#include "slideway/base/text.hpp"
#include "slideway/identify/draft.hpp"
#include "slideway/identify/problem.hpp"
#include "slideway/identify/problem_tree.hpp"
#include "slideway/signal/thin.hpp"

namespace slideway {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostFiles = 32;
constexpr std::size_t kMostPoints = 1600;  // of a plot

Json json_of(const std::string& name, const Trace& trace) {
  std::vector<double> x, y;
  for (std::size_t i = 0; i < trace.positions.size(); ++i) {
    if (!std::isfinite(trace.positions[i]) || !std::isfinite(trace.values[i])) continue;
    x.push_back(trace.positions[i]);
    y.push_back(trace.values[i]);
  }
  Json positions = Json::array(), values = Json::array();
  if (!x.empty())
    for (const std::size_t i : thinned({y}, kMostPoints)) {
      positions.push_back(x[i]);
      values.push_back(y[i]);
    }
  return {{"name", name},
          {"readings", trace.positions.size()},
          {"missing", trace.positions.size() - x.size()},
          {"positions", positions},
          {"values", values}};
}

Json json_of(const DraftFile& file) {
  return {{"file", file.path.filename().string()},
          {"name", file.name},
          {"format", file.format},
          {"decision", file.decision},
          {"columns", file.columns},
          {"units", file.units},
          {"trace", file.trace ? json_of(file.name, *file.trace) : Json()}};
}

/// The answers of a page: [{"key": "feed", "file": 0, "value": "40"}, ...].
using Answers = std::map<std::pair<std::string, std::size_t>, std::string>;

Answers answers_of(const std::string& given) {
  Answers out;
  try {
    for (const Json& each : Json::parse(given))
      out[{each.at("key").get<std::string>(), each.at("file").get<std::size_t>()}] =
          each.at("value").get<std::string>();
  } catch (const Json::exception&) {
    throw UsageError("the answers are no list of key, file and value");
  }
  return out;
}

/// One question with what was answered; the draft has an answer to it then.
Json settled(Draft& draft, const DraftQuestion& question, const Answers& answers) {
  const auto given = answers.find({question.key, question.file});
  std::string error;
  bool is_open = false;
  try {
    if (given == answers.end() || trimmed(given->second).empty()) throw UsageError("");
    draft.answer(question, given->second);
  } catch (const UsageError& refused) {
    error = refused.what();
    is_open = !error.empty() || question.guess.empty();
    draft.answer(question, question.guess.empty() ? question.fallback : question.guess);
  }
  return {{"key", question.key},
          {"file", question.file},
          {"of_file", Draft::is_of_file(question.key)},
          {"words", question.words},
          {"accepted", question.accepted},
          {"picture", question.picture},
          {"guess", question.guess},
          {"why", question.why},
          {"certain", question.certain},
          {"value", given == answers.end() ? Json() : Json(given->second)},
          {"error", error},
          {"open", is_open}};
}

/// Messages call a file by its name alone.
std::string without(const fs::path& folder, std::string text) {
  const std::string prefix = folder.string() + "/";
  for (std::size_t at; (at = text.find(prefix)) != std::string::npos;)
    text.erase(at, prefix.size());
  return text;
}

/// Every occurrence of a path, as TOML quotes it.
void rename_in(std::string& problem, const std::string& before, const std::string& after) {
  if (before == after) return;
  for (const char quote : {'"', '\''}) {
    const std::string old = quote + before + quote;
    for (std::size_t at = 0; (at = problem.find(old, at)) != std::string::npos; ++at)
      problem.replace(at, old.size(), quote + after + quote);
  }
}

}  // namespace

DraftSession::~DraftSession() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

std::string DraftSession::add(std::string_view name, std::string_view bytes) {
  const std::lock_guard lock(mutex_);
  if (files_.size() >= kMostFiles)
    throw HttpFailure(413, "more than " + std::to_string(kMostFiles) + " files");
  if (bytes.size() > kMostBytesOfFile - bytes_)
    throw HttpFailure(413, "more than " + std::to_string(kMostBytesOfFile >> 20) + " MiB of files");
  const fs::path safe = safe_name(name);
  std::string unlike = safe.string();
  for (int i = 2; std::ranges::count(files_, unlike) > 0; ++i)
    unlike = safe.stem().string() + "-" + std::to_string(i) + safe.extension().string();
  write_file(folder_ / unlike, bytes);
  bytes_ += bytes.size();
  files_.push_back(unlike);
  return unlike;
}

void DraftSession::remove(const std::string& name) {
  const std::lock_guard lock(mutex_);
  const auto at = std::ranges::find(files_, name);
  if (at == files_.end()) throw HttpFailure(404, "no such file");
  bytes_ -= fs::file_size(folder_ / name);
  fs::remove(folder_ / name);
  files_.erase(at);
}

std::string DraftSession::take(const fs::path& run, const fs::path& root) {
  std::string problem = bytes_of(run / run_file::kProblem);
  for (const std::string& named : files_named(run / run_file::kProblem)) {
    std::error_code missing;
    const fs::path file = fs::canonical(run / named, missing);
    const bool is_inside = !missing && !file.lexically_relative(root).string().starts_with("..");
    if (!is_inside || !fs::is_regular_file(file)) continue;  // check says so
    rename_in(problem, named, add(file.filename().string(), bytes_of(file)));
  }
  return problem;
}

std::string DraftSession::questions(const std::string& given) {
  const std::lock_guard lock(mutex_);
  const Answers answers = answers_of(given);
  std::vector<fs::path> paths;
  for (const std::string& name : files_) paths.push_back(folder_ / name);
  if (paths.empty()) throw HttpFailure(400, "no file");
  try {
    Draft draft(paths);
    Json questions = Json::array(), files = Json::array();
    bool is_open = false;
    for (auto question = draft.next(); question; question = draft.next()) {
      questions.push_back(settled(draft, *question, answers));
      is_open = is_open || questions.back()["open"].get<bool>();
    }
    for (const DraftFile& file : draft.files()) files.push_back(json_of(file));
    return json_text({{"files", files},
                      {"questions", questions},
                      {"problem", is_open ? Json() : Json(draft.problem_text(folder_))}});
  } catch (const DataError& error) {
    throw DataError(without(folder_, error.what()));
  } catch (const UsageError& error) {
    throw UsageError(without(folder_, error.what()));
  }
}

std::string DraftSession::traces(const std::string& problem) {
  return with_problem(problem, [](const fs::path& folder) {
    Json out = Json::array();
    try {
      const Problem read = read_problem(folder / run_file::kProblem);
      for (const ProfileEntry& entry : read.profiles) {
        const Trace trace = read_trace(entry.source.path, entry.source.request).trace;
        const auto known = [](const std::string& stated, const std::string& given) {
          return given.empty() ? stated : given;
        };
        out.push_back(json_of(entry.profile.name, trace));
        out.back()["position_unit"] = known(trace.position_unit, entry.source.position_unit);
        out.back()["value_unit"] = known(trace.value_unit, entry.source.value_unit);
      }
    } catch (const DataError& error) {
      throw DataError(without(folder, error.what()));
    } catch (const UsageError& error) {
      throw UsageError(without(folder, error.what()));
    }
    return json_text(out);
  });
}

void DraftSession::write_problem(const std::string& problem) const {
  write_file(folder_ / run_file::kProblem, problem);
  for (const std::string& named : files_named(folder_ / run_file::kProblem))
    if (std::ranges::count(files_, named) == 0)
      throw UsageError("problem.toml: file '" + printable(named, 64) +
                       "' is not among the files of this page; accepted: " +
                       (files_.empty() ? "add it above" : joined(files_)));
}

void DraftSession::copy(const std::string& problem, const fs::path& folder) {
  with_problem(problem, [&](const fs::path& from) {
    for (const std::string& named : files_named(from / run_file::kProblem))
      if (const fs::path to = folder / named; !fs::exists(to))
        write_file(to, FileBytes::of_regular_file(from / named).text());
    write_file(folder / run_file::kProblem, problem);
  });
}

std::string Drafts::open() {
  const fs::path folder = workspace_.temporary();
  const std::lock_guard lock(mutex_);
  if (open_.size() >= kMostDrafts) open_.erase(open_.begin());
  open_.emplace_back(folder.filename().string(), std::make_shared<DraftSession>(folder));
  return open_.back().first;
}

std::shared_ptr<DraftSession> Drafts::at(const std::string& id) {
  const std::lock_guard lock(mutex_);
  const auto found = std::ranges::find(open_, id, &decltype(open_)::value_type::first);
  if (found == open_.end())
    throw HttpFailure(404, "these files are no longer open; add them again, or open their run");
  std::rotate(found, found + 1, open_.end());
  return open_.back().second;
}

}  // namespace slideway
