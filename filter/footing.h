/// \file
/// What stands on nothing moves. A body that comes or goes along the line of sight moves in the
/// image as a static point at another depth does: no two frames tell them apart. But what is static
/// stands on the ground, and where its foot is seen the ground's depth is known. A group of edges
/// whose common depth puts its foot elsewhere is not static:
///
/// * *sunk*: farther than the ground that its lower edges hide. It recedes, or runs ahead.
/// * *aloft*: so near that its lowest edge hangs in the air, nothing that stands seen below it, and
///   in view, as a whole, for long enough to have shown it. It comes on. (A static body that hangs
///   lower than the camera is taken for one that does.)
#pragma once

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include "filter/depth_groups.h"
#include "filter/disjoint_sets.h"
#include "filter/layers.h"
#include "filter/motion_field.h"
#include "filter/parameters.h"
#include "filter/pixels.h"
#include "filter/point_grid.h"

namespace lcs {

class Footing {
 public:
  Footing(const Intrinsics& camera, const FootingParameters& parameters)
      : picture_{camera.width_px, camera.height_px}, parameters_(parameters) {}

  /// Counts `Edge::unfounded` up for edges whose group stands on nothing, and down for others,
  /// where the ground is known and the camera does more than crawl. Rebels are looked at that were
  /// unfounded before.
  void judge(std::vector<Edge>& normals, std::vector<Edge>& rebels, const MotionField& field);

  /// For as long as it takes.
  bool is_unfounded(const Edge& edge) const { return edge.unfounded >= frames_; }

 private:
  /// Frames for which a group must stand on nothing at the least, however far apart they are.
  static constexpr int kLeastFrames = 2;

  /// An edge whose depth is known from its path. Depths are ratios Z_ref / Z.
  struct Node {
    Edge* edge;
    double ratio;
    double sigma;   // its standard deviation
    double ground;  // ratio of the ground that is seen there, negative above the horizon
    double across;  // place along the horizon, px
    /// Surely: by two standard deviations more than the ground may be off by.
    bool is_below_ground(double slack) const { return ratio + 2 * sigma < ground - slack; }
    bool is_above_ground(double slack) const { return ratio - 2 * sigma > ground + slack; }
  };
  using Group = std::span<const int>;  // nodes
  /// Along the horizon, px.
  struct Extent {
    double left = std::numeric_limits<double>::infinity(), right = -left;
    void add(double from, double to) {
      left = std::min(left, from);
      right = std::max(right, to);
    }
    bool is_empty() const { return left > right; }
    bool holds(double place) const { return left <= place && place <= right; }
  };

  void gather(std::vector<Edge>& edges, const MotionField& field);
  void link();
  void stack();
  Extent sunk(Group group);
  bool hangs(Group group);
  bool is_cut_off(Group group) const;
  Extent aloft(Group group);
  void count(Group group, const Extent& unfounded) const;

  Pixels picture_;
  FootingParameters parameters_;
  int frames_ = kLeastFrames;  // for which a group must stand on nothing
  double slack_ = 0;           // ratio by which the ground may differ from its plane
  double overhang_px_ = 0;     // at a ratio of 1
  Vec2 along_horizon_ = Vec2::UnitX();
  std::vector<Node> nodes_;
  std::vector<Vec2> points_;
  PointGrid grid_;
  DepthGroups depths_;  // of nodes
  SetMembers groups_;
  std::vector<char> hanging_;  // groups, by their root
  std::vector<double> values_;
  std::vector<Vec2> below_;  // px: of a group, below the ground
  struct Span {
    int root;
    int members;
    double left, right;  // px along the horizon
  };
  std::vector<Span> spans_;
  std::vector<int> span_of_;  // by root, -1: none yet
};

}  // namespace lcs
