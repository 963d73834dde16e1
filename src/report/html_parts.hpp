#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "document_node.hpp"

/// What the page is put together from. Everything that comes out of a document goes through
/// escaped(); a number that got out of hand on the way is a DataError.
namespace slideway {

/// Text for HTML, also in attributes; control characters become U+FFFD.
std::string escaped(std::string_view text);

/// A text, escaped, or a number with six digits.
std::string html_text(const Node& value);
std::string html_bold(std::string_view text);  // escapes it
/// The texts of a list, escaped; none where it is null.
std::vector<std::string> html_texts(const Node& texts);

/// @throws DataError the number is not finite
double finite(double value);

/// Numbers in words of HTML: a true minus, powers of ten raised. @throws DataError  not finite
std::string html_number(double value, int digits);
std::string html_pair(double value, double uncertainty);  // value ± uncertainty
std::string html_probability(double p);                   // "0.02", "< 10⁻⁴"
std::string html_p_value(double p);                       // "p = 0.02", "p < 10⁻⁴"

/// "mm^-1" with its exponent raised, "um" as µm; "" for a bare number.
std::string html_unit(std::string_view unit);
std::string html_unit(const Node& owner);  // what its key "unit" says
/// "b_2" with its index lowered.
std::string html_symbol(std::string_view symbol);

/// A number with its unit from a pair of keys, "rms_um" and "rms_urad": "0.2 µm", or "–".
std::string html_size(const Node& owner, const std::string& name, int digits = 3);
/// The same of two, "0.2 → 0.05 µm"; "" where one of them is not known.
std::string html_change(const Node& before, const std::string& name_before, const Node& after,
                        const std::string& name_after);

/// "p" and 2: "p2".
std::string numbered(std::string stem, std::size_t number);

inline constexpr std::size_t kStyles = 8;  // "e0" ... of the page's style

/// A number or "–".
std::string html_cell(const Node& value, int digits = 4);

/// A box that scrolls in itself where the screen is narrow.
std::string html_scroll(const std::string& body);

/// A picture with its caption, both HTML.
std::string html_figure(const std::string& picture, const std::string& caption,
                        const std::string& attributes = "");

/// The pictures of each profile, of its curves and an id that starts with the prefix.
std::string html_each_profile(
    const Node& report, const std::string& prefix,
    const std::function<std::string(const Node& curves, const std::string& id)>& picture);

/// A table in such a box.
class HtmlTable {
 public:
  enum class Column { text, number };
  /// Headings are HTML; the first column's cells head their rows.
  HtmlTable(std::string caption, std::vector<std::pair<std::string, Column>> columns);
  void add(const std::vector<std::string>& cells);  // HTML
  [[nodiscard]] bool empty() const { return rows_.empty(); }
  [[nodiscard]] std::string html() const;  // "" without rows

 private:
  std::string caption_;
  std::vector<std::pair<std::string, Column>> columns_;
  std::string rows_;
};

std::string html_section(const std::string& id, const std::string& title, const std::string& body);
std::string html_list(const std::vector<std::string>& items);  // HTML; "" without items

/// The parts of the page, each from the whole document.
std::string html_verdict(const Node& report);
std::string html_pictures(const Node& report);
std::string html_profile_pictures(const Node& report);
std::string html_tables(const Node& report);
std::string html_uncertainty(const Node& report);
std::string html_loop(const Node& report);

}  // namespace slideway
