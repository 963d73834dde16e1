#pragma once

namespace slideway {

#if defined(__x86_64__) && defined(__GNUC__)
template <typename Loop>
[[gnu::target("avx2"), gnu::flatten]] void with_avx2(const Loop& loop) {
  loop();
}

/// Runs a loop over numbers four at a time where the processor can (AVX2), two at a time elsewhere,
/// with the same result to the last bit: nothing is fused, and no sum gets another order. For small
/// loops that a compiler vectorises; all they call becomes part of them.
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
