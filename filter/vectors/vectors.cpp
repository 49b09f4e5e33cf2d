#include "filter/vectors/vectors.h"

#include <cstdint>

namespace lcs {
#include "filter/vectors/loops.inl"

const Loops& plain_loops() {
  return kLoops;
}

/// The same loops, for machines with AVX2.
namespace avx2 {
const Loops& loops();
}

const Loops& best_loops() {
#if defined(LCS_AVX2)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("popcnt")) return avx2::loops();
#endif
  return kLoops;
}

}  // namespace lcs
