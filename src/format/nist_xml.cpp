#include "areal.hpp"
#include "numbers.hpp"
#include "registry.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"
#include "writable.hpp"
#include "xml.hpp"

// The XML exports of NIST's surface metrology algorithm testing system: DATA/DATAFILE with UNITS
// (of heights and spacing alike), NUMPOINTS, SPACING and the heights as blank-separated text.
namespace slideway {
namespace {

class NistXml final : public Format {
 public:
  [[nodiscard]] std::string_view name() const override { return "NIST XML"; }
  [[nodiscard]] std::span<const std::string_view> endings() const override {
    static constexpr std::string_view kEndings[] = {".xml"};
    return kEndings;
  }
  [[nodiscard]] bool is_writable() const override { return false; }
  [[nodiscard]] bool recognises(std::string_view bytes) const override {
    if (bytes.starts_with("\xef\xbb\xbf")) bytes.remove_prefix(3);
    const std::string_view start = trimmed(bytes.substr(0, 256));
    return start.starts_with("<?xml") || start.starts_with("<DATA");
  }
  [[nodiscard]] Trace read(std::string_view bytes, const TraceRequest& request) const override;
  [[nodiscard]] std::string write(const Trace& trace) const override;
};

Trace NistXml::read(std::string_view bytes, const TraceRequest& request) const {
  refuse_line(request, name());
  const auto document = parse_xml(bytes, Doctype::external_only, "XML");
  const pugi::xml_node file = element(*document, "DATA/DATAFILE", "XML");
  const auto field = [&](const char* key) { return text_of(element(file, key, "DATAFILE")); };

  Trace trace;
  trace.position_unit = trace.value_unit = field("UNITS");
  if (!length_unit(trace.value_unit))
    throw DataError("DATAFILE/UNITS: '" + printable(trace.value_unit) +
                    "' is no length; accepted: " + std::string(kLengthUnits));
  if (const std::string_view type = text_of(file.child("DATA_TYPE")); !type.empty() && type != "2D")
    throw DataError("DATAFILE/DATA_TYPE: '" + printable(type) + "'; accepted: 2D");
  trace.values =
      read_numbers(field("DATA_POINT_VALUES"), read_count(field("NUMPOINTS"), "DATAFILE/NUMPOINTS"),
                   "DATAFILE/DATA_POINT_VALUES");
  trace.positions =
      even_positions(trace.values.size(), 0.0, read_positive(field("SPACING"), "DATAFILE/SPACING"));
  return trace;
}

std::string NistXml::write(const Trace& trace) const {
  check_lengths(trace, name());
  check_complete(trace, name());
  const double spacing = spacing_from_zero(trace, name());
  std::string text = "<?xml version='1.0' encoding='UTF-8'?>\n<DATA>\n<DATAFILE>\n<UNITS>" +
                     trace.value_unit + "</UNITS>\n<NUMPOINTS>" +
                     std::to_string(trace.values.size()) + "</NUMPOINTS>\n<SPACING>" +
                     shortest(converted(spacing, trace.position_unit, trace.value_unit)) +
                     "</SPACING>\n<DATA_TYPE>2D</DATA_TYPE>\n<DATA_POINT_VALUES>";
  for (const double value : trace.values) text += shortest(value) + "\n";
  return text + "</DATA_POINT_VALUES>\n</DATAFILE>\n</DATA>";
}

}  // namespace

const Format& nist_xml_format() {
  static const NistXml kFormat;
  return kFormat;
}

}  // namespace slideway
