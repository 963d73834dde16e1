#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "html.hpp"
#include "html_plot.hpp"
#include "slideway/trace/analysis.hpp"
#include "summary.hpp"

/// What the page is put together from.
namespace slideway {

class Node;

Html bold(std::string_view text);
Html small(const Html& content);
/// A quantity's symbol: "b_2" with its index lowered.
Html html_symbol(std::string_view symbol);

/// Numbers in words of HTML: a true minus, powers of ten raised; "–" for one that is absent or not
/// finite.
Html html_number(const std::optional<double>& value, int digits = 4);
Html html_value(const QuantityValue& result, double unit = 1.0);  // as value_text()
Html html_en(const std::optional<double>& En);
Html html_probability(double p);  // "0.02", "< 10⁻⁴"
Html html_p_value(double p);      // "p = 0.02", "p < 10⁻⁴"

/// "mm^-1" with its exponent raised, "um" as µm; nothing for a bare number.
Html html_unit(std::string_view unit);
std::string unit_name(MicroUnit unit);

/// Of a pair of numbers such as rms_um and rms_urad the one that is there, with its unit, or "–".
Html html_size(const std::optional<double>& um, const std::optional<double>& urad);

/// "p" and 2: "p2".
std::string numbered(std::string stem, std::size_t number);

inline constexpr std::size_t kStyles = 8;  // "e0" ... of the page's style

/// A box that scrolls in itself where the screen is narrow.
Html html_scroll(const Html& body);

/// A picture with its caption; nothing where the picture is empty.
Html html_figure(const Plot& plot, const Html& caption);
Html html_figure(const Html& picture, const Html& caption, const HtmlAttributes& attributes = {});

enum class HtmlColumn { text, number };

/// A table in such a box; nothing without rows.
class HtmlTable {
 public:
  HtmlTable(Html caption, std::vector<std::pair<Html, HtmlColumn>> columns)
      : caption_(std::move(caption)), columns_(std::move(columns)) {}

  /// The first cell heads the row.
  void add(const std::vector<Html>& cells);
  [[nodiscard]] bool empty() const { return rows_.empty(); }
  [[nodiscard]] Html html() const;

 private:
  Html caption_;
  std::vector<std::pair<Html, HtmlColumn>> columns_;
  Html rows_;
};

Html html_list(const std::vector<Html>& items);
Html html_list(const std::vector<std::string>& items);

/// The pictures of each profile, of its curves and an id that starts with the prefix.
Html html_each_profile(
    const Analysis& analysis, const std::string& prefix,
    const std::function<Html(const ProfileCurves& curves, const std::string& id)>& picture);

/// A section of the page; without a body it is left out.
struct HtmlSection {
  std::string id, title;
  Html body;
};
using HtmlSections = std::vector<HtmlSection>;

/// A page of the sections that have a body, with links to them.
std::string page_of(const std::string& title, const std::string& subtitle, const Html& about,
                    const HtmlSections& sections);

/// The page of a brief report. @throws DataError  what it says is of the wrong type
std::string html_brief(const Node& report);

/// Who measured what, with which instrument: [about] on a line.
Html html_about(const Result& result);
/// False of a report on slides alone: its page speaks of no face.
bool has_face(const Result& result);
/// Results held against the tolerances; nothing without a tolerance.
Html html_conformity(const Result& result);

/// The sections of a report, in the order of the page.

HtmlSection html_verdict(const Analysis& analysis);
HtmlSection html_profiles(const Analysis& analysis);
HtmlSection html_straightness(const Analysis& analysis);
HtmlSection html_correlation(const Analysis& analysis);
HtmlSection html_residual(const Analysis& analysis);
HtmlSection html_face(const Analysis& analysis);
HtmlSection html_certificate(const Analysis& analysis);
HtmlSection html_bands(const Analysis& analysis);
HtmlSection html_what_if(const Analysis& analysis);
HtmlSection html_uncertainty(const Analysis& analysis);
HtmlSection html_identifiability(const Analysis& analysis);
HtmlSection html_loop(const Analysis& analysis);
HtmlSection html_data(const Analysis& analysis);
HtmlSection html_method(const Analysis& analysis);

}  // namespace slideway
