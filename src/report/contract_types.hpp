#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace slideway {

/// The type of a member of a result, as the schema and the Python classes tell it.
struct ContractType {
  enum class Kind : std::uint8_t {
    any,  ///< a text that is JSON already
    boolean,
    number,
    count,  ///< an integer that is not negative
    integer,
    text,
    one_of,  ///< of `texts`
    list,    ///< of `of[0]`
    map,     ///< from a text to `of[0]`
    tuple,   ///< of `of`, each in its place
    record,  ///< named `record`
  };

  Kind kind = Kind::any;
  bool or_null = false;
  std::vector<ContractType> of;
  std::vector<std::string_view> texts;
  std::string_view record;
};

struct ContractMember {
  std::string_view key;
  std::string_view doc;
  ContractType type;
};

struct ContractRecord {
  std::string_view name;
  std::string_view doc;
  std::vector<ContractMember> members;
};

/// The records that a result is made of, the result itself first, each where it is first needed.
const std::vector<ContractRecord>& report_records();
const std::vector<ContractRecord>& plan_records();

}  // namespace slideway
