// Every effect of the catalogue, alone and with every other, on every kind of profile, with hardly
// any data: a result, or an error in one line. What is found is not asked here.

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include "slideway/base/error.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/identify/problem_tree.hpp"
#include "slideway/trace/analysis.hpp"

namespace slideway {
namespace {

using Table = TomlValue::Table;

TomlEntry entry(std::string key, decltype(TomlValue::data) data) {
  return {std::move(key), 0, {0, std::move(data)}};
}

/// A kind of profile with all that any clock needs.
struct Reading {
  const char* name;
  const char* kind;
  const char* quantity;
  const char* unit;
};
void PrintTo(const Reading& reading, std::ostream* out) { *out << reading.name; }

constexpr Reading kReadings[] = {{"Face", "face", "height", "um"},
                                 {"Slide", "slide", "height", "um"},
                                 {"Slope", "slide", "slope", "urad"}};
constexpr std::size_t kRows[] = {2, 3, 5, 50};

/// With a degree where the effect asks for one.
TomlValue effect(const std::string& name) {
  Table table{entry("name", name)};
  try {
    make_effect(name, {}, Machine(Machine::paper_lathe(), Lever::paper), {.beam_span_mm = 400.0});
  } catch (const UsageError&) {
    table.push_back(entry("degree", std::int64_t{3}));
  }
  return {0, table};
}

TomlValue tree(const Reading& reading, const std::vector<std::string>& effects, bool is_levelled) {
  Table profile{entry("name", "p"),
                entry("position_unit", "mm"),
                entry("kind", reading.kind),
                entry("quantity", reading.quantity),
                entry("value_unit", reading.unit),
                entry("feed_mm_per_min", 5.0),
                entry("spindle_rpm", 300.0),
                entry("cut_direction", "inward"),
                entry("traverse_mm_per_s", 0.5)};
  if (!is_levelled) profile.push_back(entry("free", TomlValue::Array{}));
  TomlValue::Array declared;
  for (const std::string& name : effects) declared.push_back(effect(name));
  return {0, Table{entry("machine", Table{entry("lever", "paper"), entry("span_mm", 400.0)}),
                   entry("low_band", Table{entry("level", std::int64_t{0})}),
                   entry("profile", TomlValue::Array{{0, profile}}),
                   entry("effect", std::move(declared))}};
}

/// 40 mm with a bow, a wave and something that looks like noise.
GivenTraces numbers(std::size_t rows) {
  Trace trace;
  for (std::size_t i = 0; i < rows; ++i) {
    const double s = 40.0 * static_cast<double>(i) / static_cast<double>(rows - 1);
    trace.positions.push_back(s);
    trace.values.push_back(0.01 * s * s + std::sin(0.7 * s) +
                           0.1 * std::sin(997.0 * static_cast<double>(i * i)));
  }
  return {{"p", trace}};
}

void expect_all_finite(const std::vector<FittedParameter>& parameters) {
  for (const FittedParameter& parameter : parameters)
    for (const auto& number :
         {parameter.value, parameter.standard_uncertainty, parameter.expanded_uncertainty})
      EXPECT_TRUE(!number || std::isfinite(*number)) << parameter.name;
}

/// A result, or a UsageError or DataError in one line.
void expect_an_answer(const TomlValue& root, std::size_t rows, bool closes_loop) {
  try {
    const Problem problem = read_problem(root);
    const std::vector<Profile> profiles = read_profiles(problem, numbers(rows));
    const Analysis analysis =
        analyse(problem, profiles, {.closes_loop = closes_loop, .with_details = true});
    expect_all_finite(analysis.result.declared->parameters);
    expect_all_finite(analysis.result.final->parameters);
  } catch (const UsageError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  } catch (const DataError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
}

void expect_an_answer(const Reading& reading, const std::vector<std::string>& effects,
                      std::size_t rows, bool is_levelled, bool closes_loop) {
  std::string what =
      reading.name + (" of " + std::to_string(rows)) + " rows" + (is_levelled ? ", levelled" : "");
  for (const std::string& name : effects) what += ", " + name;
  SCOPED_TRACE(what);
  expect_an_answer(tree(reading, effects, is_levelled), rows, closes_loop);
}

class CatalogueWalk : public ::testing::TestWithParam<Reading> {};
class CatalogueLoop : public ::testing::TestWithParam<Reading> {};

TEST_P(CatalogueWalk, EveryEffectAloneGetsAnAnswer) {
  for (const std::string& name : effect_names())
    for (const std::size_t rows : kRows)
      for (const bool is_levelled : {true, false})
        expect_an_answer(GetParam(), {name}, rows, is_levelled, false);
}

TEST_P(CatalogueWalk, EveryPairOfEffectsGetsAnAnswer) {
  const std::vector<std::string> names = effect_names();
  for (std::size_t i = 0; i < names.size(); ++i)
    for (std::size_t j = i + 1; j < names.size(); ++j)
      for (const std::size_t rows : kRows)
        expect_an_answer(GetParam(), {names[i], names[j]}, rows, true, false);
}

TEST_P(CatalogueLoop, EveryEffectAloneGetsAnAnswer) {
  for (const std::string& name : effect_names())
    for (const std::size_t rows : kRows)
      for (const bool is_levelled : {true, false})
        expect_an_answer(GetParam(), {name}, rows, is_levelled, true);
}

/// The tree with a key of a table put in, or put in the place of what is there.
TomlValue with(TomlValue root, const std::string& table, const std::string& key, double value) {
  for (TomlEntry& each : std::get<Table>(root.data)) {
    if (each.key != table) continue;
    TomlValue* at = &each.value;
    if (auto* array = std::get_if<TomlValue::Array>(&at->data)) at = &array->front();
    Table& keys = std::get<Table>(at->data);
    std::erase_if(keys, [&](const TomlEntry& old) { return old.key == key; });
    keys.push_back(entry(key, value));
  }
  return root;
}

struct NumericKey {
  const char* table;
  const char* key;
};
constexpr NumericKey kNumericKeys[] = {
    {"profile", "base_mm"},        {"profile", "center_mm"},
    {"profile", "z_mm"},           {"profile", "feed_mm_per_min"},
    {"profile", "spindle_rpm"},    {"profile", "cut_radius_mm"},
    {"profile", "start_s"},        {"profile", "traverse_mm_per_s"},
    {"profile", "nose_radius_mm"}, {"profile", "standard_uncertainty"},
    {"machine", "span_mm"},        {"machine", "spindle_position_mm"},
    {"machine", "overhang_mm"},    {"profile", "overhang_mm"}};
constexpr double kExtremes[] = {1e-300, 1e-9, 1e-3, 1e3, 1e9, 1e300};

TEST_P(CatalogueLoop, EveryNumberAtItsExtremesGetsAnAnswer) {
  for (const auto& [table, key] : kNumericKeys)
    for (const double size : kExtremes)
      for (const double value : {size, -size, 0.0}) {
        SCOPED_TRACE(std::string(table) + "." + key + " = " + std::to_string(value));
        TomlValue root = tree(GetParam(), {"straightness", "squareness"}, true);
        expect_an_answer(with(std::move(root), table, key, value), 50, true);
      }
}

const auto by_name = [](const auto& info) { return std::string(info.param.name); };
INSTANTIATE_TEST_SUITE_P(Every, CatalogueWalk, ::testing::ValuesIn(kReadings), by_name);
INSTANTIATE_TEST_SUITE_P(Every, CatalogueLoop, ::testing::ValuesIn(kReadings), by_name);

}  // namespace
}  // namespace slideway
