#include <benchmark/benchmark.h>
#include <malloc.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>

#include "slideway/base/file.hpp"
#include "slideway/base/random.hpp"
#include "slideway/format/table.hpp"

namespace slideway {
namespace {

// As the program has it: what is given back serves the next.
[[maybe_unused]] const bool kKeepsMemory =
    mallopt(M_MMAP_THRESHOLD, 1 << 30) == 1 && mallopt(M_TRIM_THRESHOLD, 1 << 30) == 1;

// A profile as a profilometer writes it: half-micrometre steps, heights to the picometre.
std::string profile_text(std::int64_t rows) {
  RandomStream random(1, "table_bench");
  std::string text = "x_mm,z_um\n";
  for (std::int64_t i = 0; i < rows; ++i) {
    const std::string x = std::to_string(static_cast<double>(i) * 5e-4);
    text += x.substr(0, x.size() - 2) + ',' + std::to_string(0.3 * random.normal()) + '\n';
  }
  return text;
}

void BM_ReadTable(benchmark::State& state) {
  const auto path = std::filesystem::temp_directory_path() / "slideway_table_bench.csv";
  const std::string text = profile_text(state.range(0));
  write_file(path, text);
  const std::array<std::string, 2> columns{"x_mm", "z_um"};
  for (auto _ : state) benchmark::DoNotOptimize(read_table(path, columns));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.size()));
  state.counters["bytes"] = static_cast<double>(text.size());
  std::filesystem::remove(path);
}
BENCHMARK(BM_ReadTable)
    ->Arg(20'000)
    ->Arg(1'000'000)
    ->Arg(10'000'000)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

void BM_Sha256(benchmark::State& state) {
  const std::string text = profile_text(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(sha256(text));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.size()));
}
BENCHMARK(BM_Sha256)->Arg(1000000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace slideway
