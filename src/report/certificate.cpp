#include "slideway/report/certificate.hpp"

#include <algorithm>
#include <cmath>
#include <pugixml.hpp>
#include <sstream>

#include "slideway/base/date.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"
#include "slideway/identify/result_fields.hpp"
#include "slideway/report/number.hpp"
#include "summary.hpp"
#include "text_parts.hpp"

/// Order and names of the elements are those of dcc.xsd 3.2.0 and SI_Format.xsd 2.1.0.
namespace slideway {
namespace {

using XmlNode = pugi::xml_node;

constexpr const char* kSchemaVersion = "3.2.0";
constexpr const char* kCoverageProbability = "0.9545";
/// Keys of [about] that dcc.xsd has no way to leave out.
constexpr const char* kRequired[] = {"certificate", "country",  "date",
                                     "machine",     "serial",   "manufacturer",
                                     "laboratory",  "customer", "responsible"};

XmlNode add(XmlNode parent, const char* name, const std::string& text) {
  XmlNode out = parent.append_child(name);
  out.text().set(text.c_str());
  return out;
}

/// A text in one language, dcc:textType and dcc:richContentType.
void say(XmlNode parent, const char* name, const std::string& text) {
  add(parent.append_child(name), "dcc:content", text).append_attribute("lang").set_value("en");
}

bool is_capital(char c) { return c >= 'A' && c <= 'Z'; }

class Certificate {
 public:
  explicit Certificate(const Analysis& analysis)
      : result_(analysis.result), summary_(summary_of(analysis)) {
    require();
  }

  [[nodiscard]] std::string text() const {
    pugi::xml_document document;
    XmlNode declaration = document.append_child(pugi::node_declaration);
    declaration.append_attribute("version").set_value("1.0");
    declaration.append_attribute("encoding").set_value("UTF-8");
    XmlNode root = document.append_child("dcc:digitalCalibrationCertificate");
    const std::pair<const char*, std::string> attributes[] = {
        {"xmlns:dcc", "https://ptb.de/dcc"},
        {"xmlns:si", "https://ptb.de/si"},
        {"xmlns:xsi", "http://www.w3.org/2001/XMLSchema-instance"},
        {"xsi:schemaLocation",
         std::string("https://ptb.de/dcc https://ptb.de/dcc/v") + kSchemaVersion + "/dcc.xsd"},
        {"schemaVersion", kSchemaVersion}};
    for (const auto& [name, value] : attributes)
      root.append_attribute(name).set_value(value.c_str());
    add_administration(root.append_child("dcc:administrativeData"));
    add_results(root.append_child("dcc:measurementResults"));
    std::ostringstream out;
    document.save(out, "  ");
    return out.str();
  }

 private:
  [[nodiscard]] std::string about(const std::string& key) const {
    const auto found = result_.about.find(key);
    return found == result_.about.end() ? "" : found->second;
  }

  void require() const {
    std::vector<std::string> missing;
    for (const char* const key : kRequired)
      if (about(key).empty()) missing.emplace_back(key);
    if (!missing.empty())
      throw DataError("[about] lacks " + joined(missing) +
                      "; a calibration certificate must have them");
    if (!parse_date(about("date")))
      throw DataError("[about] date: '" + printable(about("date")) +
                      "' is no date; accepted: as 2026-11-23");
    const std::string country = about("country");
    if (country.size() != 2 || !std::ranges::all_of(country, is_capital))
      throw DataError("[about] country: '" + printable(country) +
                      "' is no country code; accepted: two capital letters, as DE");
    for (const char* const key : {"laboratory", "customer"}) {
      const std::size_t comma = about(key).find(", ");
      if (comma == 0 || comma == std::string::npos || comma + 2 == about(key).size())
        throw DataError(std::string("[about] ") + key +
                        ": has no address; accepted: \"name, address\"");
    }
  }

  /// "name, address", dcc:contactType.
  void add_contact(XmlNode contact, const char* key) const {
    const std::string text = about(key);
    const std::size_t comma = text.find(", ");
    say(contact, "dcc:name", text.substr(0, comma));
    say(contact.append_child("dcc:location"), "dcc:further", text.substr(comma + 2));
  }

  void add_software(XmlNode list) const {
    XmlNode software = list.append_child("dcc:software");
    say(software, "dcc:name", "slideway");
    add(software, "dcc:release", result_.version);
    add(software, "dcc:type", "application");
  }

  void add_core(XmlNode core) const {
    add(core, "dcc:countryCodeISO3166_1", about("country"));
    add(core, "dcc:usedLangCodeISO639_1", "en");
    add(core, "dcc:mandatoryLangCodeISO639_1", "en");
    add(core, "dcc:uniqueIdentifier", about("certificate"));
    add(core, "dcc:beginPerformanceDate", about("date"));
    add(core, "dcc:endPerformanceDate", about("date"));
    const std::string place = about("place");
    const bool is_named = place == "laboratory" || place == "customer";
    add(core, "dcc:performanceLocation", is_named ? place : "other");
    if (parse_date(about("evaluated"))) add(core, "dcc:issueDate", about("evaluated"));
  }

  static void add_serial(XmlNode owner, const std::string& serial) {
    XmlNode one = owner.append_child("dcc:identifications").append_child("dcc:identification");
    add(one, "dcc:issuer", "manufacturer");
    add(one, "dcc:value", serial);
    say(one, "dcc:name", "Serial number");
  }

