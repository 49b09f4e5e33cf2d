/// \file
/// Scores the detection of rebels in the static world, per corner and per object.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "tools/recording/recording.h"
#include "tools/scoring/scoring.h"

namespace lcs::bench {

/// An object counts as found with at least this many rebel corners on it.
inline constexpr int kCornersToFind = 3;

/// The outcome of a corner, from its label and its verdict.
enum class CornerOutcome : std::uint8_t {
  uncounted,     ///< in the warm-up, or its label is neither fixed nor rebel
  fixed,         ///< TN: label fixed, verdict other than rebel
  false_rebel,   ///< FP: label fixed, verdict rebel
  found,         ///< TP: label and verdict rebel
  found_early,   ///< TP within `kSightings` frames of its object's first; recall ignores it
  missed,        ///< FN: label rebel, verdict other than rebel
  missed_early,  ///< missed within `kSightings` frames; recall ignores it
};

/// The outcome of each corner of each frame, in order.
std::vector<std::vector<CornerOutcome>> corner_outcomes(const Recording& recording);

/// When an object became distinct from the static world, and when it was found.
struct ObjectDetection {
  int object = 0;
  int first_distinct = 0;       ///< k0: first frame with a corner of it that is labelled rebel
  int distinct_frames = 0;      ///< number of such frames
  std::optional<int> found_at;  ///< first frame from k0 on with `kCornersToFind` rebel corners
};

/// The detection of each object that is distinct in any frame, by object number.
std::vector<ObjectDetection> detect_objects(const Recording& recording);

/// Whether a disc has a moving object under it: the disc's centre lies in the object's box, or a
/// corner of the object lies in the disc.
bool has_mover_under(const FrameRecord& frame, const Vec2& centre_px, double radius_px);

/// Rebel circles with no moving object under them.
std::vector<const Circle*> false_circles(const FrameRecord& frame);

/// The difficulty of a verdict. Each corner has the first kind that applies.
enum class Difficulty : std::uint8_t {
  outline,     ///< fixed, at the outline of a mover
  radial,      ///< a rebel whose image motion could be a fixed corner's
  first_seen,  ///< detected for the first time; only its neighbours give information
  tracked,     ///< any other
};

struct RebelCornerScore {
  RebelCounts overall;
  RebelCounts distinct;   ///< without radial corners
  RebelCounts clear;      ///< without fixed corners at the outlines of movers
  RebelCounts radial;     ///< only radial corners (they have no false rebels)
  int fixed_corners = 0;  ///< after the warm-up
  /// `overall` as if all verdicts on corners of one `Difficulty` were right.
  std::array<RebelCounts, 4> without;

  RebelCornerScore& operator+=(const RebelCornerScore& other);
};

/// The counts of each frame, in order; all 0 during the warm-up.
std::vector<RebelCornerScore> score_rebel_corners(const Recording& recording);

struct RebelObjectScore {
  int objects = 0;  ///< objects distinct in at least N frames
  int found = 0;
  std::vector<double> latencies;  ///< per found object, frames from the first distinct one
  int false_circles = 0;          ///< sum over `frames` of `false_circles`
  int frames = 0;                 ///< number of frames checked for false circles
  int seen = 0;     ///< moving objects with `kCornersToFind` rebel corners, over these frames
  int circled = 0;  ///< `seen` ones with the centre of a rebel circle in their box
};

RebelObjectScore score_rebel_objects(const Recording& recording);

}  // namespace lcs::bench
