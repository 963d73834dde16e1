#include "slideway/report/certificate.hpp"

#include <gmock/gmock.h>

#include <pugixml.hpp>

#include "sample_result.hpp"
#include "slideway/base/error.hpp"

/// Names and order of the elements are those that the published schema has: dcc.xsd 3.2.0
/// (digitalCalibrationCertificateType and the types under it) and SI_Format.xsd 2.1.0
/// (realQuantityType, expandedUncType).
namespace slideway::certificate_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Analysis sample_analysis() {
  Analysis analysis{sample_result()};
  analysis.result.about = {{"certificate", "2026-17"},
                           {"country", "DE"},
                           {"date", "2026-11-20"},
                           {"evaluated", "2026-11-23"},
                           {"place", "customer"},
                           {"machine", "LT-3"},
                           {"serial", "4711"},
                           {"manufacturer", "Lathe Works"},
                           {"laboratory", "Test room, 1 Main Street, Aachen"},
                           {"customer", "Turned Parts Ltd, Bonn"},
                           {"responsible", "A. <Person> & B"},
                           {"instrument", "PGI"},
                           {"instrument_serial", "12"},
                           {"calibrated", "2026-01-02"},
                           {"conditions", "20.1 °C"}};
  Conformity flat;
  flat.what = "flatness";
  flat.value_um = 2.95;
  flat.U_um = 0.1;
  flat.limit_um = 3.0;
  analysis.result.conformity = {flat};
  return analysis;
}

pugi::xml_document parsed(const Analysis& analysis) {
  pugi::xml_document out;
  EXPECT_TRUE(out.load_string(calibration_certificate(analysis).c_str()));
  return out;
}

std::vector<std::string> children(const pugi::xml_document& document, const std::string& path) {
  std::vector<std::string> names;
  const std::string whole = "/dcc:digitalCalibrationCertificate" + path;
  for (const pugi::xml_node child : document.select_node(whole.c_str()).node())
    names.emplace_back(child.name());
  return names;
}

std::string text_at(const pugi::xml_document& document, const std::string& path) {
  return document.select_node(path.c_str()).node().text().get();
}

std::string refusal(const Analysis& analysis) {
  try {
    calibration_certificate(analysis);
  } catch (const DataError& error) {
    return error.what();
  }
  return "";
}

TEST(Certificate, HasTheElementsOfSchema320InTheirOrder) {
  const pugi::xml_document document = parsed(sample_analysis());
  const pugi::xml_node root = document.document_element();
  EXPECT_STREQ(root.name(), "dcc:digitalCalibrationCertificate");
  EXPECT_STREQ(root.attribute("schemaVersion").value(), "3.2.0");
  EXPECT_STREQ(root.attribute("xmlns:dcc").value(), "https://ptb.de/dcc");
  EXPECT_STREQ(root.attribute("xmlns:si").value(), "https://ptb.de/si");
  EXPECT_THAT(children(document, ""),
              ElementsAre("dcc:administrativeData", "dcc:measurementResults"));
  const std::string data = "/dcc:administrativeData";
  EXPECT_THAT(children(document, data), ElementsAre("dcc:dccSoftware", "dcc:coreData", "dcc:items",
                                                    "dcc:calibrationLaboratory", "dcc:respPersons",
                                                    "dcc:customer", "dcc:statements"));
  EXPECT_THAT(children(document, data + "/dcc:dccSoftware/dcc:software"),
              ElementsAre("dcc:name", "dcc:release", "dcc:type"));
  EXPECT_THAT(children(document, data + "/dcc:coreData"),
              ElementsAre("dcc:countryCodeISO3166_1", "dcc:usedLangCodeISO639_1",
                          "dcc:mandatoryLangCodeISO639_1", "dcc:uniqueIdentifier",
                          "dcc:beginPerformanceDate", "dcc:endPerformanceDate",
                          "dcc:performanceLocation", "dcc:issueDate"));
  EXPECT_THAT(children(document, data + "/dcc:items/dcc:item"),
              ElementsAre("dcc:name", "dcc:manufacturer", "dcc:identifications"));
  EXPECT_THAT(children(document, data + "//dcc:item//dcc:identification"),
              ElementsAre("dcc:issuer", "dcc:value", "dcc:name"));
  EXPECT_THAT(children(document, data + "/dcc:calibrationLaboratory/dcc:contact"),
              ElementsAre("dcc:name", "dcc:location"));
  EXPECT_THAT(children(document, data + "/dcc:respPersons/dcc:respPerson"),
              ElementsAre("dcc:person", "dcc:mainSigner"));
  EXPECT_THAT(children(document, data + "/dcc:statements/dcc:statement"),
              ElementsAre("dcc:name", "dcc:norm", "dcc:declaration", "dcc:conformity"));
}

