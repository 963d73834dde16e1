#include <benchmark/benchmark.h>
#include <malloc.h>

#include <cmath>
#include <string>
#include <vector>

#include "slideway/base/random.hpp"
#include "slideway/signal/bands.hpp"
#include "slideway/signal/correlation.hpp"
#include "slideway/signal/decomposition.hpp"
#include "slideway/signal/low_band.hpp"

namespace slideway {
namespace {

constexpr int kLevels = 5;

// As the program has it: what is given back serves the next.
[[maybe_unused]] const bool kKeepsMemory =
    mallopt(M_MMAP_THRESHOLD, 1 << 30) == 1 && mallopt(M_TRIM_THRESHOLD, 1 << 30) == 1;

std::vector<double> noise(std::int64_t n) {
  RandomStream random(1, "signal_bench");
  std::vector<double> signal(static_cast<std::size_t>(n));
  for (double& value : signal) value = random.normal();
  return signal;
}

std::vector<double> uniform_positions(std::int64_t n) {
  std::vector<double> positions(static_cast<std::size_t>(n));
  for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = 0.03 * static_cast<double>(i);
  return positions;
}

void set_items(benchmark::State& state) {
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

void BM_DwtForward(benchmark::State& state, const std::string& name, Boundary boundary) {
  const Wavelet wavelet = daubechies(name);
  const std::vector<double> signal = noise(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(decompose(wavelet, boundary, kLevels, signal));
  set_items(state);
}

void BM_Bands(benchmark::State& state, const std::string& name, Boundary boundary) {
  const Wavelet wavelet = daubechies(name);
  const std::vector<double> signal = noise(state.range(0));
  for (auto _ : state)
    benchmark::DoNotOptimize(reconstruct_bands(wavelet, boundary, kLevels, signal));
  set_items(state);
}

void BM_LowBandApply(benchmark::State& state, const std::string& name, bool uniform) {
  std::vector<double> positions = uniform_positions(state.range(0));
  if (!uniform)
    for (double& position : positions) position += 0.3 * std::sin(position);
  const LowBand low_band({name, kLevels, Boundary::symmetric}, positions);
  const std::vector<double> signal = noise(state.range(0));
  std::vector<double> coefficients(static_cast<std::size_t>(low_band.values()));
  for (auto _ : state) {
    low_band.apply(signal, coefficients);
    benchmark::DoNotOptimize(coefficients.data());
  }
  set_items(state);
}

void BM_BestLag(benchmark::State& state) {
  const std::vector<double> signal = noise(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(best_lag(signal, signal, 200));
}

// A slope correlates with itself over half its length: the sum's longest case.
void BM_EffectiveObservations(benchmark::State& state) {
  const std::vector<double> slope = uniform_positions(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(effective_observations(slope, slope));
}

const auto kSizes = [](auto* benchmark) {
  benchmark->Arg(20'000)->Arg(1'000'000)->Unit(benchmark::kMicrosecond);
};
const auto kAllSizes = [](auto* benchmark) {
  kSizes(benchmark);
  benchmark->Arg(10'000'000)->MeasureProcessCPUTime();
};

BENCHMARK_CAPTURE(BM_DwtForward, db1_symmetric, "db1", Boundary::symmetric)->Apply(kAllSizes);
BENCHMARK_CAPTURE(BM_DwtForward, db1_periodization, "db1", Boundary::periodization)
    ->Apply(kAllSizes);
BENCHMARK_CAPTURE(BM_DwtForward, db4_symmetric, "db4", Boundary::symmetric)->Apply(kAllSizes);
BENCHMARK_CAPTURE(BM_DwtForward, db4_periodization, "db4", Boundary::periodization)
    ->Apply(kAllSizes);
BENCHMARK_CAPTURE(BM_Bands, db1_symmetric, "db1", Boundary::symmetric)->Apply(kAllSizes);
BENCHMARK_CAPTURE(BM_Bands, db1_periodization, "db1", Boundary::periodization)->Apply(kAllSizes);
BENCHMARK_CAPTURE(BM_Bands, db4_symmetric, "db4", Boundary::symmetric)->Apply(kAllSizes);
BENCHMARK_CAPTURE(BM_Bands, db4_periodization, "db4", Boundary::periodization)->Apply(kAllSizes);
BENCHMARK_CAPTURE(BM_LowBandApply, db1_uniform, "db1", true)->Apply(kSizes);
BENCHMARK_CAPTURE(BM_LowBandApply, db4_uniform, "db4", true)->Apply(kSizes);
BENCHMARK_CAPTURE(BM_LowBandApply, db1_resampled, "db1", false)->Apply(kSizes);
BENCHMARK(BM_BestLag)->Arg(625)->Arg(20'000)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_EffectiveObservations)->Arg(625)->Arg(20'000)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace slideway
