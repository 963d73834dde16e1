#include <memory>

#include "command.hpp"
#include "output.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/file.hpp"
#include "trace_arguments.hpp"

namespace slideway {
namespace {

class ConvertCommand : public Command {
 public:
  ConvertCommand()
      : Command("convert", "IN OUT [options]",
                "Writes a profile file in the format that OUT's ending names") {
    add_input("IN", &input_);
    add_input("OUT", &output_);
    arguments_.add_to(add_options());
  }

  int run() override {
    const Format& format = format_to_write(output_);
    keep_input(input_, output_);
    TraceFile file = read_trace(input_, request_);
    arguments_.add_units(file);
    try {
      write_file(output_, format.write(file.trace));
    } catch (const UsageError& error) {
      throw UsageError(output_ + ": " + error.what());
    }
    return kDone;
  }

 private:
  void check(const boost::program_options::variables_map& /*given*/) override {
    request_ = arguments_.checked();
  }

  std::string input_, output_;
  TraceArguments arguments_;
  TraceRequest request_;
};

}  // namespace

std::unique_ptr<Command> make_convert() { return std::make_unique<ConvertCommand>(); }

}  // namespace slideway
