#include <algorithm>

#include "html_curves.hpp"
#include "html_parts.hpp"
#include "json_reader.hpp"
#include "slideway/base/error.hpp"
#include "slideway/report/report.hpp"
#include "slideway/trace/analysis_fields.hpp"
#include "text_parts.hpp"

namespace slideway {
namespace {

constexpr double kWidth = 720.0, kPanel = 300.0;  // of the picture

constexpr const char* kPictureStyle =
    "text{font:12px sans-serif;fill:#1b1d1f}.tick text{font-size:11px}.grid "
    "line{stroke:#d4d8dc;stroke-width:.8}polyline,line{fill:none;stroke-width:1.7;"
    "stroke-linejoin:round}.raw{stroke:#9aa0a6;stroke-width:.9}.low{stroke:#1b1d1f;"
    "stroke-width:1.3}circle{stroke:none}circle.low{fill:#1b1d1f}circle.before{fill:#d55e00}"
    "circle.after{fill:#0072b2}.before{stroke:#d55e00;stroke-dasharray:7 4}.after{stroke:#0072b2}";

Html panel(const Plot& plot, double top) {
  return plot.svg({{"x", "0"},
                   {"y", number(top, 4)},
                   {"width", number(kWidth, 4)},
                   {"height", number(kPanel, 4)}});
}

}  // namespace

std::string svg_report(const Analysis& analysis) {
  const std::optional<Curves>& curves = analysis.details.curves;
  if (!curves || curves->profiles.empty())
    throw DataError("has no curves to draw; accepted: a result written with --curves or --html");
  const ProfileCurves& shown = profile_to_show(*curves);
  return element("svg",
                 {{"xmlns", "http://www.w3.org/2000/svg"},
                  {"viewBox", "0 0 " + number(kWidth, 4) + " " + number(2.0 * kPanel, 4)},
                  {"width", number(kWidth, 4)},
                  {"height", number(2.0 * kPanel, 4)}},
                 element("style", Html::verbatim(kPictureStyle)) +
                     element("rect", {{"width", "100%"}, {"height", "100%"}, {"fill", "#ffffff"}}) +
                     "\n" + panel(form_panel(shown), 0.0) + panel(residual_panel(shown), kPanel))
      .markup();
}

std::string svg_report(std::string_view json, const std::string& name) {
  return read_document(json, name, {kReportSchema}, [](const Node& document) {
    Analysis analysis;
    read(document, analysis);
    return svg_report(analysis);
  });
}

}  // namespace slideway
