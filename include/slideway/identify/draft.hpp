#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "slideway/format/format.hpp"

namespace slideway {

/// A data file as far as it explains itself.
struct DraftFile {
  std::filesystem::path path;
  std::string name;                         // of its profile
  std::string format;                       // "text", "X3P"
  std::string decision;                     // how a text is written, in words
  std::vector<std::string> columns, units;  // of a text: header names, and units it states
  std::optional<Trace> trace;               // once its columns are known
};

/// What only the workshop knows, or what a guess should be confirmed of.
struct DraftQuestion {
  std::string key;       // "feed", the option --feed
  std::size_t file = 0;  // which it is about; of a question about the machine: 0
  std::string words;     // "How fast did the tool cross the face?"
  std::string accepted;  // "mm/min, or unknown"
  std::string picture;   // lines that explain it; "": none
  std::string fallback;  // an answer after which the fewest questions follow
  std::string guess;     // an answer that fits what was read; "": none
  std::string why;       // reason of the guess
  bool certain = false;  // the guess needs no confirmation
};

/// A problem in the making: data files, and answers of a person to the questions they leave open.
class Draft {
 public:
  /// Every key a question can have, in their order.
  static const std::vector<std::string>& keys();
  /// Whether a question is about each file, not about the machine.
  static bool is_of_file(const std::string& key);

  /// @throws DataError, UsageError  a file that cannot be read
  explicit Draft(const std::vector<std::filesystem::path>& files);

  /// The first question without an answer; nothing: the problem can be written.
  [[nodiscard]] std::optional<DraftQuestion> next();

  /// @throws UsageError  the answer is none; "what was said: accepted: ..."
  void answer(const DraftQuestion& question, const std::string& text);

  [[nodiscard]] const std::vector<DraftFile>& files() const { return files_; }

  /// The problem file, with comments, for a file in `folder`. REQUIRES every answer.
  [[nodiscard]] std::string problem_text(const std::filesystem::path& folder) const;

 private:
  [[nodiscard]] std::optional<std::string> said(const std::string& key, std::size_t file) const;
  [[nodiscard]] std::optional<DraftQuestion> question(const std::string& key, std::size_t file);
  [[nodiscard]] std::string profile_text(std::size_t file, int common_level,
                                         const std::filesystem::path& folder) const;
  [[nodiscard]] int level_of(std::size_t file) const;
  [[nodiscard]] bool has_face() const;
  void read_trace_of(std::size_t file);

  std::vector<DraftFile> files_;
  std::vector<std::map<std::string, std::string>> answers_;  // by key, of each file
};

}  // namespace slideway
