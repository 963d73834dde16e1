#include "low_band_arguments.hpp"

#include <boost/program_options/value_semantic.hpp>

#include "slideway/base/error.hpp"

namespace slideway {
namespace po = boost::program_options;

namespace {
constexpr int kHighestLevel = 30;

template <typename Read>
auto for_option(const char* option, Read&& read) {
  try {
    return read();
  } catch (const UsageError& error) {
    throw UsageError(std::string(option) + ": " + error.what());
  }
}
}  // namespace

LowBandArguments::LowBandArguments(const LowBandOptions& defaults)
    : wavelet_(defaults.wavelet), boundary_(name(defaults.boundary)), level_(defaults.level) {}

void LowBandArguments::add_to(po::options_description_easy_init options) {
  options("wavelet", po::value(&wavelet_)->value_name("NAME")->default_value(wavelet_),
          "Daubechies wavelet, db1 to db19");
  options("level", po::value(&level_)->value_name("L")->default_value(level_),
          "levels of the decomposition");
  options("boundary", po::value(&boundary_)->value_name("MODE")->default_value(boundary_),
          "how the signal goes on beyond its ends");
}

LowBandOptions LowBandArguments::checked(int lowest_level) const {
  if (level_ < lowest_level || level_ > kHighestLevel)
    throw UsageError("--level: " + std::to_string(level_) + " is out of range; accepted: " +
                     std::to_string(lowest_level) + " to " + std::to_string(kHighestLevel));
  return {for_option("--wavelet", [this] { return daubechies(wavelet_).name; }), level_,
          for_option("--boundary", [this] { return boundary(boundary_); })};
}

}  // namespace slideway
