#include "slideway/report/layout.hpp"

#include <algorithm>
#include <numeric>
#include <optional>

namespace slideway {
namespace {

constexpr std::size_t kGap = 2, kShortestName = 8;

bool starts_code_point(char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }

/// Byte at which the code point number `count` starts.
std::size_t byte_of(std::string_view text, std::size_t count) {
  std::size_t byte = 0;
  while (byte < text.size()) {
    if (starts_code_point(text[byte]) && count-- == 0) break;
    ++byte;
  }
  return byte;
}

std::string shortened(const std::string& text, std::size_t width) {
  const std::size_t length = code_points(text);
  if (length <= width) return text;
  const std::size_t tail = (width - 1) / 2;
  const std::size_t head = width - 1 - tail;
  return text.substr(0, byte_of(text, head)) + "…" + text.substr(byte_of(text, length - tail));
}

std::string_view next_word(std::string_view& words) {
  const std::size_t first = std::min(words.find_first_not_of(" \n\t\r"), words.size());
  words.remove_prefix(first);
  const std::string_view word = words.substr(0, words.find_first_of(" \n\t\r"));
  words.remove_prefix(word.size());
  return word;
}

}  // namespace

std::size_t code_points(std::string_view utf8) {
  return static_cast<std::size_t>(std::count_if(utf8.begin(), utf8.end(), starts_code_point));
}

std::string paragraph(std::string_view first, std::string_view words) {
  const std::size_t indent = code_points(first);
  std::string text(first);
  std::size_t column = indent;
  const auto new_line = [&] {
    text += '\n';
    text.append(indent, ' ');
    column = indent;
  };
  for (std::string_view word = next_word(words); !word.empty(); word = next_word(words)) {
    if (column > indent && column + 1 + code_points(word) > kLineWidth) new_line();
    if (column > indent) {
      text += ' ';
      ++column;
    }
    while (column + code_points(word) > kLineWidth) {
      const std::size_t bytes = byte_of(word, kLineWidth - column);
      text += word.substr(0, bytes);
      word.remove_prefix(bytes);
      new_line();
    }
    text += word;
    column += code_points(word);
  }
  return text + "\n";
}

TextTable::TextTable(std::vector<std::string> headings, std::vector<TextColumn> columns)
    : columns_(std::move(columns)), rows_{std::move(headings)} {}

std::vector<std::size_t> TextTable::widths() const {
  std::vector<std::size_t> widths(columns_.size(), 0);
  for (const auto& row : rows_)
    for (std::size_t i = 0; i < row.size(); ++i)
      widths[i] = std::max(widths[i], code_points(row[i]));
  const auto total = [&] {
    return std::accumulate(widths.begin(), widths.end(), kGap * widths.size());
  };
  while (total() > kLineWidth) {
    std::size_t* longest = nullptr;
    for (std::size_t i = 0; i < widths.size(); ++i)
      if (columns_[i] == TextColumn::name && widths[i] > kShortestName &&
          (longest == nullptr || widths[i] > *longest))
        longest = &widths[i];
    if (longest == nullptr) break;
    --*longest;
  }
  return widths;
}

std::string TextTable::text() const {
  const std::vector<std::size_t> width = widths();
  std::vector<std::optional<std::size_t>> below(width.size());  // indent of a column that goes on
  std::size_t end = 0;
  for (std::size_t i = 0; i < width.size(); ++i) {
    const std::size_t size = std::min(kGap + width[i], kLineWidth);
    if (i > 0 && end + size > kLineWidth)
      end = *(below[i] = std::min(kGap + width[0], kLineWidth - size));
    end += size;
  }
  std::string text, line;
  const auto end_line = [&] {
    line.erase(line.find_last_not_of(' ') + 1);
    if (!line.empty())
      text += code_points(line) <= kLineWidth ? line + "\n" : paragraph("  ", line);
    line.clear();
  };
  for (const auto& row : rows_) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (below[i]) {
        end_line();
        line.append(*below[i], ' ');
      }
      const std::string cell = shortened(row[i], width[i]);
      const std::string blanks(width[i] - code_points(cell), ' ');
      line.append(kGap, ' ');
      line += columns_[i] == TextColumn::number ? blanks + cell : cell + blanks;
    }
    end_line();
  }
  return text;
}

}  // namespace slideway
