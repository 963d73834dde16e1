#include <benchmark/benchmark.h>
#include <malloc.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>

#include "slideway/base/file.hpp"
#include "slideway/base/parallel.hpp"
#include "slideway/base/random.hpp"
#include "slideway/base/text.hpp"
#include "slideway/format/table.hpp"

namespace slideway {
namespace {

// As the program has it: what is given back serves the next.
[[maybe_unused]] const bool kKeepsMemory =
    mallopt(M_MMAP_THRESHOLD, 1 << 30) == 1 && mallopt(M_TRIM_THRESHOLD, 1 << 30) == 1;

enum class Digits { few, shortest, all };

// A profile of half-micrometre steps: heights to the picometre, as a profilometer writes it, or of
// as many digits as tell a number from its neighbours, or of 17.
std::string profile_text(std::int64_t rows, Digits digits) {
  RandomStream random(1, "table_bench");
  std::string text = "x_mm,z_um\n";
  for (std::int64_t i = 0; i < rows; ++i) {
    const double x = static_cast<double>(i) * 5e-4, z = 0.3 * random.normal();
    std::array<char, 64> row;
    if (digits == Digits::shortest)
      text += shortest(x) + ',' + shortest(z) + '\n';
    else
      text.append(row.data(), static_cast<std::size_t>(std::snprintf(
                                  row.data(), row.size(),
                                  digits == Digits::few ? "%.4f,%.6f\n" : "%.17g,%.17g\n", x, z)));
  }
  return text;
}

// The file is mapped and read; its checksum is another's.
void BM_ReadTable(benchmark::State& state, Digits digits, unsigned threads) {
  const auto path = std::filesystem::temp_directory_path() /
                    ("slideway_table_bench." + std::to_string(::getpid()));
  const std::string text = profile_text(state.range(0), digits);
  write_file(path, text);
  limit_threads(threads);
  for (auto _ : state)
    benchmark::DoNotOptimize(parse_table(FileBytes(path).text(), {.columns = {"x_mm", "z_um"}}));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.size()));
  state.counters["bytes"] = static_cast<double>(text.size());
  std::filesystem::remove(path);
}

const auto kSizes = [](auto* benchmark) {
  benchmark->Arg(20'000)->Arg(1'000'000)->Arg(10'000'000)->Unit(benchmark::kMillisecond);
  benchmark->MeasureProcessCPUTime()->UseRealTime();
};
BENCHMARK_CAPTURE(BM_ReadTable, one_thread, Digits::few, 1)->Apply(kSizes);
BENCHMARK_CAPTURE(BM_ReadTable, two_threads, Digits::few, 2)->Apply(kSizes);
BENCHMARK_CAPTURE(BM_ReadTable, shortest_one_thread, Digits::shortest, 1)->Apply(kSizes);
BENCHMARK_CAPTURE(BM_ReadTable, shortest_two_threads, Digits::shortest, 2)->Apply(kSizes);
BENCHMARK_CAPTURE(BM_ReadTable, digits17_one_thread, Digits::all, 1)->Apply(kSizes);
BENCHMARK_CAPTURE(BM_ReadTable, digits17_two_threads, Digits::all, 2)->Apply(kSizes);

void BM_Sha256(benchmark::State& state) {
  const std::string text = profile_text(state.range(0), Digits::few);
  for (auto _ : state) benchmark::DoNotOptimize(sha256(text));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.size()));
}
BENCHMARK(BM_Sha256)->Arg(1000000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace slideway
