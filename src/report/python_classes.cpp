#include <algorithm>
#include <set>

#include "contract_types.hpp"
#include "slideway/base/text.hpp"
#include "slideway/report/contract.hpp"

namespace slideway {
namespace {

using Described = ContractType::Kind;

constexpr std::string_view kHead =
    R"py("""The report as dataclasses, key for key as the program's ``--json`` has it.

Made of the program's own lists of members (``report_contract --update``): do not edit.

Units are in the names (``rms_um``, ``lag_mm``); a parameter has its own in ``unit``. ``None`` is a
number that could not be determined, or does not apply; of a pair such as ``rms_um`` and
``rms_urad`` the first belongs to heights, the second to slopes. A number that is not finite is NaN,
or ``None`` where that is accepted, and ``notes`` name it.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from slideway._shown import Shown
)py";

constexpr std::string_view kEndOfReport =
    R"py(    text: str = dataclasses.field(default="", repr=False, compare=False)
    """what the program prints"""
    json: str = dataclasses.field(default="", repr=False, compare=False)
    """what the program writes"""
)py";

constexpr std::size_t kSourceWidth = 99;

/// Over several lines where it is too long for one, behind so many columns.
std::string folded(const std::string& type, std::size_t columns) {
  if (columns + type.size() <= kSourceWidth) return type;
  const std::size_t open = type.find('['), close = type.rfind(']');
  return type.substr(0, open + 1) + "\n        " + type.substr(open + 1, close - open - 1) +
         "\n    " + type.substr(close);
}

/// Classes, each behind those it is made of.
class ClassMaker {
 public:
  explicit ClassMaker(const std::vector<ContractRecord>& records) : records_(records) {
    add(records.front());
  }

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  void add(const ContractRecord& record) {
    if (!made_.insert(record.name).second) return;
    std::string members;
    bool has_array = false;
    for (const ContractMember& member : record.members) {
      const std::string type = type_of(member.type);
      has_array = has_array || type.find("NDArray") != std::string::npos;
      members +=
          "    " + std::string(member.key) + ": " + folded(type, member.key.size() + 6) + "\n";
      if (!member.doc.empty()) members.append("    \"\"\"").append(member.doc).append("\"\"\"\n");
    }
    const bool is_report = &record == &records_.front();
    text_.append("\n\n@dataclass(frozen=True").append(has_array ? ", eq=False" : "");
    text_.append(is_report ? ", repr=False" : "").append(")\nclass ").append(record.name);
    text_.append(is_report ? "(Shown)" : "").append(":\n    \"\"\"");
    text_.append(record.doc).append("\"\"\"\n\n").append(members);
  }

  std::string type_of(const ContractType& type) {
    return type_unless_none(type) + (type.or_null ? " | None" : "");
  }

  std::string type_unless_none(const ContractType& type) {
    switch (type.kind) {
      case Described::any:
        return "Any";
      case Described::boolean:
        return "bool";
      case Described::number:
        return "float";
      case Described::count:
      case Described::integer:
        return "int";
      case Described::text:
        return "str";
      case Described::one_of:
        return "Literal[" + quoted(type.texts) + "]";
      case Described::list:
        return list_of(type.of[0]);
      case Described::map:
        return "dict[str, " + type_of(type.of[0]) + "]";
      case Described::tuple:
        return "tuple[" + types_of(type.of) + "]";
      case Described::record:
        break;
    }
    add(*std::ranges::find(records_, type.record, &ContractRecord::name));
    return std::string(type.record);
  }

  std::string list_of(const ContractType& type) {
    if (type.kind == Described::number && !type.or_null) return "NDArray[np.float64]";
    if (type.kind == Described::count && !type.or_null) return "NDArray[np.int64]";
    return "list[" + type_of(type) + "]";
  }

  std::string types_of(const std::vector<ContractType>& types) {
    std::vector<std::string> parts;
    for (const ContractType& type : types) parts.push_back(type_of(type));
    return joined(parts);
  }

  static std::string quoted(const std::vector<std::string_view>& texts) {
    std::vector<std::string> parts;
    for (const std::string_view text : texts) parts.push_back("\"" + std::string(text) + "\"");
    return joined(parts);
  }

  const std::vector<ContractRecord>& records_;
  std::set<std::string_view> made_;
  std::string text_;
};

}  // namespace

std::string report_classes() {
  return std::string(kHead) + ClassMaker(report_records()).text() + std::string(kEndOfReport);
}

}  // namespace slideway
