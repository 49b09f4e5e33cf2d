#include "filter/vectors/vectors.h"

#include <cstdint>

#include "filter/vectors/avx2.h"

namespace lcs {
#include "filter/vectors/loops.inl"

const Loops& plain_loops() {
  return kLoops;
}

const Loops& loops() {
#if defined(LCS_AVX2)
  static const bool has_avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("popcnt");
  if (has_avx2) return avx2::loops();
#endif
  return kLoops;
}

}  // namespace lcs
