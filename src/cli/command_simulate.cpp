#include "slideway/identify/simulate.hpp"

#include <charconv>
#include <memory>

#include "environment.hpp"
#include "output.hpp"
#include "report_command.hpp"

namespace slideway {
namespace {
namespace po = boost::program_options;

class SimulateCommand : public Command {
 public:
  SimulateCommand()
      : Command("simulate", "PROBLEM --out DIR [--seed N]",
                "Writes the profiles [truth] makes, and the problem without [truth]") {
    add_input("PROBLEM", &input_);
    add_options()("out", po::value(&out_)->value_name("DIR"), "directory to write into");
    add_options()("seed", po::value(&seed_text_)->value_name("N"),
                  "instead of the seed in [truth]");
    add_options()("data", po::value(&data_)->value_name("DIR"),
                  "what ${SLIDEWAY_DATA} in the problem file stands for");
  }

  int run() override {
    Problem problem = read_problem(input_, data_directory(data_));
    if (seed_ && problem.truth) problem.truth->seed = *seed_;
    write_simulation(problem, out_);
    if (!is_quiet()) print((std::filesystem::path(out_) / "problem.toml").string() + "\n");
    return kDone;
  }

 private:
  void check(const po::variables_map& given) override {
    if (out_.empty()) fail("--out DIR is missing");
    if (given.count("seed") == 0) return;
    // A conversion by the options library would take -1 for 2^64 - 1.
    std::uint64_t seed = 0;
    const char* end = seed_text_.data() + seed_text_.size();
    const auto [stop, error] = std::from_chars(seed_text_.data(), end, seed);
    if (error != std::errc() || stop != end)
      fail("--seed: '" + seed_text_ + "' is no seed; accepted: a whole number from 0 to 2^64 - 1");
    seed_ = seed;
  }

  std::string input_, out_, seed_text_, data_;
  std::optional<std::uint64_t> seed_;
};

}  // namespace

std::unique_ptr<Command> make_simulate() { return std::make_unique<SimulateCommand>(); }

}  // namespace slideway
