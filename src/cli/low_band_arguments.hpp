#pragma once

#include <boost/program_options/options_description.hpp>
#include <string>

#include "slideway/signal/low_band.hpp"

namespace slideway {

/// --wavelet, --level and --boundary, the same for every command that has them.
class LowBandArguments {
 public:
  explicit LowBandArguments(const LowBandOptions& defaults);

  void add_to(boost::program_options::options_description_easy_init options);

  /// @param lowest_level  smallest level the command can use
  /// @throws UsageError
  [[nodiscard]] LowBandOptions checked(int lowest_level) const;

 private:
  std::string wavelet_, boundary_;
  int level_;
};

}  // namespace slideway
