#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "problem_toml.hpp"
#include "slideway/base/error.hpp"
#include "slideway/identify/fault.hpp"

namespace slideway {

/// The words of a blank-separated list.
std::vector<std::string> words(std::string_view list);

/// A fault of the problem file as an exception.
struct FaultError : UsageError {
  explicit FaultError(Fault what) : UsageError(what.message), fault(std::move(what)) {}
  Fault fault;
};

/// One table of the problem file, read key by key. Everything it refuses is a FaultError
/// "file:line: section.key: what is wrong; accepted: ...", or is kept in `faults`, if there are any
/// to be kept: a value that was refused is then as one that is not there.
class Section {
 public:
  /// @param name    how messages call it: "profile", "machine.body"; empty for the root
  /// @param faults  of this section and those inside it; null: the first one is thrown
  Section(const std::string& file, std::string name, const TomlValue& value,
          Faults* faults = nullptr);

  /// Reads a part of the file on which no other depends. Where faults are kept, one that leaves the
  /// part is kept, too, and the part has ended. @return whether nothing was refused
  template <typename Part>
  bool attempt(Part&& part) const {
    if (faults_ == nullptr) return part(), true;
    const std::size_t before = faults_->size();
    try {
      part();
    } catch (const RefusedBefore&) {
    } catch (const FaultError& error) {
      keep(error.fault);
    } catch (const UsageError& error) {
      keep({.message = error.what()});
    } catch (const DataError& error) {
      keep_data(error);
    }
    return faults_->size() == before;
  }

  /// Refuses every key that is not listed.
  void accept(std::span<const std::string> keys) const;
  void accept(std::string_view keys) const { accept(words(keys)); }

  [[nodiscard]] bool has(std::string_view key) const { return find(key) != nullptr; }
  [[nodiscard]] bool is_text(std::string_view key) const;
  [[nodiscard]] std::vector<std::string> keys() const;
  [[nodiscard]] std::map<std::string, int> lines() const;  // of the keys, and of "", the table

  /// Values by key; nothing if the key is not there.
  [[nodiscard]] std::optional<double> number(std::string_view key) const;  // finite
  [[nodiscard]] std::optional<double> positive(std::string_view key) const;
  /// Far beyond any workshop, and near enough for the arithmetic: from -most to most; 1e-9 to 1e9.
  [[nodiscard]] std::optional<double> coordinate(std::string_view key, double most = 1e9) const;
  [[nodiscard]] std::optional<double> magnitude(std::string_view key) const;
  [[nodiscard]] std::optional<double> not_negative(std::string_view key) const;
  [[nodiscard]] std::optional<bool> flag(std::string_view key) const;
  [[nodiscard]] std::optional<int> integer(std::string_view key, int lowest, int highest) const;
  [[nodiscard]] std::optional<std::string> text(std::string_view key) const;  // one line, not empty
  [[nodiscard]] std::optional<std::string> column(std::string_view key) const;  // name or number
  [[nodiscard]] std::optional<std::pair<double, double>> range(std::string_view key) const;
  /// A list of ranges.
  [[nodiscard]] std::vector<std::pair<double, double>> ranges(std::string_view key) const;
  [[nodiscard]] std::optional<std::array<double, 2>> point(std::string_view key) const;
  /// A list of whole numbers from 1 on; all else is refused with `what`.
  [[nodiscard]] std::optional<std::vector<std::size_t>> indices(std::string_view key,
                                                                const std::string& what) const;
  /// A text that must be one of `accepted`; `where` ends the sentence: " for a slope".
  [[nodiscard]] std::optional<std::string> one_of(std::string_view key,
                                                  std::span<const std::string> accepted,
                                                  std::string_view where = "") const;
  [[nodiscard]] std::optional<std::string> one_of(std::string_view key, std::string_view accepted,
                                                  std::string_view where = "") const {
    return one_of(key, words(accepted), where);
  }
  /// A unit: as one_of(), and "µm" (with either micro sign) is "um".
  [[nodiscard]] std::optional<std::string> unit(std::string_view key, std::string_view accepted,
                                                std::string_view where) const;
  /// A list of such texts.
  [[nodiscard]] std::optional<std::vector<std::string>> some_of(
      std::string_view key, std::span<const std::string> accepted) const;
  /// A list of texts of any kind; empty if not there.
  [[nodiscard]] std::vector<std::string> texts(std::string_view key) const;
  [[nodiscard]] std::optional<Section> table(std::string_view key) const;
  [[nodiscard]] std::vector<Section> tables(std::string_view key) const;  // empty if not there

  /// The value of a key that has to be there.
  template <typename T>
  [[nodiscard]] T required(std::string_view key, std::optional<T> value,
                           std::string_view accepted) const {
    if (!value && has(key)) throw RefusedBefore();
    if (!value) missing(key, accepted);
    return *std::move(value);
  }

  [[noreturn]] void missing(std::string_view key, std::string_view accepted) const;
  [[noreturn]] void fail(std::string_view key, const std::string& what) const;

  /// Where faults are kept the reading goes on behind this one.
  void refuse(std::string_view key, const std::string& what) const;

 private:
  /// Ends the part that cannot do without a value that was refused.
  struct RefusedBefore {};

  void refuse_key(std::string_view key, const std::string& what) const;
  [[nodiscard]] Fault fault(std::string_view key, const std::string& what) const;
  void keep(const Fault& fault) const;
  void keep_data(const DataError& error) const;  // at the key `file`, if there is one
  [[nodiscard]] const TomlEntry* find(std::string_view key) const;
  [[nodiscard]] std::string called(std::string_view key) const;
  [[nodiscard]] bool check_word(std::string_view key, const std::string& word,
                                std::span<const std::string> accepted, std::string_view where,
                                const std::string& meant) const;

  const std::string* file_;
  std::string name_;
  int line_ = 0;
  const TomlValue::Table* table_;
  Faults* faults_;
};

}  // namespace slideway
