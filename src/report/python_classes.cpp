#include <set>

#include "contract_types.hpp"
#include "slideway/report/contract.hpp"
#include "slideway/trace/analysis_fields.hpp"

namespace slideway {
namespace {

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

/// Classes, each behind those it is made of.
class ClassMaker {
 public:
  template <Recorded T>
  void add() {
    if (!made_.insert(kRecord<T>.name).second) return;
    std::string members;
    bool has_array = false;
    for_each_field<T>([&]<typename Access>(const Field<Access>& field) {
      const std::string type = field.digits == kJsonText ? "Any" : type_of<MemberType<T, Access>>();
      has_array = has_array || type.find("NDArray") != std::string::npos;
      members += "    " + std::string(field.key) + ": " + folded(type, field.key.size() + 6) + "\n";
      if (!field.doc.empty()) members.append("    \"\"\"").append(field.doc).append("\"\"\"\n");
    });
    constexpr bool kIsReport = std::is_same_v<T, Analysis>;
    text_.append("\n\n@dataclass(frozen=True").append(has_array ? ", eq=False" : "");
    text_.append(kIsReport ? ", repr=False" : "").append(")\nclass ").append(kRecord<T>.name);
    text_.append(kIsReport ? "(Shown)" : "").append(":\n    \"\"\"");
    text_.append(kRecord<T>.doc).append("\"\"\"\n\n").append(members);
  }

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  template <typename T>
  std::string type_of() {
    if constexpr (kIsOptional<T>) {
      return type_of<typename T::value_type>() + " | None";
    } else if constexpr (std::is_same_v<T, bool>) {
      return "bool";
    } else if constexpr (std::is_floating_point_v<T>) {
      return "float";
    } else if constexpr (std::is_integral_v<T>) {
      return "int";
    } else if constexpr (Named<T>) {
      std::string texts;
      for (const std::string_view text : kTexts<T>)
        texts.append(texts.empty() ? "\"" : ", \"").append(text).append("\"");
      return "Literal[" + texts + "]";
    } else if constexpr (std::is_same_v<T, std::string>) {
      return "str";
    } else if constexpr (std::is_same_v<T, std::vector<double>>) {
      return "NDArray[np.float64]";
    } else if constexpr (std::is_same_v<T, std::vector<std::size_t>>) {
      return "NDArray[np.int64]";
    } else if constexpr (kIsMap<T>) {
      return "dict[str, " + type_of<MappedType<T>>() + "]";
    } else if constexpr (kIsList<T>) {
      return "list[" + type_of<typename T::value_type>() + "]";
    } else if constexpr (Recorded<T>) {
      add<T>();
      return std::string(kRecord<T>.name);
    } else {
      return tuple(static_cast<T*>(nullptr));
    }
  }

  template <typename... T>
  std::string tuple(const std::tuple<T...>* /*type*/) {
    std::string types;
    ((types += (types.empty() ? "" : ", ") + type_of<T>()), ...);
    return "tuple[" + types + "]";
  }

  /// Behind so many columns, over several lines where it is too long for one.
  static std::string folded(const std::string& type, std::size_t columns) {
    if (columns + type.size() <= kSourceWidth) return type;
    const std::size_t open = type.find('['), close = type.rfind(']');
    return type.substr(0, open + 1) + "\n        " + type.substr(open + 1, close - open - 1) +
           "\n    " + type.substr(close);
  }

  std::set<std::string_view> made_;
  std::string text_;
};

}  // namespace

std::string report_classes() {
  ClassMaker maker;
  maker.add<Analysis>();
  return std::string(kHead) + maker.text() + std::string(kEndOfReport);
}

}  // namespace slideway
