// Compiled with -mavx2 -mpopcnt.
#include "filter/vectors/avx2.h"

#include <immintrin.h>

#include <cstdint>

namespace lcs::avx2 {
#include "filter/vectors/loops.inl"

const Loops& loops() {
  return kLoops;
}

}  // namespace lcs::avx2
