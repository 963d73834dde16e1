#include "contract_types.hpp"
#include "json_parts.hpp"
#include "slideway/report/contract.hpp"
#include "slideway/trace/analysis_fields.hpp"
#include "slideway/trace/plan_fields.hpp"

namespace slideway {
namespace {

/// Schemas of types; those of records under $defs.
class SchemaMaker {
 public:
  template <typename T>
  Json of() {
    if constexpr (kIsOptional<T>)
      return or_null_too(of<typename T::value_type>());
    else if constexpr (std::is_same_v<T, bool>)
      return {{"type", "boolean"}};
    else if constexpr (std::is_floating_point_v<T>)
      return {{"type", {"number", "null"}}};  // null: not finite
    else if constexpr (std::is_unsigned_v<T>)
      return {{"type", "integer"}, {"minimum", 0}};
    else if constexpr (std::is_integral_v<T>)
      return {{"type", "integer"}};
    else if constexpr (Named<T>)
      return {{"enum", kTexts<T>}};
    else if constexpr (kIsMap<T>)
      return {{"type", "object"}, {"additionalProperties", of<MappedType<T>>()}};
    else if constexpr (kIsList<T>)
      return {{"type", "array"}, {"items", of<typename T::value_type>()}};
    else if constexpr (Recorded<T>)
      return reference_to<T>();
    else if constexpr (std::is_same_v<T, std::string>)
      return {{"type", "string"}};
    else
      return tuple(static_cast<T*>(nullptr));
  }

  /// An object with the members of a record.
  template <Recorded T>
  Json object() {
    Json properties = Json::object(), required = Json::array();
    for_each_field<T>([&]<typename Access>(const Field<Access>& field) {
      Json own = field.digits == kJsonText ? Json::object() : of<MemberType<T, Access>>();
      if (!field.doc.empty()) own["description"] = field.doc;
      properties[std::string(field.key)] = std::move(own);
      required.push_back(field.key);
    });
    return {{"type", "object"},
            {"description", kRecord<T>.doc},
            {"properties", std::move(properties)},
            {"required", std::move(required)}};
  }

  [[nodiscard]] const Json& definitions() const { return definitions_; }

 private:
  static Json or_null_too(Json schema) {
    if (schema.contains("enum"))
      schema["enum"].push_back(nullptr);
    else if (schema.contains("$ref"))
      return {{"anyOf", {std::move(schema), {{"type", "null"}}}}};
    else if (!schema["type"].is_array())
      schema["type"] = Json::array({schema["type"], "null"});
    return schema;
  }

  template <Recorded T>
  Json reference_to() {
    const std::string name(kRecord<T>.name);
    if (!definitions_.contains(name)) {
      definitions_[name] = nullptr;  // its place, before what it is made of
      definitions_[name] = object<T>();
    }
    return {{"$ref", "#/$defs/" + name}};
  }

  template <typename... T>
  Json tuple(const std::tuple<T...>* /*type*/) {
    return {{"type", "array"},
            {"prefixItems", {of<T>()...}},
            {"minItems", sizeof...(T)},
            {"maxItems", sizeof...(T)}};
  }

  Json definitions_ = Json::object();
};

template <Recorded T>
std::string schema_of(const char* id, std::string_view name) {
  SchemaMaker maker;
  Json document = maker.object<T>();
  document["properties"]["schema"] = Json::object({{"const", name}});
  Json schema = {
      {"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"$id", id}, {"title", name}};
  schema.update(document);
  schema["$defs"] = maker.definitions();
  return laid_out(schema) + "\n";
}

}  // namespace

std::string report_schema() { return schema_of<Analysis>("urn:slideway:report:2", kReportSchema); }

std::string plan_schema() { return schema_of<Plan>("urn:slideway:plan:1", kPlanSchema); }

}  // namespace slideway
