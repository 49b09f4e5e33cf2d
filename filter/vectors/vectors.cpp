#include "filter/vectors/vectors.h"

#include <cstdint>

#include "filter/vectors/avx2.h"

namespace lcs {
#include "filter/vectors/loops.inl"

const Loops& plain_loops() {
  return kLoops;
}

const Loops& best_loops() {
#if defined(LCS_AVX2)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("popcnt")) return avx2::loops();
#endif
  return kLoops;
}

}  // namespace lcs
