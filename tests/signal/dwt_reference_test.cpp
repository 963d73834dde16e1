#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "slideway/base/text.hpp"
#include "slideway/signal/dwt.hpp"
#include "support/measured_data.hpp"

namespace slideway::dwt_reference_test {
namespace {

using testing::DoubleNear;
using testing::Pointwise;

struct Row {
  std::vector<std::string> words;
  std::vector<double> values;
};

// Rows of some words and then numbers; lines that start with '#' and what is no row are left out.
std::vector<Row> read_rows(const std::filesystem::path& path, std::size_t words) {
  std::ifstream file(path);
  std::vector<Row> rows;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('#') || line.starts_with("wavelet,")) continue;
    Row row;
    std::stringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');)
      if (row.words.size() < words)
        row.words.push_back(field);
      else
        row.values.push_back(parse_double(field).value());
    rows.push_back(row);
  }
  return rows;
}

// The transform takes any filter bank: those that are not Daubechies' are in pywavelets_taps.csv.
std::map<std::string, Wavelet> filter_banks() {
  std::map<std::string, Wavelet> banks;
  for (int n = 1; n <= 19; ++n) {
    const std::string name = "db" + std::to_string(n);
    banks[name] = daubechies(name);
  }
  const auto path = std::filesystem::path(SLIDEWAY_SOURCE_DIR) / "tests/signal/pywavelets_taps.csv";
  for (const Row& row : read_rows(path, 2)) {
    Wavelet& bank = banks[row.words[0]];
    (row.words[1] == "dec_lo" ? bank.decompose_low : bank.decompose_high) = row.values;
  }
  return banks;
}

// MATLAB R2012a's dwt(), 15 wavelets x 2 lengths x 9 modes; the source is described beside the
// data. 1e-10 is what the digits of MATLAB's own taps (some 1e-12 each) allow.
TEST(DwtReference, AgreesWithMatlab) {
  const auto path = measured_data() / "dwt_matlab_reference/dwt_reference.csv";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path;
  const std::map<std::string, Boundary> modes{
      {"zpd", Boundary::zero},          {"sp0", Boundary::constant},
      {"sym", Boundary::symmetric},     {"symw", Boundary::reflect},
      {"ppd", Boundary::periodic},      {"sp1", Boundary::smooth},
      {"per", Boundary::periodization}, {"asym", Boundary::antisymmetric},
      {"asymw", Boundary::antireflect}};
  const std::map<std::string, Wavelet> banks = filter_banks();
  std::vector<double> signal;
  int compared = 0;
  for (const Row& row : read_rows(path, 4)) {
    const std::string& kind = row.words[3];
    if (kind == "x") {
      signal = row.values;
      continue;
    }
    Band low, high;
    dwt(banks.at(row.words[0]), modes.at(row.words[2]), signal, low, &high);
    EXPECT_THAT(kind == "ma" ? low : high, Pointwise(DoubleNear(1e-10), row.values))
        << row.words[0] << " n " << row.words[1] << ' ' << row.words[2] << ' ' << kind;
    ++compared;
  }
  EXPECT_EQ(compared, 15 * 2 * 9 * 2);
}

}  // namespace
}  // namespace slideway::dwt_reference_test
