#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <memory>

#include "command.hpp"
#include "low_band_arguments.hpp"
#include "output.hpp"
#include "slideway/base/error.hpp"
#include "slideway/format/format.hpp"
#include "slideway/signal/bands.hpp"

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
    add_options()("position", po::value(&request_.position_column)->value_name("COL"),
                  "column of the positions: header name or number; default 1");
    add_options()("value", po::value(&request_.value_column)->value_name("COL"),
                  "column of the signal: header name or number; default 2");
    add_options()("out", po::value(&out_)->value_name("OUT.csv"), "file to write; - for stdout");
  }

  int run() override {
    keep_input(input_, out_);
    const Trace trace = read_trace(input_, request_).trace;
    const std::vector<double>& positions = trace.positions;
    const std::vector<double>& signal = trace.values;
    refuse_missing(signal);
    const std::size_t needed = std::size_t{1} << options_.level;
    if (signal.size() < needed)
      throw DataError(input_ + ": " + std::to_string(signal.size()) + " rows; --level " +
                      std::to_string(options_.level) + " needs " + std::to_string(needed));
    if (!is_quiet() && !is_uniform(positions))
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

  void refuse_missing(const std::vector<double>& signal) const {
    const auto missing =
        std::find_if(signal.begin(), signal.end(), [](double value) { return std::isnan(value); });
    if (missing != signal.end())
      throw DataError(input_ + ": data row " + std::to_string(missing - signal.begin() + 1) +
                      ": the value is missing; bands are made of whole profiles");
  }

  std::string input_, out_;
  TraceRequest request_;
  LowBandArguments low_band_{{"db4", 5, Boundary::symmetric}};
  LowBandOptions options_;
};

}  // namespace

std::unique_ptr<Command> make_decompose() { return std::make_unique<DecomposeCommand>(); }

}  // namespace slideway
