#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "workspace.hpp"

namespace slideway {

/// What the runs and batches of a folder say. Every name is checked: HttpFailure 404.
class ResultsView {
 public:
  explicit ResultsView(const Workspace& workspace) : workspace_(workspace) {}

  /// The runs and the batches, as JSON.
  std::string list();

  /// Two runs held against each other as `diff` does, with what each says first; as JSON.
  std::string difference(const std::string& a, const std::string& b);

  /// A run's compensation table in the format of a control.
  [[nodiscard]] std::string table(const std::string& run, const std::string& format) const;

  /// The lines of a batch's results, one row each, as JSON; the page of one of them.
  [[nodiscard]] std::string batch_rows(const std::string& name) const;
  [[nodiscard]] std::string batch_page(const std::string& name, const std::string& id) const;

 private:
  using Json = nlohmann::ordered_json;

  /// What a run's result says first; read again only when it has changed.
  Json brief_of(const std::filesystem::path& run);

  const Workspace& workspace_;
  std::mutex mutex_;
  std::map<std::filesystem::path, std::pair<std::filesystem::file_time_type, Json>> known_;
};

}  // namespace slideway
