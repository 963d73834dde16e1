#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "json_parts.hpp"

/// What the page is put together from. Everything that comes out of a document goes through
/// escaped(); a number that got out of hand on the way is a DataError.
namespace slideway {

/// Text for HTML, also in attributes; control characters become U+FFFD.
std::string escaped(std::string_view text);

/// The string or number under a key, escaped. @throws Json::exception  it is not there, or neither
std::string text_of(const Json& object, const char* key);

/// A number or none where it is null or not there. @throws Json::exception  it is something else
std::optional<double> number_of(const Json& object, const char* key);

/// An array, empty where it is null or not there. @throws Json::exception  it is something else
const Json& list_of(const Json& object, const char* key);
std::vector<double> numbers_of(const Json& object, const char* key);
bool has(const Json& object, const char* key);  // and is not null

/// Numbers in words of HTML: a true minus, powers of ten raised. @throws DataError  not finite
std::string html_number(double value, int digits);
std::string html_pair(double value, double uncertainty);  // value ± uncertainty
std::string html_probability(double p);                   // "0.02", "< 10⁻⁴"
std::string html_p_value(double p);                       // "p = 0.02", "p < 10⁻⁴"

/// "mm^-1" with its exponent raised, "um" as µm; "" for a bare number.
std::string html_unit(std::string_view unit);
/// "b_2" with its index lowered.
std::string html_symbol(std::string_view symbol);

/// A number with its unit from a pair of keys, "rms_um" and "rms_urad": "0.2 µm", or "–".
std::string html_size(const Json& object, const std::string& name, int digits = 3);

/// "p" and 2: "p2".
std::string numbered(std::string stem, std::size_t number);

inline constexpr std::size_t kStyles = 8;  // "e0" ... of the page's style

/// A number or "–".
std::string html_cell(const Json& object, const char* key, int digits = 4);

/// A picture with its caption, both HTML.
std::string html_figure(const std::string& picture, const std::string& caption,
                        const std::string& attributes = "");

/// A table that scrolls in itself where the screen is narrow.
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
std::string html_verdict(const Json& report);
std::string html_pictures(const Json& report);
std::string html_profile_pictures(const Json& report);
std::string html_tables(const Json& report);
std::string html_uncertainty(const Json& report);
std::string html_loop_tables(const Json& report);

}  // namespace slideway
