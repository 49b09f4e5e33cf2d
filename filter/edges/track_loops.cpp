#include <cstdint>
#include <numbers>

#include "filter/edges/track_loops.h"
#include "filter/vectors/vectors.h"

namespace lcs {
#include "filter/vectors/lanes.inl"
//
#include "filter/edges/track_loops.inl"

const TrackLoops& plain_track_loops() {
  return kTrackLoops;
}

/// The same loops, for machines with AVX2.
namespace avx2 {
const TrackLoops& track_loops();
}

const TrackLoops& track_loops() {
#if defined(LCS_AVX2)
  static const TrackLoops& best = has_avx2() ? avx2::track_loops() : kTrackLoops;
  return best;
#else
  return kTrackLoops;
#endif
}

}  // namespace lcs
