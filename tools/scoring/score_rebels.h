/// \file
/// How well rebels were told from the static world: corner by corner, and object by object.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "tools/recording/recording.h"
#include "tools/scoring/scoring.h"

namespace lcs::bench {

/// At least this many rebel corners on an object count as having found it.
inline constexpr int kCornersToFind = 3;

/// How a corner counts, by its label and its verdict.
enum class CornerOutcome : std::uint8_t {
  uncounted,     ///< of the warm-up, or neither fixed nor rebel in truth
  fixed,         ///< and not called a rebel
  false_rebel,   ///< FP: fixed, but called a rebel
  found,         ///< TP
  found_early,   ///< TP too soon after its object's first (`kSightings`): recall leaves it out
  missed,        ///< FN
  missed_early,  ///< missed as soon: recall leaves it out, too
};

/// The outcome of each corner of each frame, in order.
std::vector<std::vector<CornerOutcome>> corner_outcomes(const Recording& recording);

/// When an object could be told from the static world, and when it was.
struct ObjectDetection {
  int object = 0;
  int first_distinct = 0;       ///< k0: first frame in which a corner of it is labelled rebel
  int distinct_frames = 0;      ///< in how many that is so
  std::optional<int> found_at;  ///< first frame from k0 on with enough rebel corners on it
};

/// The detection of each object that is distinct in any frame, by number.
std::vector<ObjectDetection> detect_objects(const Recording& recording);

/// Whether a disc has a moving object under it: its centre lies in the box of one, or a corner of
/// one lies in it.
bool has_mover_under(const FrameRecord& frame, const Vec2& centre_px, double radius_px);

/// Rebel circles with no moving object under them.
std::vector<const Circle*> false_circles(const FrameRecord& frame);

/// What made a verdict hard; each corner is of one kind, the first that holds.
enum class Difficulty : std::uint8_t {
  outline,     ///< fixed, at the outline of what moves
  radial,      ///< a rebel that moves as a fixed corner may
  first_seen,  ///< seen for the first time, so that only what is round it tells
  tracked,     ///< any other
};

struct RebelCornerScore {
  RebelCounts overall;
  RebelCounts distinct;   ///< radial corners left out
  RebelCounts clear;      ///< fixed corners at the outlines of what moves left out
  RebelCounts radial;     ///< radial corners alone (they have no false rebels)
  int fixed_corners = 0;  ///< after the warm-up
  /// Overall, had all verdicts on corners of one `Difficulty` been right.
  std::array<RebelCounts, 4> without;

  RebelCornerScore& operator+=(const RebelCornerScore& other);
};

/// Counts of each frame, in order; all 0 during the warm-up.
std::vector<RebelCornerScore> score_rebel_corners(const Recording& recording);

struct RebelObjectScore {
  int objects = 0;  ///< distinct in at least N frames
  int found = 0;
  std::vector<double> latencies;  ///< frames from the first distinct one, of each that was found
  int false_circles = 0;          ///< as `false_circles`
  int frames = 0;                 ///< in which false circles were looked for
  int seen = 0;     ///< moving objects with `kCornersToFind` rebel corners, over these frames
  int circled = 0;  ///< of these, with the centre of a rebel circle in their box
};

RebelObjectScore score_rebel_objects(const Recording& recording);

}  // namespace lcs::bench
