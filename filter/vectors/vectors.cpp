#include "filter/vectors/vectors.h"

namespace lcs {
#include "filter/vectors/lanes.inl"
#include "filter/vectors/loops.inl"

bool has_avx2() {
#if defined(LCS_AVX2)
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("popcnt");
#else
  return false;
#endif
}

const Loops& plain_loops() {
  return kLoops;
}

/// The same loops, for machines with AVX2.
namespace avx2 {
const Loops& loops();
}

const Loops& best_loops() {
#if defined(LCS_AVX2)
  if (has_avx2()) return avx2::loops();
#endif
  return kLoops;
}

}  // namespace lcs