TEST(Certificate, HasResultsWithMethodSoftwareEquipmentAndConditionsInTheirOrder) {
  const pugi::xml_document document = parsed(sample_analysis());
  const std::string result = "/dcc:measurementResults/dcc:measurementResult";
  EXPECT_THAT(children(document, result),
              ElementsAre("dcc:name", "dcc:description", "dcc:usedMethods", "dcc:usedSoftware",
                          "dcc:measuringEquipments", "dcc:influenceConditions", "dcc:results"));
  EXPECT_THAT(children(document, result + "/dcc:usedMethods/dcc:usedMethod"),
              ElementsAre("dcc:name", "dcc:description", "dcc:norm", "dcc:norm"));
  EXPECT_THAT(children(document, result + "//dcc:measuringEquipment"),
              ElementsAre("dcc:name", "dcc:description", "dcc:identifications"));
  EXPECT_THAT(children(document, result + "//dcc:influenceCondition"),
              ElementsAre("dcc:name", "dcc:data"));
  EXPECT_THAT(children(document, result + "/dcc:results"), ElementsAre("dcc:result", "dcc:result"));
  EXPECT_THAT(children(document, result + "/dcc:results/dcc:result"),
              ElementsAre("dcc:name", "dcc:data"));
  EXPECT_THAT(children(document, result + "//dcc:quantity"), ElementsAre("dcc:name", "si:real"));
  EXPECT_THAT(children(document, result + "//si:real"),
              ElementsAre("si:value", "si:unit", "si:expandedUnc"));
  EXPECT_THAT(children(document, result + "//si:expandedUnc"),
              ElementsAre("si:uncertainty", "si:coverageFactor", "si:coverageProbability"));
}

// 2.8e-6 rad with U = 2.2e-9 is 2.8 µrad with U = 0.0022 µrad; two digits of U (GUM 7.2.6).
TEST(Certificate, GivesTheFinalValuesWithTheirUncertainty) {
  const pugi::xml_document document = parsed(sample_analysis());
  const std::string angle = "//dcc:result[2]//si:real";
  EXPECT_EQ(text_at(document, angle + "/si:value"), "2.8000");
  EXPECT_EQ(text_at(document, angle + "/si:unit"), "\\micro\\radian");
  EXPECT_EQ(text_at(document, angle + "//si:uncertainty"), "0.0022");
  EXPECT_EQ(text_at(document, angle + "//si:coverageFactor"), "2.00");
  EXPECT_EQ(text_at(document, angle + "//si:coverageProbability"), "0.9545");
  EXPECT_EQ(text_at(document, "//dcc:result[1]//si:value"), "0.300");
  EXPECT_EQ(text_at(document, "//dcc:result[1]//si:unit"), "\\micro\\metre");
  EXPECT_EQ(text_at(document, "//dcc:person//dcc:content"), "A. <Person> & B");
  EXPECT_EQ(text_at(document, "//dcc:performanceLocation"), "customer");
}

// 2.95 ± 0.1 against 3: within the limit, not within it by U.
TEST(Certificate, SaysOnWhichSideOfTheLimitAnUndecidedValueLies) {
  EXPECT_EQ(text_at(parsed(sample_analysis()), "//dcc:conformity"), "conditionalPass");
}

TEST(Certificate, NamesAllKeysThatAreMissingInOneLine) {
  Analysis analysis = sample_analysis();
  analysis.result.about.erase("customer");
  analysis.result.about["serial"] = "";
  EXPECT_EQ(refusal(analysis),
            "[about] lacks serial, customer; a calibration certificate must have them");
}

TEST(Certificate, RefusesADateACountryAndAnAddressThatAreNone) {
  for (const auto& [key, value] :
       {std::pair("date", "yesterday"), std::pair("date", "2026-02-30"),
        std::pair("country", "Germany"), std::pair("customer", "Turned Parts Ltd")}) {
    Analysis analysis = sample_analysis();
    analysis.result.about[key] = value;
    EXPECT_THAT(refusal(analysis), HasSubstr(std::string("[about] ") + key + ": "));
  }
}

TEST(Certificate, RefusesAResultInWhichNothingIsDetermined) {
  Analysis analysis = sample_analysis();
  analysis.result.final = std::nullopt;
  EXPECT_THAT(refusal(analysis), HasSubstr("neither straightness nor squareness"));
}

TEST(Certificate, SaysUnderWhichConditionAValueHolds) {
  Analysis analysis = sample_analysis();
  Conformity& angle = analysis.result.conformity.emplace_back();
  angle.what = "squareness";
  angle.value_um_per_m = 2.8;
  angle.limit_um_per_m = 5.0;
  angle.verdict = ConformityVerdict::conforms;
  angle.if_no = {"linear_drift"};
  for (FittedParameter& parameter : analysis.result.final->parameters)
    if (parameter.name == "squareness.dbeta_xz") parameter.if_no = angle.if_no;
  const std::string text = calibration_certificate(analysis);
  EXPECT_THAT(text, HasSubstr("squareness conforms, if no steady drift"));
  EXPECT_THAT(text, HasSubstr("Squareness of X to the spindle axis, if no steady drift"));
}

}  // namespace
}  // namespace slideway::certificate_test