  void add_item(XmlNode item) const {
    say(item, "dcc:name", about("machine"));
    if (!about("workpiece").empty())
      say(item, "dcc:description", "Workpiece: " + about("workpiece"));
    say(item.append_child("dcc:manufacturer"), "dcc:name", about("manufacturer"));
    add_serial(item, about("serial"));
  }

  /// ISO 14253-1, U as guard band; within the guard band the side of the limit is said.
  void add_statement(XmlNode list, const Conformity& each) const {
    XmlNode statement = list.append_child("dcc:statement");
    say(statement, "dcc:name", "Conformity of " + each.what);
    add(statement, "dcc:norm", "ISO 14253-1");
    say(statement, "dcc:declaration",
        each.what + " " + verdict_text(each.verdict) + condition(result_, each));
    const double value = (each.value_um ? each.value_um : each.value_um_per_m).value_or(INFINITY);
    const double limit = (each.limit_um ? each.limit_um : each.limit_um_per_m).value_or(0.0);
    add(statement, "dcc:conformity",
        each.verdict == ConformityVerdict::conforms           ? "pass"
        : each.verdict == ConformityVerdict::does_not_conform ? "fail"
        : std::abs(value) <= limit                            ? "conditionalPass"
                                                              : "conditionalFail");
  }

  void add_administration(XmlNode data) const {
    add_software(data.append_child("dcc:dccSoftware"));
    add_core(data.append_child("dcc:coreData"));
    add_item(data.append_child("dcc:items").append_child("dcc:item"));
    add_contact(data.append_child("dcc:calibrationLaboratory").append_child("dcc:contact"),
                "laboratory");
    XmlNode person = data.append_child("dcc:respPersons").append_child("dcc:respPerson");
    say(person.append_child("dcc:person"), "dcc:name", about("responsible"));
    add(person, "dcc:mainSigner", "true");
    add_contact(data.append_child("dcc:customer"), "customer");
    if (result_.conformity.empty()) return;
    XmlNode statements = data.append_child("dcc:statements");
    for (const Conformity& each : result_.conformity) add_statement(statements, each);
  }

  static void add_method(XmlNode list) {
    XmlNode method = list.append_child("dcc:usedMethod");
    say(method, "dcc:name", "Joint fit of the carriages' errors to measured profiles");
    say(method, "dcc:description",
        "Least squares with correlated noise; effects that the model lacked are identified from "
        "the residual and fitted with it. U = k u, k of Student's distribution.");
    add(method, "dcc:norm", "ISO 230-1");
    add(method, "dcc:norm", "JCGM 100");
  }

  void add_equipment(XmlNode equipment) const {
    say(equipment, "dcc:name", about("instrument"));
    if (!about("calibrated").empty())
      say(equipment, "dcc:description", "Calibrated: " + about("calibrated"));
    if (!about("instrument_serial").empty()) add_serial(equipment, about("instrument_serial"));
  }

  static void add_condition(XmlNode condition, const std::string& text) {
    say(condition, "dcc:name", "Conditions of the measurement");
    say(condition.append_child("dcc:data"), "dcc:text", text);
  }

  /// @return whether it is determined
  static bool add_quantity(XmlNode results, const std::string& name, const QuantityValue& value,
                           double unit, const char* unit_name) {
    if (!is_known(value) || !value.coverage_factor) return false;
    XmlNode result = results.append_child("dcc:result");
    say(result, "dcc:name", name);
    XmlNode quantity = result.append_child("dcc:data").append_child("dcc:quantity");
    say(quantity, "dcc:name", name);
    XmlNode real = quantity.append_child("si:real");
    const RoundedPair pair = rounded(*value.value / unit, *value.expanded_uncertainty / unit);
    add(real, "si:value", pair.value);
    add(real, "si:unit", unit_name);
    XmlNode U = real.append_child("si:expandedUnc");
    add(U, "si:uncertainty", pair.uncertainty);
    add(U, "si:coverageFactor", fixed_point(*value.coverage_factor, 2));
    add(U, "si:coverageProbability", kCoverageProbability);
    return true;
  }

  void add_results(XmlNode list) const {
    XmlNode all = list.append_child("dcc:measurementResult");
    say(all, "dcc:name", result_.title.empty() ? "Carriage errors" : result_.title);
    say(all, "dcc:description", summary_.badge + ": " + summary_.verdict + ".");
    add_method(all.append_child("dcc:usedMethods"));
    add_software(all.append_child("dcc:usedSoftware"));
    if (!about("instrument").empty())
      add_equipment(
          all.append_child("dcc:measuringEquipments").append_child("dcc:measuringEquipment"));
    if (!about("conditions").empty())
      add_condition(
          all.append_child("dcc:influenceConditions").append_child("dcc:influenceCondition"),
          about("conditions"));
    XmlNode results = all.append_child("dcc:results");
    bool any = false;
    if (result_.final && result_.final->straightness)
      for (const StraightnessError& error : result_.final->straightness->errors)
        any |=
            add_quantity(results,
                         "Straightness error E_ZX, " + std::string(text_of(error.line)) + " line" +
                             parts_beside(result_) + condition(result_.final->straightness->if_no),
                         error, 1.0, "\\micro\\metre");
    if (result_.final)
      for (const FittedParameter& p : result_.final->parameters)
        if (is_squareness(p))
          any |= add_quantity(results, "Squareness of X to the spindle axis" + condition(p.if_no),
                              p, kMicroradian, "\\micro\\radian");
    if (!any) throw DataError("neither straightness nor squareness is determined");
  }

  const Result& result_;
  Summary summary_;
};

}  // namespace

std::string calibration_certificate(const Analysis& analysis) {
  return Certificate(analysis).text();
}

}  // namespace slideway
