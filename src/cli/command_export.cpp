#include <memory>

#include "command.hpp"
#include "output.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/report/compensation.hpp"
#include "slideway/report/document.hpp"

namespace slideway {
namespace {
namespace po = boost::program_options;

class ExportCommand : public Command {
 public:
  ExportCommand()
      : Command("export", "RESULT.json --to isg|etalon|cec|heidenhain [options]",
                "Writes straightness and squareness as a compensation table") {
    add_input("RESULT.json", &input_);
    add_options()("to", po::value(&format_)->value_name("FORMAT"),
                  "isg (Beckhoff TF5280), etalon (exchange format), cec (SINUMERIK $AN_CEC), "
                  "heidenhain (.COM)");
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
      const Compensation table = compensation(analysis, step_mm_);
      const std::string text = compensation_table(table, format_, source);
      if (!is_quiet())
        for (const std::string& line : compensation_notes(table, format_, source)) say(line);
      write_output(out_, text);
    } catch (const UsageError& error) {
      fail(std::string("--") + error.what());
    } catch (const DataError& error) {
      throw DataError(input_ + ": " + error.what());
    }
    return kDone;
  }

 private:
  void check(const po::variables_map& given) override {
    if (format_.empty())
      fail("--to FORMAT is missing; accepted: " + joined(compensation_formats()));
    try {
      check_compensation_format(format_);
    } catch (const UsageError& error) {
      fail(std::string("--to: ") + error.what());
    }
    if (given.count("step") != 0 && !(step_mm_ > 0.0)) fail("--step: must be above 0 mm");
  }

  std::string input_, format_, out_ = "-";
  double step_mm_ = 0.0;
};

}  // namespace

std::unique_ptr<Command> make_export() { return std::make_unique<ExportCommand>(); }

}  // namespace slideway
