#include "html_parts.hpp"

#include <algorithm>
#include <cmath>

#include "slideway/report/number.hpp"
#include "text_parts.hpp"

namespace slideway {
namespace {

/// "1.5e-06" as 1.5 × 10⁻⁶, "(-3 ± 1)e-06" likewise, with true minuses.
Html typeset(const std::string& text) {
  Html out;
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] == '-') {
      out += "−";
      ++at;
    } else if (text[at] == 'e') {
      const std::size_t end = std::min(text.find_first_not_of("+-0123456789", at + 1), text.size());
      const int exponent = std::stoi(text.substr(at + 1, end - at - 1));
      out += "\u00a0×\u00a010" +
             element("sup", (exponent < 0 ? "−" : "") + std::to_string(std::abs(exponent)));
      at = end;
    } else {
      const std::size_t end = std::min(text.find_first_of("-e", at), text.size());
      out += text.substr(at, end - at);
      at = end;
    }
  }
  return out;
}

}  // namespace

Html bold(std::string_view text) { return element("b", text); }
Html small(const Html& content) { return element("small", content); }

Html html_symbol(std::string_view symbol) {
  const std::size_t index = symbol.find('_');
  const Html letter = element("i", symbol.substr(0, index));
  return index == std::string_view::npos ? letter
                                         : letter + element("sub", symbol.substr(index + 1));
}

Html html_number(const std::optional<double>& value, int digits) {
  return value && std::isfinite(*value) ? typeset(to_digits(*value, digits)) : "–";
}

Html html_value(const QuantityValue& result, double unit) {
  const std::string text = value_text(result, unit);
  const bool is_number = text.find_first_not_of("0123456789()+-.e ±") == std::string::npos;
  return is_number ? typeset(text) : Html(text);
}

Html html_en(const std::optional<double>& En) {
  return En && std::isfinite(*En) ? typeset(en_text(*En)) : "–";
}

Html html_probability(double p) {
  return p < 1e-4 ? Html("<\u00a010") + element("sup", "−4") : html_number(p, 2);
}

Html html_p_value(double p) { return (p < 1e-4 ? "p " : "p = ") + html_probability(p); }

Html html_unit(std::string_view unit) {
  std::string text = unit_text(std::string(unit));
  if (text.starts_with("um_")) text.replace(0, 1, "µ");
  if (const std::size_t per = text.find("_per_"); per != std::string::npos)
    text.replace(per, 5, "/");
  const std::size_t power = text.find('^');
  if (power == std::string::npos) return text;
  return text.substr(0, power) + element("sup", typeset(text.substr(power + 1)));
}

std::string unit_name(MicroUnit unit) { return unit == MicroUnit::urad ? "µrad" : "µm"; }

Html html_size(const std::optional<double>& um, const std::optional<double>& urad) {
  if (um) return html_number(um, 3) + " µm";
  return urad ? html_number(urad, 3) + " µrad" : "–";
}

std::string numbered(std::string stem, std::size_t number) {
  return stem.append(std::to_string(number));
}

Html html_scroll(const Html& body) {
  return element("div", {{"class", "scroll"}, {"tabindex", "0"}, {"role", "group"}}, body);
}

Html html_figure(const Html& picture, const Html& caption, const HtmlAttributes& attributes) {
  return element("figure", attributes, html_scroll(picture) + element("figcaption", caption));
}

Html html_figure(const Plot& plot, const Html& caption) {
  return plot.empty() ? Html() : html_figure(plot.svg(), caption);
}

void HtmlTable::add(const std::vector<Html>& cells) {
  Html row;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    HtmlAttributes attributes;
    if (i == 0) attributes.emplace_back("scope", "row");
    if (columns_[i].second == HtmlColumn::number) attributes.emplace_back("class", "n");
    row += element(i == 0 ? "th" : "td", attributes, cells[i]);
  }
  rows_ += element("tr", row);
}

Html HtmlTable::html() const {
  if (rows_.empty()) return {};
  Html headings;
  for (const auto& [heading, column] : columns_) {
    HtmlAttributes attributes{{"scope", "col"}};
    if (column == HtmlColumn::number) attributes.emplace_back("class", "n");
    headings += element("th", attributes, heading);
  }
  return html_scroll(element("table", element("caption", caption_) +
                                          element("thead", element("tr", headings)) +
                                          element("tbody", rows_)));
}

bool has_face(const Result& result) {
  return std::ranges::any_of(result.inputs,
                             [](const InputSummary& in) { return in.kind == Kind::face; });
}

Html html_list(const std::vector<Html>& items) {
  Html out;
  for (const Html& item : items) out += element("li", item);
  return items.empty() ? out : element("ul", out);
}

Html html_list(const std::vector<std::string>& items) {
  return html_list(std::vector<Html>(items.begin(), items.end()));
}

}  // namespace slideway
