#include <algorithm>
#include <memory>

#include "command.hpp"
#include "output.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/report/certificate.hpp"
#include "slideway/report/compensation.hpp"
#include "slideway/report/document.hpp"
#include "slideway/report/residual_table.hpp"

namespace slideway {
namespace {
namespace po = boost::program_options;

// Formats of their own: not of a control.
constexpr const char* kResidual = "residual";
constexpr const char* kCertificate = "dcc";

class ExportCommand : public Command {
 public:
  ExportCommand()
      : Command("export", "RESULT.json --to isg|etalon|cec|heidenhain|residual|dcc",
                "Writes a compensation table or a calibration certificate") {
    add_input("RESULT.json", &input_);
    add_options()("to", po::value(&format_)->value_name("FORMAT"),
                  "isg (Beckhoff TF5280), etalon (exchange format), cec (SINUMERIK $AN_CEC), "
                  "heidenhain (.COM), residual (what is left without a name, CSV), dcc (Digital "
                  "Calibration Certificate, PTB's XML)");
    add_options()("out", po::value(&out_)->value_name("FILE"), "file to write; default stdout");
    add_options()("step", po::value(&step_mm_)->value_name("MM"),
                  "largest distance of two positions; default a fiftieth of the travel");
  }

  int run() override {
    keep_input(input_, out_);
    const Analysis analysis = read_report(input_);
    const std::string source =
        "slideway " + analysis.result.version + ", " + input_ + ": " + analysis.result.title;
    try {
      if (format_ == kResidual) {
        write_output(out_, residual_table(analysis, source));
        return kDone;
      }
      if (format_ == kCertificate) {
        write_output(out_, calibration_certificate(analysis));
        return kDone;
      }
      const Compensation table = compensation(analysis, step_mm_);
      write_output(out_, compensation_table(table, format_, source));
      if (!is_quiet()) say(compensation_notes(table, format_, source));
    } catch (const UsageError& error) {
      fail(std::string("--") + error.what());
    } catch (const DataError& error) {
      throw DataError(input_ + ": " + error.what());
    }
    return kDone;
  }

 private:
  static std::string accepted() {
    return joined(compensation_formats()) + ", " + kResidual + ", " + kCertificate;
  }

  void check(const po::variables_map& given) override {
    if (format_.empty()) fail("--to FORMAT is missing; accepted: " + accepted());
    const bool is_table = format_ != kResidual && format_ != kCertificate;
    if (!is_table && given.count("step") != 0)
      fail("--step: goes with a compensation table, not with --to " + format_);
    if (!is_table) return;
    if (std::ranges::count(compensation_formats(), format_) == 0)
      fail("--to: '" + printable(format_) + "' is not accepted" +
           did_you_mean(format_, compensation_formats()) + "; accepted: " + accepted());
    if (given.count("step") != 0 && !(step_mm_ > 0.0)) fail("--step: must be above 0 mm");
  }

  std::string input_, format_, out_ = "-";
  double step_mm_ = 0.0;
};

}  // namespace

std::unique_ptr<Command> make_export() { return std::make_unique<ExportCommand>(); }

}  // namespace slideway
