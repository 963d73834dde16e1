#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

/// Plain text in at most kLineWidth columns. Widths are counted in code points (UTF-8).
namespace slideway {

inline constexpr std::size_t kLineWidth = 80;

std::size_t code_points(std::string_view utf8);

/// Words filled into lines; the first line starts with `first`, the others with as many blanks.
/// A word that fits on no line is broken. Ends with a newline.
std::string paragraph(std::string_view first, std::string_view words);

enum class TextColumn {
  text,   // flush left
  name,   // flush left; the middle is left out where the line would get too long
  number  // flush right
};

/// Aligned columns, two blanks of indent and two between columns. Columns that do not fit on the
/// line go on below the second one.
class TextTable {
 public:
  TextTable(std::vector<std::string> headings, std::vector<TextColumn> columns);

  /// REQUIRES cells.size() to be the number of columns.
  void add(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }

  [[nodiscard]] std::string text() const;

 private:
  [[nodiscard]] std::vector<std::size_t> widths() const;

  std::vector<TextColumn> columns_;
  std::vector<std::vector<std::string>> rows_;  // the first one are the headings
};

}  // namespace slideway
