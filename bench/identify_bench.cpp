#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "slideway/base/file.hpp"
#include "slideway/identify/fit.hpp"
#include "slideway/identify/identify.hpp"
#include "slideway/identify/noise_model.hpp"
#include "slideway/identify/simulate.hpp"
#include "slideway/report/report.hpp"

namespace slideway {
namespace {

constexpr double kTravel = 600.0;  // mm

std::string problem_text() {
  return R"([machine]
lever = "split"
[low_band]
wavelet = "db1"
level = 5
[[profile]]
name = "face"
file = "positions.csv"
kind = "face"
quantity = "height"
position_column = "x_mm"
value_column = "z_um"
position_unit = "mm"
value_unit = "um"
feed_mm_per_min = 2.0
spindle_rpm = 110.0
cut_direction = "inward"
cut_radius_mm = 600.0
free = ["offset"]
[[effect]]
name = "straightness"
degree = 5
priors = [{ parameter = "b1", value = -5.19e-7, standard_uncertainty = 2.9e-10 }]
[[effect]]
name = "squareness"
[runout]
r_um = 0.3
p_um = 2.5
diameter_mm = 1000.0
standard_uncertainty_um = 0.1
[truth]
noise_um = 0.1
noise_correlation_mm = 1.0
[truth.parameters]
"squareness.dbeta_xz" = 2.8e-6
"straightness.b1" = -5.19e-7
"straightness.b2" = 2.29e-8
"straightness.b3" = -1.558e-10
)";
}

// A simulated problem in a folder of its own, gone with the object.
class Folder {
 public:
  explicit Folder(std::int64_t samples)
      : path_(std::filesystem::temp_directory_path() /
              ("slideway_identify_bench." + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
    std::string positions = "x_mm,z_um\n";
    const double step = kTravel / static_cast<double>(samples);
    for (std::int64_t i = 0; i < samples; ++i)
      positions += std::to_string(static_cast<double>(i) * step) + ",0\n";
    write_file(path_ / "positions.csv", positions);
    write_file(path_ / "truth.toml", problem_text());
    write_simulation(read_problem(path_ / "truth.toml"), path_ / "simulated");
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] std::filesystem::path problem() const {
    return path_ / "simulated" / "problem.toml";
  }

 private:
  std::filesystem::path path_;
};

// The same, read.
struct Loaded {
  explicit Loaded(std::int64_t samples) : folder(samples) {}

  Folder folder;
  Problem problem = read_problem(folder.problem());
  std::vector<Profile> profiles = read_profiles(problem);
  Model model = build_model(problem, profiles);
};

void set_items(benchmark::State& state) {
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

void BM_Compress(benchmark::State& state) {
  const Loaded loaded(state.range(0));
  const Estimate start = initial_estimate(loaded.model);
  for (auto _ : state)
    benchmark::DoNotOptimize(compress(linearise(loaded.model, start), first_noise(loaded.model)));
  set_items(state);
}

void BM_FitWithCovariance(benchmark::State& state) {
  const Loaded loaded(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(fit(loaded.model));
  set_items(state);
}

void BM_Identify(benchmark::State& state) {
  const Folder folder(state.range(0));
  for (auto _ : state) {
    const Problem problem = read_problem(folder.problem());
    benchmark::DoNotOptimize(
        text_report(analyse(problem, read_profiles(problem), {.closes_loop = false})));
  }
  set_items(state);
}

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

// Processor time of the program from start to end, or a negative number if it failed.
double run_program(std::string problem) {
  std::array<std::string, 3> words{SLIDEWAY_PROGRAM, "identify", "--no-trace"};
  const std::array<char*, 5> arguments{words[0].data(), words[1].data(), words[2].data(),
                                       problem.data(), nullptr};
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int error =
      ::posix_spawn(&child, SLIDEWAY_PROGRAM, &actions, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  rusage usage{};
  if (error != 0 || ::wait4(child, &status, 0, &usage) != child || status != 0) return -1.0;
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

void BM_IdentifyProcess(benchmark::State& state) {
  const Folder folder(state.range(0));
  for (auto _ : state) {
    const double time = run_program(folder.problem());
    if (time < 0.0) return state.SkipWithError(SLIDEWAY_PROGRAM " failed");
    state.SetIterationTime(time);
  }
  set_items(state);
}

const auto kSizes = [](auto* benchmark) {
  benchmark->Arg(20'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond);
};

BENCHMARK(BM_Compress)->Apply(kSizes);
BENCHMARK(BM_FitWithCovariance)->Apply(kSizes)->Arg(10'000'000)->MeasureProcessCPUTime();
BENCHMARK(BM_Identify)->Apply(kSizes);
BENCHMARK(BM_IdentifyProcess)->Apply(kSizes)->UseManualTime();

}  // namespace
}  // namespace slideway
