#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <memory>

#include "command.hpp"
#include "low_band_arguments.hpp"
#include "output.hpp"
#include "slideway/base/error.hpp"
#include "slideway/format/table.hpp"

namespace slideway {
namespace {
namespace po = boost::program_options;

void append(std::string& text, double value, char separator) {
  std::array<char, 32> digits;
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  text.append(digits.data(), end);
  text += separator;
}

std::string csv(std::span<const double> positions, std::span<const double> signal,
                const Bands& bands) {
  std::vector<std::span<const double>> columns{positions, signal};
  std::string text = "position_mm,signal";
  for (std::size_t j = 0; j < bands.approximations.size(); ++j) {
    text += ",a" + std::to_string(j + 1);
    columns.emplace_back(bands.approximations[j]);
  }
  for (std::size_t j = 0; j < bands.details.size(); ++j) {
    text += ",d" + std::to_string(j + 1);
    columns.emplace_back(bands.details[j]);
  }
  text += '\n';
  text.reserve(signal.size() * columns.size() * 20);
  for (std::size_t i = 0; i < signal.size(); ++i)
    for (std::size_t c = 0; c < columns.size(); ++c)
      append(text, columns[c][i], c + 1 == columns.size() ? '\n' : ',');
  return text;
}

bool is_uniform(std::span<const double> positions) {
  const double step =
      (positions.back() - positions.front()) / static_cast<double>(positions.size() - 1);
  return std::adjacent_find(positions.begin(), positions.end(), [&](double a, double b) {
           return !(std::abs(b - a - step) <= 1e-3 * std::abs(step));
         }) == positions.end();
}

class DecomposeCommand : public Command {
 public:
  DecomposeCommand()
      : Command("decompose", "FILE --out OUT.csv [options]",
                "Splits a profile into wavelet bands of full length, a1..aL, d1..dL") {
    add_input("FILE", &input_);
    low_band_.add_to(add_options());
    add_options()("position", po::value(&position_)->value_name("COL")->default_value("1"),
                  "column of the positions: header name or number");
    add_options()("value", po::value(&value_)->value_name("COL")->default_value("2"),
                  "column of the signal: header name or number");
    add_options()("out", po::value(&out_)->value_name("OUT.csv"), "file to write; - for stdout");
  }

  int run() override {
    keep_input(input_, out_);
    const std::array<std::string, 2> names{position_, value_};
    const Table table = read_table(input_, names);
    const std::vector<double>& positions = table.columns[0];
    const std::vector<double>& signal = table.columns[1];
    check_numbers(positions, position_);
    check_numbers(signal, value_);
    const std::size_t needed = std::size_t{1} << options_.level;
    if (signal.size() < needed)
      throw DataError(input_ + ": " + std::to_string(signal.size()) + " rows; --level " +
                      std::to_string(options_.level) + " needs " + std::to_string(needed));
    if (!is_uniform(positions))
      say(input_ + ": positions are not evenly spaced; the samples are taken as if they were");
    const Bands bands =
        reconstruct_bands(daubechies(options_.wavelet), options_.boundary, options_.level, signal);
    write_output(out_, csv(positions, signal, bands));
    return kDone;
  }

 private:
  void check(const po::variables_map& /*given*/) override {
    if (out_.empty()) fail("--out OUT.csv is missing");
    options_ = low_band_.checked(1);
  }

  void check_numbers(const std::vector<double>& column, const std::string& name) const {
    const auto bad = std::find_if_not(column.begin(), column.end(),
                                      [](double value) { return std::isfinite(value); });
    if (bad != column.end())
      throw DataError(input_ + ": column '" + name + "', data row " +
                      std::to_string(bad - column.begin() + 1) + ": no finite number");
  }

  std::string input_, position_, value_, out_;
  LowBandArguments low_band_{{"db4", 5, Boundary::symmetric}};
  LowBandOptions options_;
};

}  // namespace

std::unique_ptr<Command> make_decompose() { return std::make_unique<DecomposeCommand>(); }

}  // namespace slideway
