#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace slideway {

/// A piece of a page. Text that becomes one is escaped (control characters become U+FFFD); markup
/// comes of element() alone.
class Html {
 public:
  Html() = default;
  // NOLINTBEGIN(google-explicit-constructor): text stands beside elements.
  Html(std::string_view text);
  Html(const std::string& text) : Html(std::string_view(text)) {}
  Html(const char* text) : Html(std::string_view(text)) {}
  // NOLINTEND(google-explicit-constructor)

  /// Markup as it stands: style and script that are part of this program.
  static Html verbatim(std::string_view markup);

  Html& operator+=(const Html& more) {
    markup_ += more.markup_;
    return *this;
  }
  friend Html operator+(Html left, const Html& right) { return std::move(left += right); }

  [[nodiscard]] bool empty() const { return markup_.empty(); }
  [[nodiscard]] const std::string& markup() const { return markup_; }

 private:
  std::string markup_;
};

using HtmlAttributes = std::vector<std::pair<std::string_view, std::string>>;

/// <name attribute="value">content</name>, values escaped; without the closing tag where HTML and
/// SVG have none (br, meta, line, polyline, ...).
Html element(std::string_view name, const HtmlAttributes& attributes, const Html& content = {});
Html element(std::string_view name, const Html& content = {});

/// <svg> of width by height, with a title and a description that a screen reader reads.
struct Picture {
  std::string id, title, description;  // plain text
  std::string width, height;           // of its view box
};
Html svg_element(const Picture& picture, const Html& content, const HtmlAttributes& more = {});

/// The pieces in a row, with the separator between two of them.
Html joined(const std::vector<Html>& pieces, const Html& separator);

}  // namespace slideway
