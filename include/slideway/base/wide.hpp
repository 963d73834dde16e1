#pragma once

namespace slideway {

#if defined(__x86_64__) && defined(__GNUC__)
template <typename Loop>
[[gnu::target("avx2"), gnu::flatten]] void with_avx2(const Loop& loop) {
  loop();
}

/// Runs a loop compiled for AVX2 (four doubles) if the processor has it, else for SSE2 (two
/// doubles). The result is the same to the last bit: no operation is fused, no sum reordered. For
/// small loops that a compiler vectorises; the functions they call are inlined.
template <typename Loop>
void wide(const Loop& loop) {
  static const bool kHasAvx2 = __builtin_cpu_supports("avx2") != 0;
  kHasAvx2 ? with_avx2(loop) : loop();
}
#else
template <typename Loop>
void wide(const Loop& loop) {
  loop();
}
#endif

}  // namespace slideway
