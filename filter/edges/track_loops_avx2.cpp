// The loops of tracks.h for machines with AVX2, compiled with -mavx2 -mpopcnt.
#include <immintrin.h>

#include <cstdint>
#include <numbers>

#include "filter/edges/track_loops.h"
#include "filter/vectors/vectors.h"

namespace lcs::avx2 {
#include "filter/vectors/lanes.inl"
//
#include "filter/edges/track_loops.inl"

const TrackLoops& track_loops() {
  return kTrackLoops;
}

}  // namespace lcs::avx2
