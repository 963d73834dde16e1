#pragma once

#include <boost/program_options/options_description.hpp>
#include <string>

#include "slideway/format/format.hpp"

namespace slideway {

/// What can be said of a profile file on the command line, the same for every command that reads
/// one without a problem file.
class TraceArguments {
 public:
  void add_to(boost::program_options::options_description_easy_init options);

  /// @throws UsageError
  [[nodiscard]] TraceRequest checked() const;

  /// Gives a trace the units its file does not have. @throws UsageError if it has others
  void add_units(TraceFile& file) const;

 private:
  TraceRequest request_;
  std::string header_lines_, position_unit_, value_unit_;
};

}  // namespace slideway
