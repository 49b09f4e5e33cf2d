// The loops of vectors.h for machines with AVX2, compiled with -mavx2 -mpopcnt.
#include <immintrin.h>

#include <cstdint>

#include "filter/vectors/vectors.h"

namespace lcs::avx2 {
#include "filter/vectors/lanes.inl"
#include "filter/vectors/loops.inl"

const Loops& loops() {
  return kLoops;
}

}  // namespace lcs::avx2
