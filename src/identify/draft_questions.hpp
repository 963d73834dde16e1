#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>

#include "slideway/identify/draft.hpp"

namespace slideway {

/// What is known when a question is asked.
struct DraftState {
  const DraftFile& file;
  const std::map<std::string, std::string>& answers;  // of this file, and of the machine
  bool has_face;

  [[nodiscard]] std::string said(const std::string& key) const {
    const auto at = answers.find(key);
    return at == answers.end() ? "" : at->second;
  }
};

/// One question of `init`.
struct QuestionRule {
  const char* key;
  bool of_file;
  const char *words, *accepted, *picture;
  const char* fallback;  // an answer that asks nothing more
  bool (*applies)(const DraftState&);
  void (*guess)(const DraftState&, DraftQuestion&);
  /// The answer as it is kept; nothing: it is none.
  std::optional<std::string> (*read)(const DraftState&, const std::string& text);
};

std::span<const QuestionRule> question_rules();

}  // namespace slideway
