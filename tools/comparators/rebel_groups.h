/// \file
/// From corners that leave the static world to verdicts and boxes: what the comparators share after
/// each has said by how much.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "filter/filter.h"
#include "filter/matching/disjoint_sets.h"
#include "filter/matching/point_grid.h"
#include "filter/squares/convex_hull.h"

namespace lcs::comparators {

/// How a corner moved since the picture that its frame is compared with.
struct CornerMotion {
  bool known = false;  ///< false: it was lost, and nothing is said of it
  bool off = false;    ///< it does not move as the static world does
  /// This frame's location less the one there, with what the camera's motion explains for all
  /// corners alike (its rotation, or a homography) removed.
  Vec2 step_px = Vec2::Zero();
};

struct GroupParameters {
  double reach_px = 120;     ///< between two corners of one group
  double like_px = 2;        ///< by which their steps may differ,
  double like_share = 0.35;  ///< or by this share of the steps, if that is more
  int least_corners = 5;  ///< of a group, as of a circle; fewer are taken for tracking gone wrong
  double least_area_px2 = 250;  ///< of a box
  double same_overlap = 0.3;    ///< IoU with a box of the last frame from which it is the same one
};

/// Corners that are off, near each other and of like step, are a group (single linkage); each group
/// is a circle and, if large enough, a square. Boxes keep their ids from frame to frame by overlap.
class RebelGroups {
 public:
  /// \throws std::invalid_argument unless reach and least number of corners are above 0.
  explicit RebelGroups(const GroupParameters& parameters);

  /// To be called with every frame, in order.
  /// \param motions of the corners, as many.
  /// \param dt_s that the motions took; 0 for none.
  /// \return a verdict for each corner (`rebel` in a group, `pending` where lost, else `normal`);
  ///   as layers the corners as edges, the groups as rebel circles and squares. Valid until the
  ///   next call.
  const FrameResult& group(std::span<const Eigen::Vector2f> corners_px,
                           std::span<const CornerMotion> motions, double dt_s);

 private:
  void link(std::span<const CornerMotion> motions);
  void add_group(const std::vector<int>& members, std::span<const CornerMotion> motions,
                 double dt_s);
  void name_squares();

  GroupParameters parameters_;
  std::vector<Square> last_squares_;
  Id next_edge_ = 1, next_circle_ = 1, next_square_ = 1;

  // Of the current frame; kept for their memory.
  std::vector<Vec2> points_;
  std::vector<int> corner_of_;  ///< of each point
  DisjointSets sets_;           ///< of points that move alike
  std::vector<std::vector<int>> members_;
  PointGrid grid_;
  ConvexHull hull_;
  FrameResult result_;
};

}  // namespace lcs::comparators
