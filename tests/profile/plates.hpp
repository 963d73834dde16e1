#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "slideway/base/file.hpp"
#include "slideway/format/table.hpp"
#include "support/measured_data.hpp"

namespace slideway {

/// Really measured surface plates with known blunders (SOURCE.md of each).
class MeasuredPlates : public testing::Test {
 protected:
  void SetUp() override {
    if (!exists(measured_data() / "surface_plate_sandia_2008"))
      GTEST_SKIP() << "no " << measured_data().string() << "; set SLIDEWAY_DATA";
  }

  static constexpr const char* kMoody = "surface_plate_moody_1955/moody_lines.csv";
  static constexpr const char* kSandia = "surface_plate_sandia_2008/sandia_plate_3_instruments.csv";

  /// A column of a file; NaN where a station has no value.
  [[nodiscard]] static std::vector<double> column(const std::string& file,
                                                  const std::string& name) {
    const FileBytes bytes(measured_data() / file);
    return parse_table(bytes.text(), {.columns = {"station_index", name}, .may_miss = true})
        .columns[1];
  }
};

}  // namespace slideway
