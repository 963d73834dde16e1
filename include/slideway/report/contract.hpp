#pragma once

#include <string>

/// What a report promises to who reads it, made of the lists of its members.
namespace slideway {

/// JSON Schema 2020-12 of a report: docs/report.schema.json.
std::string report_schema();

/// The same of the brief report in a line of batch results: docs/brief.schema.json.
std::string brief_schema();

/// The same of a plan: docs/plan.schema.json.
std::string plan_schema();

/// The report as Python dataclasses: src/python/slideway/report.py.
std::string report_classes();

}  // namespace slideway
