#include "html_parts.hpp"

#include <cmath>

#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/report/number.hpp"

namespace slideway {
namespace {

/// "1.5e-06" as 1.5 × 10⁻⁶, "-3" with a true minus.
std::string typeset(const std::string& text) {
  const std::size_t e = text.find('e');
  std::string out;
  for (const char c : text.substr(0, e)) out += c == '-' ? std::string("−") : std::string(1, c);
  if (e == std::string::npos) return out;
  std::string exponent = text.substr(e + 1);
  const bool negative = exponent.front() == '-';
  exponent.erase(0, std::min(exponent.find_first_not_of("+-0"), exponent.size() - 1));
  return out + "&nbsp;×&nbsp;10<sup>" + (negative ? "−" : "") + exponent + "</sup>";
}

}  // namespace

double finite(double value) {
  if (!std::isfinite(value))
    throw DataError("a number is beyond all measure; accepted: what --json of slideway writes");
  return value;
}

std::string escaped(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        if ((c >= 0 && c < ' ' && c != '\n' && c != '\t') || c == 0x7f)
          out += "\xEF\xBF\xBD";
        else
          out += c;
    }
  }
  return out;
}

std::string html_text(const Node& value) {
  return value.is_number() ? html_number(value.number(), 6) : escaped(value.verbatim());
}

std::string html_bold(std::string_view text) { return "<b>" + escaped(text) + "</b>"; }

std::vector<std::string> html_texts(const Node& texts) {
  std::vector<std::string> out;
  for (const Node& text : texts.entries()) out.push_back(escaped(text.verbatim()));
  return out;
}

std::string html_number(double value, int digits) {
  return typeset(to_digits(finite(value), digits));
}

std::string html_pair(double value, double uncertainty) {
  if (!(finite(uncertainty) >= 0.0)) throw DataError("an uncertainty is negative");
  return typeset(with_uncertainty(finite(value), uncertainty));
}

std::string html_probability(double p) {
  return p < 1e-4 ? "&lt;&nbsp;10<sup>−4</sup>" : html_number(p, 2);
}

std::string html_p_value(double p) { return (p < 1e-4 ? "p " : "p = ") + html_probability(p); }

std::string html_unit(std::string_view unit) {
  if (unit == "1") return "";
  if (unit == "um") return "µm";
  if (unit == "urad") return "µrad";
  std::string text = escaped(unit);
  if (text.starts_with("um_")) text = "µm_" + text.substr(3);
  const std::size_t per = text.find("_per_");
  if (per != std::string::npos) text = text.substr(0, per) + "/" + text.substr(per + 5);
  const std::size_t power = text.find('^');
  if (power == std::string::npos) return text;
  return text.substr(0, power) + "<sup>" + typeset(text.substr(power + 1)) + "</sup>";
}

std::string html_symbol(std::string_view symbol) {
  const std::string text = escaped(symbol);
  const std::size_t index = text.find('_');
  if (index == std::string::npos) return "<i>" + text + "</i>";
  return "<i>" + text.substr(0, index) + "</i><sub>" + text.substr(index + 1) + "</sub>";
}

std::string html_unit(const Node& owner) { return html_unit(owner["unit"].verbatim()); }

std::string html_size(const Node& owner, const std::string& name, int digits) {
  for (const std::string unit : {"um", "urad"})
    if (const auto value = owner[name + "_" + unit].number_or_null())
      return html_number(*value, digits) + " " + html_unit(unit);
  return "–";
}

std::string html_change(const Node& before, const std::string& name_before, const Node& after,
                        const std::string& name_after) {
  for (const std::string unit : {"um", "urad"}) {
    const auto from = before[name_before + "_" + unit].number_or_null();
    const auto to = after[name_after + "_" + unit].number_or_null();
    if (from && to)
      return html_number(*from, 3) + " → " + html_number(*to, 3) + " " + html_unit(unit);
  }
  return "";
}

std::string numbered(std::string stem, std::size_t number) {
  return stem.append(std::to_string(number));
}

std::string html_cell(const Node& value, int digits) {
  return value.is_null() ? "–" : html_number(value.number(), digits);
}

std::string html_scroll(const std::string& body) {
  return "<div class=\"scroll\" tabindex=\"0\" role=\"group\">" + body + "</div>";
}

std::string html_figure(const std::string& picture, const std::string& caption,
                        const std::string& attributes) {
  return "<figure" + attributes + ">" + html_scroll(picture) + "<figcaption>" + caption +
         "</figcaption></figure>\n";
}

std::string html_each_profile(
    const Node& report, const std::string& prefix,
    const std::function<std::string(const Node&, const std::string&)>& picture) {
  if (!report.has("curves")) return "";
  std::string out;
  std::size_t index = 0;
  for (const Node& curves : report["curves"]["profiles"].entries())
    out += picture(curves, numbered(prefix, index++));
  return out;
}

HtmlTable::HtmlTable(std::string caption, std::vector<std::pair<std::string, Column>> columns)
    : caption_(std::move(caption)), columns_(std::move(columns)) {}

void HtmlTable::add(const std::vector<std::string>& cells) {
  rows_ += "<tr>";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string kind = columns_[i].second == Column::number ? " class=\"n\"" : "";
    rows_ += i == 0 ? "<th scope=\"row\"" + kind + ">" + cells[i] + "</th>"
                    : "<td" + kind + ">" + cells[i] + "</td>";
  }
  rows_ += "</tr>\n";
}

std::string HtmlTable::html() const {
  if (rows_.empty()) return "";
  std::string out = "<table><caption>" + caption_ + "</caption>\n<thead><tr>";
  for (const auto& [heading, column] : columns_)
    out += std::string("<th scope=\"col\"") + (column == Column::number ? " class=\"n\">" : ">") +
           heading + "</th>";
  return html_scroll(out + "</tr></thead>\n<tbody>\n" + rows_ + "</tbody></table>") + "\n";
}

std::string html_section(const std::string& id, const std::string& title, const std::string& body) {
  if (body.empty()) return "";
  return "<section id=\"" + id + "\" aria-labelledby=\"" + id + "-h\">\n<h2 id=\"" + id + "-h\">" +
         title + "</h2>\n" + body + "</section>\n";
}

std::string html_list(const std::vector<std::string>& items) {
  if (items.empty()) return "";
  std::string out = "<ul>\n";
  for (const std::string& item : items) out += "<li>" + item + "</li>\n";
  return out + "</ul>\n";
}

}  // namespace slideway
