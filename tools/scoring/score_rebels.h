/// \file
/// Scores the detection of rebels in the static world, per corner and per object.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "tools/recording/recording.h"
#include "tools/scoring/scoring.h"

namespace lcs::scoring {

/// An object counts as found with at least this many rebel corners on it.
inline constexpr int kCornersToFind = 3;

/// When an object became distinct from the static world, and when it was found.
struct ObjectDetection {
  int first_distinct = 0;       ///< k0: first frame with a corner of it that is labelled rebel
  int distinct_frames = 0;      ///< number of such frames
  std::optional<int> found_at;  ///< first frame from k0 on with `kCornersToFind` rebel corners
  std::int64_t first_distinct_ns = 0;
  double latency_ms = 0;  ///< time between the two frames
};

/// By object number; each object that is distinct in any frame so far.
using ObjectDetections = std::map<int, ObjectDetection>;

/// Whether a disc has a moving object under it: the disc's centre lies in the object's box, or a
/// corner of the object lies in the disc.
bool has_mover_under(const recording::FrameRecord& frame, const Vec2& centre_px, double radius_px);

/// Rebel circles with no moving object under them.
std::vector<const Circle*> false_circles(const recording::FrameRecord& frame);

/// The difficulty of a verdict. Each corner has the first kind that applies.
enum class Difficulty : std::uint8_t {
  outline,     ///< fixed, at the outline of a mover
  radial,      ///< a rebel whose image motion could be a fixed corner's
  first_seen,  ///< detected for the first time; only its neighbours give information
  tracked,     ///< any other
};
Difficulty difficulty(const recording::FrameRecord& frame, std::size_t corner);

struct RebelCornerScore {
  RebelCounts overall;
  RebelCounts distinct;   ///< without radial corners
  RebelCounts clear;      ///< without fixed corners at the outlines of movers
  RebelCounts radial;     ///< only radial corners (they have no false rebels)
  int fixed_corners = 0;  ///< after the warm-up
  /// `overall` as if all verdicts on corners of one `Difficulty` were right.
  std::array<RebelCounts, 4> without;
};

struct RebelObjectScore {
  int objects = 0;  ///< objects distinct in at least N frames
  int found = 0;
  /// Per found object, from the first distinct frame.
  std::vector<double> latencies, latencies_ms;
  int false_circles = 0;  ///< sum over `frames` of `false_circles`
  int frames = 0;         ///< number of frames checked for false circles
  int seen = 0;           ///< moving objects with `kCornersToFind` rebel corners, over these frames
  int circled = 0;        ///< `seen` ones with the centre of a rebel circle in their box
};

/// The outcome of each corner of a frame. \param detections up to this frame, or later.
std::vector<CornerOutcome> corner_outcomes(const recording::FrameRecord& frame,
                                           const ObjectDetections& detections);

/// Scores a run frame by frame, in order.
class RebelScorer {
 public:
  FrameScore add(const recording::FrameRecord& frame);

  const RebelCornerScore& corners() const { return corners_; }
  const ObjectDetections& detections() const { return detections_; }
  RebelObjectScore objects() const;

 private:
  RebelCornerScore corners_;
  ObjectDetections detections_;
  RebelObjectScore circles_;  ///< without the fields that `detections_` determine
};

}  // namespace lcs::scoring
