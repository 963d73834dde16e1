#include "contract_types.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

#include "slideway/trace/analysis_fields.hpp"
#include "slideway/trace/plan_fields.hpp"

namespace slideway {
namespace {

using Described = ContractType::Kind;

template <typename T>
constexpr bool kIsOptional = false;
template <typename T>
constexpr bool kIsOptional<std::optional<T>> = true;

template <typename T>
constexpr bool kIsList = false;
template <typename T>
constexpr bool kIsList<std::vector<T>> = true;

/// A struct without members of its own names: an object with any keys.
template <typename T>
constexpr bool kIsMap = false;
template <typename T>
constexpr bool kIsMap<std::map<std::string, T>> = true;
template <typename T>
constexpr bool kIsMap<std::vector<std::pair<std::string, T>>> = true;

ContractType made_of(Described kind, std::vector<ContractType> of) {
  return {.kind = kind, .of = std::move(of)};
}

ContractType nullable(ContractType type) {
  type.or_null = true;
  return type;
}

class RecordList {
 public:
  template <Recorded T>
  void add() {
    const std::size_t place = enter(kRecord<T>.name, kRecord<T>.doc);
    if (place == records_.size()) return;
    std::vector<ContractMember> members;
    for_each_field<T>([&]<typename Access>(const Field<Access>& field) {
      using Member = std::remove_cvref_t<std::invoke_result_t<const Access&, T&>>;
      members.push_back(
          {field.key, field.doc, field.digits == kJsonText ? ContractType{} : type_of<Member>()});
    });
    records_[place].members = std::move(members);
  }

  [[nodiscard]] std::vector<ContractRecord> taken() && { return std::move(records_); }

 private:
  /// Where it now stands; the size where it stood already.
  std::size_t enter(std::string_view name, std::string_view doc) {
    if (std::ranges::find(records_, name, &ContractRecord::name) != records_.end())
      return records_.size();
    records_.push_back({name, doc, {}});
    return records_.size() - 1;
  }

  template <typename T>
  ContractType type_of() {
    if constexpr (kIsOptional<T>) {
      return nullable(type_of<typename T::value_type>());
    } else if constexpr (std::is_same_v<T, bool>) {
      return {.kind = Described::boolean};
    } else if constexpr (std::is_floating_point_v<T>) {
      return {.kind = Described::number};
    } else if constexpr (std::is_unsigned_v<T>) {
      return {.kind = Described::count};
    } else if constexpr (std::is_integral_v<T>) {
      return {.kind = Described::integer};
    } else if constexpr (Named<T>) {
      return {.kind = Described::one_of, .texts = {kTexts<T>.begin(), kTexts<T>.end()}};
    } else if constexpr (kIsMap<T>) {
      return made_of(Described::map, {type_of<typename T::value_type::second_type>()});
    } else if constexpr (kIsList<T>) {
      return made_of(Described::list, {type_of<typename T::value_type>()});
    } else if constexpr (Recorded<T>) {
      add<T>();
      return {.kind = Described::record, .record = kRecord<T>.name};
    } else if constexpr (std::is_same_v<T, std::string>) {
      return {.kind = Described::text};
    } else {
      return tuple(static_cast<T*>(nullptr));
    }
  }

  template <typename... T>
  ContractType tuple(const std::tuple<T...>* /*type*/) {
    return made_of(Described::tuple, {type_of<T>()...});
  }

  std::vector<ContractRecord> records_;
};

template <Recorded T>
std::vector<ContractRecord> records_of() {
  RecordList list;
  list.add<T>();
  return std::move(list).taken();
}

}  // namespace

const std::vector<ContractRecord>& report_records() {
  static const std::vector<ContractRecord> kRecords = records_of<Analysis>();
  return kRecords;
}

const std::vector<ContractRecord>& plan_records() {
  static const std::vector<ContractRecord> kRecords = records_of<Plan>();
  return kRecords;
}

}  // namespace slideway
