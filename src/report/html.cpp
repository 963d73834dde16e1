#include "html.hpp"

#include <algorithm>
#include <array>

namespace slideway {
namespace {

/// Elements that hold nothing and have no closing tag.
constexpr std::array<std::string_view, 8> kEmpty{"br",   "circle",  "line",     "meta",
                                                 "path", "polygon", "polyline", "rect"};
/// Elements that end a line, so that a page can be read and compared.
constexpr std::array<std::string_view, 12> kBlocks{
    "div", "figure", "h2", "li", "line", "nav", "p", "polygon", "polyline", "section", "svg", "tr"};

}  // namespace

Html::Html(std::string_view text) {
  markup_.reserve(text.size());
  for (const char c : text) {
    if (c == '&')
      markup_ += "&amp;";
    else if (c == '<')
      markup_ += "&lt;";
    else if (c == '>')
      markup_ += "&gt;";
    else if (c == '"')
      markup_ += "&quot;";
    else if (c == '\'')
      markup_ += "&#39;";
    else if ((c >= 0 && c < ' ' && c != '\n' && c != '\t') || c == 0x7f)
      markup_ += "\xEF\xBF\xBD";
    else
      markup_ += c;
  }
}

Html Html::verbatim(std::string_view markup) {
  Html out;
  out.markup_ = markup;
  return out;
}

Html element(std::string_view name, const HtmlAttributes& attributes, const Html& content) {
  std::string markup = "<" + std::string(name);
  for (const auto& [key, value] : attributes)
    markup.append(" ").append(key).append("=\"").append(Html(value).markup()).append("\"");
  if (std::ranges::find(kEmpty, name) != kEmpty.end())
    markup += "/>";
  else
    markup.append(">").append(content.markup()).append("</").append(name).append(">");
  if (std::ranges::find(kBlocks, name) != kBlocks.end()) markup += "\n";
  return Html::verbatim(markup);
}

Html element(std::string_view name, const Html& content) { return element(name, {}, content); }

Html svg_element(const Picture& picture, const Html& content, const HtmlAttributes& more) {
  HtmlAttributes attributes{{"role", "img"},
                            {"aria-labelledby", picture.id + "-t " + picture.id + "-d"},
                            {"viewBox", "0 0 " + picture.width + " " + picture.height}};
  attributes.insert(attributes.end(), more.begin(), more.end());
  return element("svg", attributes,
                 element("title", {{"id", picture.id + "-t"}}, picture.title) +
                     element("desc", {{"id", picture.id + "-d"}}, picture.description) + content);
}

Html joined(const std::vector<Html>& pieces, const Html& separator) {
  Html out;
  for (const Html& piece : pieces) {
    if (!out.empty()) out += separator;
    out += piece;
  }
  return out;
}

}  // namespace slideway
