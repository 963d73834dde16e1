#include "brief.hpp"
#include "contract_types.hpp"
#include "json_parts.hpp"
#include "slideway/report/contract.hpp"
#include "slideway/trace/analysis.hpp"
#include "slideway/trace/plan.hpp"

namespace slideway {
namespace {

using Described = ContractType::Kind;

Json schema_of(const ContractType& type);

Json all_of(const std::vector<ContractType>& types) {
  return array_of(types, [](const ContractType& type) { return schema_of(type); });
}

Json schema_unless_null(const ContractType& type) {
  switch (type.kind) {
    case Described::boolean:
      return Json::object({{"type", "boolean"}});
    case Described::number:  // null: not finite
      return Json::object({{"type", {"number", "null"}}});
    case Described::count:
      return Json::object({{"type", "integer"}, {"minimum", 0}});
    case Described::integer:
      return Json::object({{"type", "integer"}});
    case Described::text:
      return Json::object({{"type", "string"}});
    case Described::one_of:
      return Json::object({{"enum", type.texts}});
    case Described::list:
      return Json::object({{"type", "array"}, {"items", schema_of(type.of[0])}});
    case Described::map:
      return Json::object({{"type", "object"}, {"additionalProperties", schema_of(type.of[0])}});
    case Described::tuple:
      return Json::object({{"type", "array"},
                           {"prefixItems", all_of(type.of)},
                           {"minItems", type.of.size()},
                           {"maxItems", type.of.size()}});
    case Described::record:
      return Json::object({{"$ref", "#/$defs/" + std::string(type.record)}});
    case Described::any:
      break;
  }
  return Json::object();
}

Json schema_of(const ContractType& type) {
  Json schema = schema_unless_null(type);
  if (!type.or_null) return schema;
  if (type.kind == Described::one_of)
    schema["enum"].push_back(nullptr);
  else if (type.kind == Described::record)
    return Json::object({{"anyOf", Json::array({schema, Json::object({{"type", "null"}})})}});
  else if (!schema["type"].is_array())
    schema["type"] = Json::array({schema["type"], "null"});
  return schema;
}

/// Whether a brief report may lack the member.
bool may_be_absent(const ContractType& type) {
  const bool is_zero_absent = type.kind == Described::boolean || type.kind == Described::count ||
                              type.kind == Described::integer || type.kind == Described::text;
  return is_zero_absent || (type.or_null && type.kind != Described::record);
}

/// An object with the members of a record.
Json schema_of(const ContractRecord& record, bool is_brief = false) {
  Json properties = Json::object(), required = Json::array();
  for (const ContractMember& member : record.members) {
    Json own = schema_of(member.type);
    if (!member.doc.empty()) own["description"] = member.doc;
    properties[std::string(member.key)] = std::move(own);
    if (!is_brief || !may_be_absent(member.type)) required.push_back(member.key);
  }
  Json schema = Json::object({{"type", "object"}, {"description", record.doc}});
  schema["properties"] = std::move(properties);
  schema["required"] = std::move(required);
  return schema;
}

/// What brief_digits() leaves of the records.
std::vector<ContractRecord> brief_records() {
  std::vector<ContractRecord> out = report_records();
  for (ContractRecord& record : out)
    std::erase_if(record.members, [&](const ContractMember& member) {
      return brief_digits(record.name, member.key) == 0;
    });
  std::erase_if(out, [](const ContractRecord& record) { return record.members.empty(); });
  return out;
}

std::string document_of(const std::vector<ContractRecord>& records, const char* id,
                        std::string_view name) {
  const bool is_brief = name == kBriefSchema;
  Json schema = Json::object(
      {{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"$id", id}, {"title", name}});
  schema.update(schema_of(records.front(), is_brief));
  schema["properties"]["schema"] = Json::object({{"const", name}});
  Json& definitions = schema["$defs"] = Json::object();
  for (std::size_t i = 1; i < records.size(); ++i)
    definitions[std::string(records[i].name)] = schema_of(records[i], is_brief);
  return laid_out(schema) + "\n";
}

}  // namespace

std::string report_schema() {
  return document_of(report_records(), "urn:slideway:report:2", kReportSchema);
}

std::string brief_schema() {
  return document_of(brief_records(), "urn:slideway:brief:1", kBriefSchema);
}

std::string plan_schema() {
  return document_of(plan_records(), "urn:slideway:plan:1", kPlanSchema);
}

}  // namespace slideway
