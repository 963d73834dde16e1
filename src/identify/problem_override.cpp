#include "problem_override.hpp"

#include <algorithm>

#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"

namespace slideway {
namespace {

/// Follows one key through the tree.
class Way {
 public:
  Way(const Override& override, const std::string& file)
      : override_(&override), file_(&file), rest_(override.key) {}

  void put(TomlValue& root);

 private:
  TomlValue& into(TomlValue::Table& table);
  TomlValue& into(TomlValue::Array& array);
  [[nodiscard]] std::string passed() const {  // what of the key has been followed
    const std::string& key = override_->key;
    return key.substr(0, key.size() - std::min(key.size(), rest_.size() + 1));
  }
  [[noreturn]] void fail(const std::string& key, const std::string& what) const {
    const std::string message = *file_ + ": " + key + ": " + what;
    throw UsageError(printable(message, message.size()));
  }

  const Override* override_;
  const std::string* file_;
  std::string_view rest_;  // of the key; empty when it has been followed to its end
};

TomlValue& Way::into(TomlValue::Table& table) {
  const std::size_t dot = std::min(rest_.find('.'), rest_.size());
  const std::string key(rest_.substr(0, dot));
  rest_.remove_prefix(std::min(dot + 1, rest_.size()));
  const auto at = std::find_if(table.begin(), table.end(),
                               [&](const TomlEntry& entry) { return entry.key == key; });
  if (at != table.end()) {
    if (rest_.empty()) at->line = 0;  // what is wrong with it is not in the file
    return at->value;
  }
  table.push_back({key, 0, {}});
  if (!rest_.empty()) table.back().value.data = TomlValue::Table{};
  return table.back().value;
}

const std::string* name_of(const TomlValue& table) {
  const auto* entries = std::get_if<TomlValue::Table>(&table.data);
  if (entries == nullptr) return nullptr;
  for (const TomlEntry& entry : *entries)
    if (entry.key == "name" || entry.key == "parameter")
      return std::get_if<std::string>(&entry.value.data);
  return nullptr;
}

TomlValue& Way::into(TomlValue::Array& array) {
  std::vector<std::string> names;
  TomlValue* found = nullptr;
  std::size_t longest = 0;  // a name may hold dots
  for (TomlValue& table : array) {
    const std::string* const name = name_of(table);
    if (name == nullptr) continue;
    names.push_back(*name);
    if (name->size() <= longest || !rest_.starts_with(*name + ".")) continue;
    longest = name->size();
    found = &table;
  }
  if (found == nullptr)
    fail(override_->key, "leads to none of the tables of " + passed() + "; accepted: " + passed() +
                             ".NAME.KEY with a NAME of: " + joined(names, " "));
  rest_.remove_prefix(longest + 1);
  return *found;
}

void Way::put(TomlValue& root) {
  TomlValue* at = &root;
  while (!rest_.empty()) {
    if (auto* table = std::get_if<TomlValue::Table>(&at->data))
      at = &into(*table);
    else if (auto* array = std::get_if<TomlValue::Array>(&at->data))
      at = &into(*array);
    else
      fail(override_->key, passed() + " is no table");
  }
  const bool is_text = std::holds_alternative<std::string>(at->data);
  TomlValue value = toml_value(override_->value);
  if (std::holds_alternative<std::monostate>(value.data) ||
      (is_text && !std::holds_alternative<TomlValue::Array>(value.data)))
    value.data = override_->value;
  *at = std::move(value);
}

}  // namespace

void put(const Override& override, const std::string& file, TomlValue& root) {
  Way(override, file).put(root);
}

}  // namespace slideway
