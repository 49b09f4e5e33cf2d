/// \file
/// Turns moving corners into verdicts and boxes. Shared by the comparators, each of which first
/// measures how far corners deviate from static motion.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "filter/matching/disjoint_sets.h"
#include "filter/matching/members.h"
#include "filter/matching/point_grid.h"
#include "filter/squares/convex_hull.h"
#include "filter/types/frame_result.h"

namespace lcs::comparators {

/// Motion of a corner since the earlier picture of its frame.
struct CornerMotion {
  bool known = false;  ///< false: the corner was lost
  bool off = false;    ///< true: it does not move like the static world
  /// Step from the earlier place to this one, px, without the camera's common image motion
  /// (rotation, or a homography).
  Vec2 step_px = Vec2::Zero();
};

struct GroupParameters {
  double reach_px = 120;     ///< between two corners of a group
  double like_px = 2;        ///< largest difference of their steps,
  double like_share = 0.35;  ///< or this share of the steps, if larger
  int least_corners = 5;     ///< fewest of a group, like a circle's; fewer count as tracking errors
  double least_area_px2 = 250;  ///< least area of a box
  double same_overlap = 0.3;    ///< least IoU with a box of the last frame to keep its id
};

/// Groups corners that are off, near each other and of similar step (single linkage). Each group is
/// a circle and, if large enough, a square. Boxes keep their ids by overlap.
class RebelGroups {
 public:
  /// \throws std::invalid_argument unless reach and least number of corners are positive.
  explicit RebelGroups(const GroupParameters& parameters);

  /// Call with each frame, in order.
  /// \param motions one for each corner.
  /// \param dt_s duration of the motions, s; 0 for none.
  /// \return a verdict for each corner (`rebel` in a group, `pending` if lost, else `normal`).
  ///   Layers: corners as edges, groups as rebel circles and squares. Valid until the next call.
  const FrameResult& group(std::span<const Eigen::Vector2f> corners_px,
                           std::span<const CornerMotion> motions, double dt_s);

 private:
  void link(std::span<const CornerMotion> motions);
  void add_group(std::span<const int> members, std::span<const CornerMotion> motions, double dt_s);
  void name_squares();

  GroupParameters parameters_;
  std::vector<Square> last_squares_;
  Id next_edge_ = 1, next_circle_ = 1, next_square_ = 1;

  // Scratch storage of the current frame; members, so that a frame need not allocate.
  std::vector<Vec2> points_;
  std::vector<int> corner_of_;  ///< of each point
  DisjointSets sets_;           ///< of points with similar motion
  Members members_;
  PointGrid grid_;
  ConvexHull hull_;
  FrameResult result_;
};

}  // namespace lcs::comparators
